// SPDX-License-Identifier: MIT
//
// How many doubles go into a register. Code for every x86-64 processor has functions of its own for each kind
// (SEVERAL_PROCESSORS) and asks which it runs on; what is compiled for one processor needs OWN_LANES alone. Registers
// must be the processor's: gcc takes wider vectors apart by way of memory, which is several times slower.
#ifndef SRC_BASE_LANES_H
#define SRC_BASE_LANES_H

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && !defined(__AVX__)
#define SEVERAL_PROCESSORS
#define FOR_EACH_PROCESSOR __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define FOR_EACH_PROCESSOR
#endif

#if defined(__AVX512F__)
#define OWN_LANES 8
#elif defined(__AVX__)
#define OWN_LANES 4
#else
#define OWN_LANES 2
#endif

// 8, 4 or 2, of those that this code has.
static inline int processor_lanes(void)
{
#ifdef SEVERAL_PROCESSORS
    if (__builtin_cpu_supports("x86-64-v4"))
        return 8;
    if (__builtin_cpu_supports("x86-64-v3"))
        return 4;
#endif
    return OWN_LANES;
}

#endif
