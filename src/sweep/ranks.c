// SPDX-License-Identifier: MIT
//
// The one file that calls MPI.
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

#include "sweep/sweep.h"

// Set by mpirun of Open MPI, of MPICH, and by srun with PMIx or PMI; without one of them nobody started several.
static bool started_by_many(void)
{
    static const char *const signs[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
    for (unsigned k = 0; k < sizeof signs / sizeof *signs; k++)
        if (getenv(signs[k]))
            return true;
    return false;
}

static bool leaving;

void moray_ranks_leave(void)
{
    leaving = true;
}

// A text on its way: to a rank that is gone it is for ever, and nobody waits for that.
struct letter {
    MPI_Request request;
    char *text;
    struct letter *next;
};
static struct letter *underway;

static void forget_arrived(bool all)
{
    for (struct letter **at = &underway; *at;) {
        struct letter *letter = *at;
        int arrived = 1;
        if (all)
            MPI_Wait(&letter->request, MPI_STATUS_IGNORE);
        else
            MPI_Test(&letter->request, &arrived, MPI_STATUS_IGNORE);
        if (!arrived) {
            at = &letter->next;
            continue;
        }
        *at = letter->next;
        free(letter->text);
        free(letter);
    }
}

static void end(void)
{
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended || leaving)
        return;
    forget_arrived(true);
    MPI_Finalize();
}

struct ranks moray_ranks_begin(void)
{
    static struct ranks known;
    int begun = 0;
    if (known.size > 0)
        return known;
    known = (struct ranks){1, 0};
    if (!started_by_many())
        return known;
    MPI_Initialized(&begun);
    if (!begun && MPI_Init(NULL, NULL) == MPI_SUCCESS)
        atexit(end);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); // a rank that is gone is no end of the others
    MPI_Comm_size(MPI_COMM_WORLD, &known.size);
    MPI_Comm_rank(MPI_COMM_WORLD, &known.rank);
    return known;
}

int moray_sweep_rank(void)
{
    return moray_ranks_begin().rank;
}

void moray_ranks_send(int to, const char *text)
{
    forget_arrived(false);
    struct letter *letter = malloc(sizeof *letter);
    char *copy = letter ? strdup(text) : NULL;
    if (!copy) { // the text itself has to last until it has arrived
        free(letter);
        MPI_Send(text, (int)strlen(text) + 1, MPI_CHAR, to, 0, MPI_COMM_WORLD);
        return;
    }
    *letter = (struct letter){.text = copy, .next = underway};
    underway = letter;
    MPI_Isend(copy, (int)strlen(copy) + 1, MPI_CHAR, to, 0, MPI_COMM_WORLD, &letter->request);
}

char *moray_ranks_receive(int *from)
{
    int there = 0, length = 0;
    MPI_Status about;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &about);
    if (!there)
        return NULL;
    MPI_Get_count(&about, MPI_CHAR, &length);
    char *text = malloc((size_t)length + 1);
    if (!text)
        return NULL;
    MPI_Recv(text, length, MPI_CHAR, about.MPI_SOURCE, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    text[length] = 0;
    *from = about.MPI_SOURCE;
    return text;
}
