/* SPDX-License-Identifier: MIT */
/* bytes.c: from the fuzzer's bytes to numbers, poses, rays, ids. */
#include "script.h"

#include <float.h>
#include <math.h>

uint8_t read_byte(script *s) {
    return s->bytes < s->end ? *s->bytes++ : 0;
}

uint32_t read_below(script *s, uint32_t n) {
    return read_byte(s) % n;
}

double read_number(script *s) {
    static const double WORST[] = {0.0,     -0.0,    NAN,     HUGE_VAL,  -HUGE_VAL, 5e-324, -5e-324, DBL_MIN,
                                   DBL_MAX, 1e100,   -1e100,  1.1e100,   1e-100,    9e-101, 1e-160,  1e160,
                                   1e38,    1e-38,   1e9,     -1e9,      1e12,      1e-12,  0x1p31,  0x1p53,
                                   0x1p63,  -0x1p63, 0x1p-40, 1e6 + 0.1, 3e9,       -3e9,   1e20,    1e-20};
    uint8_t kind = read_byte(s);
    if (kind < 150) return (int8_t)read_byte(s) / 4.0;
    if (kind < 190) return (int8_t)read_byte(s) + read_byte(s) / 256.0;
    if (kind < 210) return (int8_t)read_byte(s) * 1000.0;
    return WORST[read_byte(s) % (sizeof WORST / sizeof *WORST)];
}

float read_float(script *s) {
    double x = read_number(s);
    /* Out of the range of float the conversion would be undefined. */
    if (fabs(x) > FLT_MAX) x = x > 0 ? HUGE_VAL : -HUGE_VAL;
    return (float)x;
}

size_t read_size(script *s, size_t right) {
    /* Never more than the struct has: the library looks at what lies beyond the part that it knows. */
    uint8_t kind = read_byte(s);
    return kind == 255 ? 0 : kind == 254 ? right - 1 : kind == 253 ? right - 8 : kind == 252 ? 8 : right;
}

rg_pose read_pose(script *s) {
    rg_pose pose = {{0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1};
    uint8_t kind = read_byte(s);
    for (int i = 0; i < 3; i++) pose.position[i] = read_number(s);
    if (kind & 64) pose.scale = read_number(s);
    if (kind % 2) return pose;
    if (kind % 4) {
        for (int i = 0; i < 3; i++) pose.linear[4 * i] = read_float(s);
        return pose;
    }
    for (int i = 0; i < 9; i++) pose.linear[i] = read_float(s);
    return pose;
}

rg_ray read_ray(script *s) {
    rg_ray ray = {.t_max = HUGE_VAL, .mask = UINT32_MAX};
    uint8_t kind = read_byte(s);
    for (int i = 0; i < 3; i++) ray.origin[i] = read_number(s);
    for (int i = 0; i < 3; i++) ray.direction[i] = read_number(s);
    if (kind & 1) ray.t_min = read_number(s);
    if (kind & 2) ray.t_max = read_number(s);
    if (kind & 4) ray.mask = read_byte(s);
    if (kind & 8) ray.reserved = UINT32_MAX;
    return ray;
}

rg_grid_config read_grid_config(script *s) {
    static const uint32_t RESOLUTIONS[] = {0, 0, 0, 1, 2, 5, 16, 40, 64, (1u << 20) + 1, UINT32_MAX};
    rg_grid_config config = {0};
    config.size = read_size(s, sizeof config);
    uint32_t number = read_below(s, 16);
    config.kind = (rg_grid_kind)(number < 15 ? number % 4 : number); /* 15 is none */
    config.resolution = RESOLUTIONS[read_below(s, sizeof RESOLUTIONS / sizeof *RESOLUTIONS)];
    uint8_t kind = read_byte(s);
    for (int i = 0; kind & 1 && i < 3; i++) {
        config.lo[i] = read_number(s);
        config.hi[i] = read_number(s);
    }
    if (kind & 2) config.rebuild_factor = read_number(s);
    if (kind & 4) config.rebuild_factor = RG_REBUILD_NEVER;
    return config;
}

rg_object read_object(script *s) {
    uint8_t which = read_byte(s);
    if (which >= 250) return (rg_object)read_byte(s) << 32 | read_byte(s);
    return s->object_count ? s->objects[which % s->object_count] : RG_NO_OBJECT;
}

rg_grid read_grid(script *s) {
    uint8_t which = read_byte(s);
    if (which >= 250) return (rg_grid)(which * UINT32_C(0x01010101));
    return which % 3 == 0 || s->grid_count == 0 ? RG_GRID_OF_SCENE : s->grids[which % s->grid_count];
}
