/* SPDX-License-Identifier: MIT */
/*
 * Vectors of 8 and 16 floats for the kernels, in the instructions that RGI_ISA names. Kernels are written once, in
 * these; comparisons give a bit a lane. Where there is no fused multiply-add, rgi_fma rounds twice: the kernels'
 * error bounds count on no more.
 */
#ifndef RAYGRID_LIB_SIMD_H
#define RAYGRID_LIB_SIMD_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* As RG_ISA_* of raygrid/scene.h, for the preprocessor. */
#define RGI_ISA_PORTABLE 0
#define RGI_ISA_SSE2 1
#define RGI_ISA_AVX2 2
#define RGI_ISA_AVX512 3
#define RGI_ISA_NEON 4

#define RGI_INLINE static inline __attribute__((always_inline))

/* ------------------------------------------------------------------- one register, of RGI_LANES floats: `part` */

#if RGI_ISA == RGI_ISA_AVX2 || RGI_ISA == RGI_ISA_AVX512
#include <immintrin.h>
#define RGI_LANES 8
typedef __m256 part;
RGI_INLINE part part_load(const float *p) {
    return _mm256_loadu_ps(p);
}
RGI_INLINE void part_store(float *p, part a) {
    _mm256_storeu_ps(p, a);
}
RGI_INLINE part part_set(float x) {
    return _mm256_set1_ps(x);
}
RGI_INLINE part part_add(part a, part b) {
    return _mm256_add_ps(a, b);
}
RGI_INLINE part part_sub(part a, part b) {
    return _mm256_sub_ps(a, b);
}
RGI_INLINE part part_mul(part a, part b) {
    return _mm256_mul_ps(a, b);
}
RGI_INLINE part part_fma(part a, part b, part c) {
    return _mm256_fmadd_ps(a, b, c);
}
RGI_INLINE part part_min(part a, part b) {
    return _mm256_min_ps(a, b);
}
RGI_INLINE part part_max(part a, part b) {
    return _mm256_max_ps(a, b);
}
RGI_INLINE part part_sqrt(part a) {
    return _mm256_sqrt_ps(a);
}
RGI_INLINE uint32_t part_le(part a, part b) {
    return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
}
RGI_INLINE part part_pick(uint32_t bits, part a, part b) {
    const __m256i lanes = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    __m256i set = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)bits), lanes), lanes);
    return _mm256_blendv_ps(b, a, _mm256_castsi256_ps(set));
}

#elif RGI_ISA == RGI_ISA_SSE2
#include <emmintrin.h>
#define RGI_LANES 4
typedef __m128 part;
RGI_INLINE part part_load(const float *p) {
    return _mm_loadu_ps(p);
}
RGI_INLINE void part_store(float *p, part a) {
    _mm_storeu_ps(p, a);
}
RGI_INLINE part part_set(float x) {
    return _mm_set1_ps(x);
}
RGI_INLINE part part_add(part a, part b) {
    return _mm_add_ps(a, b);
}
RGI_INLINE part part_sub(part a, part b) {
    return _mm_sub_ps(a, b);
}
RGI_INLINE part part_mul(part a, part b) {
    return _mm_mul_ps(a, b);
}
RGI_INLINE part part_fma(part a, part b, part c) {
    return _mm_add_ps(_mm_mul_ps(a, b), c);
}
RGI_INLINE part part_min(part a, part b) {
    return _mm_min_ps(a, b);
}
RGI_INLINE part part_max(part a, part b) {
    return _mm_max_ps(a, b);
}
RGI_INLINE part part_sqrt(part a) {
    return _mm_sqrt_ps(a);
}
RGI_INLINE uint32_t part_le(part a, part b) {
    return (uint32_t)_mm_movemask_ps(_mm_cmple_ps(a, b));
}
RGI_INLINE part part_pick(uint32_t bits, part a, part b) {
    const __m128i lanes = _mm_setr_epi32(1, 2, 4, 8);
    __m128 set = _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32((int)bits), lanes), lanes));
    return _mm_or_ps(_mm_and_ps(set, a), _mm_andnot_ps(set, b));
}

#elif RGI_ISA == RGI_ISA_NEON
#include <arm_neon.h>
#define RGI_LANES 4
typedef float32x4_t part;
RGI_INLINE part part_load(const float *p) {
    return vld1q_f32(p);
}
RGI_INLINE void part_store(float *p, part a) {
    vst1q_f32(p, a);
}
RGI_INLINE part part_set(float x) {
    return vdupq_n_f32(x);
}
RGI_INLINE part part_add(part a, part b) {
    return vaddq_f32(a, b);
}
RGI_INLINE part part_sub(part a, part b) {
    return vsubq_f32(a, b);
}
RGI_INLINE part part_mul(part a, part b) {
    return vmulq_f32(a, b);
}
RGI_INLINE part part_fma(part a, part b, part c) {
    return vfmaq_f32(c, a, b);
}
RGI_INLINE part part_min(part a, part b) {
    return vminq_f32(a, b);
}
RGI_INLINE part part_max(part a, part b) {
    return vmaxq_f32(a, b);
}
RGI_INLINE part part_sqrt(part a) {
    return vsqrtq_f32(a);
}
RGI_INLINE uint32_t part_le(part a, part b) {
    static const uint32_t weights[4] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(vcleq_f32(a, b), vld1q_u32(weights)));
}
RGI_INLINE part part_pick(uint32_t bits, part a, part b) {
    static const uint32_t weights[4] = {1, 2, 4, 8};
    return vbslq_f32(vtstq_u32(vdupq_n_u32(bits), vld1q_u32(weights)), a, b);
}

