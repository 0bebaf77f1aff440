// SPDX-License-Identifier: MIT
#include "moray/app/run.h"

#include <signal.h>

static const int asking[] = {SIGINT, SIGTERM}; // a terminal's Ctrl-C, and what timeout, systemd and Slurm send first
enum { ways = sizeof asking / sizeof *asking };

static volatile sig_atomic_t interrupted;
static struct sigaction earlier[ways];

static void restore(void)
{
    for (int k = 0; k < ways; k++)
        sigaction(asking[k], &earlier[k], NULL);
}

static void on_interrupt(int signal)
{
    (void)signal;
    interrupted = 1;
    restore();
}

void moray_interrupt_begin(void)
{
    interrupted = 0;
    for (int k = 0; k < ways; k++) {
        sigaction(asking[k], NULL, &earlier[k]);
        if (earlier[k].sa_handler != SIG_IGN)
            sigaction(asking[k], &(struct sigaction){.sa_handler = on_interrupt, .sa_flags = SA_RESTART}, NULL);
    }
}

void moray_interrupt_end(void)
{
    restore();
}

bool moray_interrupted(void)
{
    return interrupted;
}
