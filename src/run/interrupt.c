// SPDX-License-Identifier: MIT
#include "moray/app/run.h"

#include <signal.h>

static volatile sig_atomic_t interrupted;
static struct sigaction earlier;

static void on_interrupt(int signal)
{
    interrupted = 1;
    sigaction(signal, &earlier, NULL);
}

void moray_interrupt_begin(void)
{
    interrupted = 0;
    sigaction(SIGINT, NULL, &earlier);
    if (earlier.sa_handler != SIG_IGN)
        sigaction(SIGINT, &(struct sigaction){.sa_handler = on_interrupt, .sa_flags = SA_RESTART}, NULL);
}

void moray_interrupt_end(void)
{
    sigaction(SIGINT, &earlier, NULL);
}

bool moray_interrupted(void)
{
    return interrupted;
}