#else
#define RGI_LANES 1
typedef float part;
RGI_INLINE part part_load(const float *p) {
    return *p;
}
RGI_INLINE void part_store(float *p, part a) {
    *p = a;
}
RGI_INLINE part part_set(float x) {
    return x;
}
RGI_INLINE part part_add(part a, part b) {
    return a + b;
}
RGI_INLINE part part_sub(part a, part b) {
    return a - b;
}
RGI_INLINE part part_mul(part a, part b) {
    return a * b;
}
RGI_INLINE part part_fma(part a, part b, part c) {
    return a * b + c;
}
RGI_INLINE part part_min(part a, part b) {
    return a < b ? a : b;
}
RGI_INLINE part part_max(part a, part b) {
    return a > b ? a : b;
}
RGI_INLINE part part_sqrt(part a) {
    return sqrtf(a);
}
RGI_INLINE uint32_t part_le(part a, part b) {
    return a <= b;
}
RGI_INLINE part part_pick(uint32_t bits, part a, part b) {
    return bits & 1 ? a : b;
}
#endif

/* ------------------------------------------------------------------------- wide: of any number of registers */

#define RGI_WIDE(name, lanes)                                                                                        \
    typedef struct name {                                                                                            \
        part v[(lanes) / RGI_LANES];                                                                                 \
    } name;                                                                                                          \
    RGI_INLINE name name##_load(const float *p) {                                                                    \
        name r;                                                                                                      \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) r.v[i] = part_load(p + i * RGI_LANES);                         \
        return r;                                                                                                    \
    }                                                                                                                \
    RGI_INLINE void name##_store(float *p, name a) {                                                                 \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) part_store(p + i * RGI_LANES, a.v[i]);                         \
    }                                                                                                                \
    RGI_INLINE name name##_set(float x) {                                                                            \
        name r;                                                                                                      \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) r.v[i] = part_set(x);                                          \
        return r;                                                                                                    \
    }                                                                                                                \
    RGI_WIDE_OF_TWO(name, lanes, add)                                                                                \
    RGI_WIDE_OF_TWO(name, lanes, sub)                                                                                \
    RGI_WIDE_OF_TWO(name, lanes, mul)                                                                                \
    RGI_WIDE_OF_TWO(name, lanes, min)                                                                                \
    RGI_WIDE_OF_TWO(name, lanes, max)                                                                                \
    RGI_INLINE name name##_fma(name a, name b, name c) {                                                             \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) a.v[i] = part_fma(a.v[i], b.v[i], c.v[i]);                     \
        return a;                                                                                                    \
    }                                                                                                                \
    RGI_INLINE name name##_sqrt(name a) {                                                                            \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) a.v[i] = part_sqrt(a.v[i]);                                    \
        return a;                                                                                                    \
    }                                                                                                                \
    RGI_INLINE uint32_t name##_le(name a, name b) {                                                                  \
        uint32_t bits = 0;                                                                                           \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) bits |= part_le(a.v[i], b.v[i]) << (i * RGI_LANES);            \
        return bits;                                                                                                 \
    }                                                                                                                \
    RGI_INLINE name name##_pick(uint32_t bits, name a, name b) {                                                     \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) a.v[i] = part_pick(bits >> (i * RGI_LANES), a.v[i], b.v[i]);   \
        return a;                                                                                                    \
    }

#define RGI_WIDE_OF_TWO(name, lanes, operation)                                                                      \
    RGI_INLINE name name##_##operation(name a, name b) {                                                             \
        for (int i = 0; i < (lanes) / RGI_LANES; i++) a.v[i] = part_##operation(a.v[i], b.v[i]);                     \
        return a;                                                                                                    \
    }

RGI_WIDE(f8, 8)

#if RGI_ISA == RGI_ISA_AVX512
/* One register. The name f16 is free: this is no half precision. */
typedef __m512 f16;
RGI_INLINE f16 f16_load(const float *p) {
    return _mm512_loadu_ps(p);
}
RGI_INLINE void f16_store(float *p, f16 a) {
    _mm512_storeu_ps(p, a);
}
RGI_INLINE f16 f16_set(float x) {
    return _mm512_set1_ps(x);
}
RGI_INLINE f16 f16_add(f16 a, f16 b) {
    return _mm512_add_ps(a, b);
}
RGI_INLINE f16 f16_sub(f16 a, f16 b) {
    return _mm512_sub_ps(a, b);
}
RGI_INLINE f16 f16_mul(f16 a, f16 b) {
    return _mm512_mul_ps(a, b);
}
RGI_INLINE f16 f16_min(f16 a, f16 b) {
    return _mm512_min_ps(a, b);
}
RGI_INLINE f16 f16_max(f16 a, f16 b) {
    return _mm512_max_ps(a, b);
}
RGI_INLINE f16 f16_fma(f16 a, f16 b, f16 c) {
    return _mm512_fmadd_ps(a, b, c);
}
RGI_INLINE f16 f16_sqrt(f16 a) {
    return _mm512_sqrt_ps(a);
}
RGI_INLINE uint32_t f16_le(f16 a, f16 b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}
RGI_INLINE f16 f16_pick(uint32_t bits, f16 a, f16 b) {
    return _mm512_mask_blend_ps((__mmask16)bits, b, a);
}
#else
RGI_WIDE(f16, 16)
#endif

