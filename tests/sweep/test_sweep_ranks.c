// SPDX-License-Identifier: MIT
//
// Texts through MPI, from the one rank of a process that nobody else was started with to itself.
#define _GNU_SOURCE // setenv
#include "tap.h"

#include <malloc.h>
#include <mpi.h>
#include <string.h>
#include <time.h>

#include "sweep/sweep.h"

// Until something has come.
static char *receive(int *from)
{
    char *text = NULL;
    for (int k = 0; k < 5000 && !(text = moray_ranks_receive(from)); k++)
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    return text;
}

int main(void)
{
    char text[5000];
    int from = -1;
    setenv("OMPI_COMM_WORLD_SIZE", "1", 1);
    const struct ranks ranks = moray_ranks_begin(), again = moray_ranks_begin();
    CHECK(ranks.size == 1 && ranks.rank == 0 && again.size == 1 && again.rank == 0, "rank %d of %d", ranks.rank,
          ranks.size);
    CHECK(moray_sweep_rank() == 0, "is the first");
    CHECK(!moray_ranks_receive(&from) && from == -1, "nothing has come");
    for (int k = 0; k < 3; k++) {
        const size_t length = (size_t)(k ? 37 * k * k * k * k * k : 0); // none, a few, and many
        memset(text, 'a' + k, length);
        text[length] = 0;
        moray_ranks_send(0, text);
        strcpy(text, "something else"); // what is underway has its own copy
    }
    for (int k = 0; k < 3; k++) {
        from = -1;
        char *came = receive(&from);
        const size_t length = (size_t)(k ? 37 * k * k * k * k * k : 0);
        CHECK(came && from == 0 && strlen(came) == length, "a text of %zu", length);
        CHECK(came && strspn(came, (char[]){(char)('a' + k), 0}) == length, "as it was sent");
        free(came);
    }
    MPI_Send("abcd", 3, MPI_CHAR, 0, 0, MPI_COMM_WORLD);
    mallopt(M_PERTURB, 85);
    char *came = receive(&from);
    CHECK(came && strcmp(came, "abc") == 0, "what comes without its end has one: %s", came);
    free(came);
    CHECK(!moray_ranks_receive(&from), "then nothing more");
    return tap_done();
}
