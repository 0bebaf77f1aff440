// SPDX-License-Identifier: MIT
//
// Signals while a program solves: the first of either kind is remembered, the next does what it did before; what is
// ignored stays so.
#include "tap.h"

#include <signal.h>

#include "moray/app/run.h"

static int seen[2];

static void on_int(int signal)
{
    (void)signal;
    seen[0]++;
}

static void on_term(int signal)
{
    (void)signal;
    seen[1]++;
}

static const int asking[2] = {SIGINT, SIGTERM};
static void (*const handler[2])(int) = {on_int, on_term};

static void begin(void)
{
    seen[0] = seen[1] = 0;
    for (int k = 0; k < 2; k++)
        signal(asking[k], handler[k]);
    moray_interrupt_begin();
    CHECK(!moray_interrupted(), "nothing has come");
}

int main(void)
{
    for (int k = 0; k < 2; k++) {
        begin();
        raise(asking[k]);
        CHECK(moray_interrupted() && seen[k] == 0, "the first is remembered");
        for (int j = 0; j < 2; j++) {
            raise(asking[j]);
            CHECK(seen[j] == 1, "the next is the program's own");
        }
        moray_interrupt_end();
        begin();
        moray_interrupt_end();
        for (int j = 0; j < 2; j++) {
            raise(asking[j]);
            CHECK(seen[j] == 1 && !moray_interrupted(), "behind the end each is the program's own");
        }
        signal(asking[k], SIG_IGN);
        signal(asking[1 - k], handler[1 - k]);
        moray_interrupt_begin();
        raise(asking[k]);
        CHECK(!moray_interrupted(), "what is ignored stays so");
        raise(asking[1 - k]);
        CHECK(moray_interrupted(), "the other is not");
        moray_interrupt_end();
        struct sigaction now;
        sigaction(asking[k], NULL, &now);
        CHECK(now.sa_handler == SIG_IGN, "in the end too");
    }
    return tap_done();
}
