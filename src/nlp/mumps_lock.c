// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // the recursive initialiser
#include "nlp/mumps_lock.h"

#include <pthread.h>

static pthread_mutex_t mutex = PTHREAD_RECURSIVE_MUTEX_INITIALIZER_NP;

void moray_mumps_lock(void)
{
    pthread_mutex_lock(&mutex);
}

void moray_mumps_unlock(void)
{
    pthread_mutex_unlock(&mutex);
}
