#pragma once

/// Marks a plain loop over arrays to be compiled for AVX2 as well; the processor chooses at run
/// time. Both give the same bits: the order of operations is the same and nothing is contracted.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TARSUS_VECTOR_CODE [[gnu::target_clones("avx2", "default")]]
/// For loops with more sums than AVX2 has registers.
#define TARSUS_MANY_SUMS [[gnu::target_clones("arch=skylake-avx512", "avx2", "default")]]
#else
#define TARSUS_VECTOR_CODE
#define TARSUS_MANY_SUMS
#endif
