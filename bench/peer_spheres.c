/* SPDX-License-Identifier: MIT */
#include "peer_spheres.h"

#include <math.h>

#define ALWAYS_INLINE inline __attribute__((always_inline))

enum { WIDEST = 16 };

static void find_bounds(const struct embree_bounds_arguments *arguments) {
    const float *sphere = (const float *)arguments->user + 4 * (size_t)arguments->primitive;
    for (int k = 0; k < 3; k++) {
        arguments->bounds[k] = sphere[k] - sphere[3];
        arguments->bounds[4 + k] = sphere[k] + sphere[3];
    }
}

/**
 * Where each ray meets the sphere, or +inf. The foot of the perpendicular from the centre keeps the digits that
 * b^2 - 4ac loses, as in the peer's own sphere points. No branch, so that the compiler takes many rays at once.
 */
static ALWAYS_INLINE float meet(const float *sphere, const float *rays, uint32_t n, uint32_t i) {
    float dx = rays[ROW_DIRECTION * n + i], dy = rays[(ROW_DIRECTION + 1) * n + i];
    float dz = rays[(ROW_DIRECTION + 2) * n + i];
    float x = sphere[0] - rays[ROW_ORIGIN * n + i], y = sphere[1] - rays[(ROW_ORIGIN + 1) * n + i];
    float z = sphere[2] - rays[(ROW_ORIGIN + 2) * n + i];
    float inverse = 1 / (dx * dx + dy * dy + dz * dz), foot = (x * dx + y * dy + z * dz) * inverse;
    float sx = x - foot * dx, sy = y - foot * dy, sz = z - foot * dz;
    float rest = sphere[3] * sphere[3] - (sx * sx + sy * sy + sz * sz);
    float half = sqrtf((rest > 0 ? rest : 0) * inverse);
    float near = rays[ROW_T_NEAR * n + i], far = rays[ROW_T_FAR * n + i];
    float front = foot - half, back = foot + half;
    float t = front >= near ? front : back;
    int hit = (rest >= 0) & (t >= near) & (t <= far);
    return hit ? t : INFINITY;
}

static ALWAYS_INLINE bool meet_all(const struct embree_hit_arguments *arguments, uint32_t n, float *t) {
    const float *sphere = (const float *)arguments->user + 4 * (size_t)arguments->primitive;
    const int *valid = arguments->valid;
    const float *rays = arguments->rays;
    float all[WIDEST];
    int any = 0;
    /* Two loops: in one, the compiler would make a branch of `valid`. */
    for (uint32_t i = 0; i < n; i++) all[i] = meet(sphere, rays, n, i);
    for (uint32_t i = 0; i < n; i++) {
        t[i] = valid[i] ? all[i] : INFINITY;
        any |= t[i] < INFINITY;
    }
    return any;
}

static ALWAYS_INLINE void intersect_some(const struct embree_hit_arguments *arguments, uint32_t n) {
    const float *sphere = (const float *)arguments->user + 4 * (size_t)arguments->primitive;
    float *rays = arguments->rays, t[WIDEST];
    uint32_t *words = (uint32_t *)(void *)rays;
    if (!meet_all(arguments, n, t)) return;
    for (uint32_t i = 0; i < n; i++) {
        if (!(t[i] < INFINITY)) continue;
        rays[ROW_T_FAR * n + i] = t[i];
        for (uint32_t k = 0; k < 3; k++) {
            rays[(ROW_NORMAL + k) * n + i] =
                rays[(ROW_ORIGIN + k) * n + i] + t[i] * rays[(ROW_DIRECTION + k) * n + i] - sphere[k];
        }
        rays[ROW_U * n + i] = rays[ROW_V * n + i] = 0;
        words[ROW_PRIMITIVE * n + i] = arguments->primitive;
        words[ROW_GEOMETRY * n + i] = arguments->geometry;
    }
}

static ALWAYS_INLINE void occlude_some(const struct embree_hit_arguments *arguments, uint32_t n) {
    float *far = arguments->rays + ROW_T_FAR * n, t[WIDEST];
    if (!meet_all(arguments, n, t)) return;
    for (uint32_t i = 0; i < n; i++) far[i] = t[i] < INFINITY ? -INFINITY : far[i];
}

/* Each number of rays that the peer hands over, as a number that the compiler knows. */
#define FOR_EACH_COUNT(function)                                                                                     \
    switch (arguments->count) {                                                                                      \
    case 1:                                                                                                          \
        function(arguments, 1);                                                                                      \
        break;                                                                                                       \
    case 4:                                                                                                          \
        function(arguments, 4);                                                                                      \
        break;                                                                                                       \
    case 8:                                                                                                          \
        function(arguments, 8);                                                                                      \
        break;                                                                                                       \
    default:                                                                                                         \
        function(arguments, 16);                                                                                     \
    }

static ALWAYS_INLINE void intersect(const struct embree_hit_arguments *arguments) {
    FOR_EACH_COUNT(intersect_some)
}

static ALWAYS_INLINE void occlude(const struct embree_hit_arguments *arguments) {
    FOR_EACH_COUNT(occlude_some)
}

static void intersect_plain(const struct embree_hit_arguments *arguments) {
    intersect(arguments);
}

static void occlude_plain(const struct embree_hit_arguments *arguments) {
    occlude(arguments);
}

/* So that the compiler's vectors are as wide as those of the peer's own kernels. */
#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) static void intersect_avx2(const struct embree_hit_arguments *arguments) {
    intersect(arguments);
}

__attribute__((target("avx2,fma"))) static void occlude_avx2(const struct embree_hit_arguments *arguments) {
    occlude(arguments);
}

__attribute__((target("avx512f,avx512vl,fma"))) static void
intersect_avx512(const struct embree_hit_arguments *arguments) {
    intersect(arguments);
}

__attribute__((target("avx512f,avx512vl,fma"))) static void
occlude_avx512(const struct embree_hit_arguments *arguments) {
    occlude(arguments);
}
#endif

struct peer_sphere_functions peer_sphere_functions(void) {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512vl")) {
        return (struct peer_sphere_functions){find_bounds, intersect_avx512, occlude_avx512};
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        return (struct peer_sphere_functions){find_bounds, intersect_avx2, occlude_avx2};
    }
#endif
    return (struct peer_sphere_functions){find_bounds, intersect_plain, occlude_plain};
}