/* The largest and the smallest lane. */
#if RGI_ISA == RGI_ISA_AVX512
RGI_INLINE float f16_most(f16 a) {
    return _mm512_reduce_max_ps(a);
}
RGI_INLINE float f16_least(f16 a) {
    return _mm512_reduce_min_ps(a);
}
#else
RGI_INLINE float f16_most(f16 a) {
    float v[RGI_LANES];
    for (int i = 1; i < 16 / RGI_LANES; i++) a.v[0] = part_max(a.v[0], a.v[i]);
    part_store(v, a.v[0]);
    for (int i = 1; i < RGI_LANES; i++) v[0] = v[i] > v[0] ? v[i] : v[0];
    return v[0];
}
RGI_INLINE float f16_least(f16 a) {
    float v[RGI_LANES];
    for (int i = 1; i < 16 / RGI_LANES; i++) a.v[0] = part_min(a.v[0], a.v[i]);
    part_store(v, a.v[0]);
    for (int i = 1; i < RGI_LANES; i++) v[0] = v[i] < v[0] ? v[i] : v[0];
    return v[0];
}
#endif

/**
 * Puts the lanes of t that `bits` names, and the numbers beside them, to the end of two arrays, in the order
 * order[0], order[1], ...; returns how many. Up to 8 elements behind the last are overwritten.
 */
RGI_INLINE uint32_t f8_keep(uint32_t bits, const uint32_t order[8], f8 t, const uint32_t numbers[8], float *ts,
                            uint32_t *kept) {
#if RGI_ISA == RGI_ISA_AVX512
    __m256i by = _mm256_loadu_si256((const __m256i *)order);
    /* Bit i of `bits` to the place where order has i. */
    __mmask8 mask = _mm256_test_epi32_mask(_mm256_sllv_epi32(_mm256_set1_epi32(1), by), _mm256_set1_epi32((int)bits));
    __m256 tp = _mm256_maskz_compress_ps(mask, _mm256_permutexvar_ps(by, t.v[0]));
    __m256i np =
        _mm256_maskz_compress_epi32(mask, _mm256_permutexvar_epi32(by, _mm256_load_si256((const __m256i *)numbers)));
    _mm256_storeu_ps(ts, tp);
    _mm256_storeu_si256((__m256i *)kept, np);
    return (uint32_t)__builtin_popcount(bits);
#else
    uint32_t count = 0;
    float at[8];
    f8_store(at, t);
    for (int i = 0; i < 8; i++) {
        uint32_t lane = order[i];
        ts[count] = at[lane];
        kept[count] = numbers[lane];
        count += bits >> lane & 1;
    }
    return count;
#endif
}

/** The halves the other way round. */
RGI_INLINE f8 f8_turned(f8 a) {
#if RGI_LANES == 8
    return (f8){{_mm256_permute2f128_ps(a.v[0], a.v[0], 1)}};
#else
    f8 r;
    for (int i = 0; i < 8 / RGI_LANES; i++) r.v[i] = a.v[(i + 4 / RGI_LANES) % (8 / RGI_LANES)];
    return r;
#endif
}

/** Four floats, twice. */
RGI_INLINE f8 f8_twice(const float four[4]) {
#if RGI_LANES == 8
    return (f8){{_mm256_broadcast_ps((const __m128 *)four)}};
#else
    float eight[8];
    for (int i = 0; i < 8; i++) eight[i] = four[i % 4];
    return f8_load(eight);
#endif
}

/** The lanes of `table` that 16 numbers below 16 name. */
RGI_INLINE f16 f16_take(f16 table, const uint8_t numbers[16]) {
#if RGI_ISA == RGI_ISA_AVX512
    return _mm512_permutexvar_ps(_mm512_cvtepu8_epi32(_mm_load_si128((const __m128i *)numbers)), table);
#elif RGI_ISA == RGI_ISA_AVX2
    f16 taken;
    for (int i = 0; i < 2; i++) {
        __m256i by = _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(numbers + 8 * i)));
        __m256 low = _mm256_permutevar8x32_ps(table.v[0], by), high = _mm256_permutevar8x32_ps(table.v[1], by);
        /* Bit 3, moved to the sign, chooses the half. */
        taken.v[i] = _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(by, 28)));
    }
    return taken;
#else
    float from[16], to[16];
    f16_store(from, table);
    for (int i = 0; i < 16; i++) to[i] = from[numbers[i]];
    return f16_load(to);
#endif
}

#endif
