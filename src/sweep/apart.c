// SPDX-License-Identifier: MIT
#include "sweep/sweep.h"

#include <sys/mman.h>

void *moray_apart_new(size_t n, size_t size)
{
    void *memory = mmap(NULL, n * size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
        return NULL;
    madvise(memory, n * size, MADV_DONTFORK);
    return memory;
}

void moray_apart_free(void *memory, size_t n, size_t size)
{
    if (memory)
        munmap(memory, n * size);
}
