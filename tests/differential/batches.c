/* SPDX-License-Identifier: MIT */
#include "batches.h"

#include <string.h>

static void pick_point(random_source *r, const batch_space *space, double reach, double point[3]) {
    for (int i = 0; i < 3; i++) point[i] = space->centre[i] + random_between(r, -1, 1) * reach * space->spread;
}

/* Two directions across `along`, of length 1. */
static void make_screen(const double along[3], double right[3], double up[3]) {
    double length = 0;
    int least = fabs(along[0]) < fabs(along[1]) ? 0 : 1;
    if (fabs(along[2]) < fabs(along[least])) least = 2;
    int b = (least + 1) % 3, c = (least + 2) % 3;
    right[least] = 0, right[b] = -along[c], right[c] = along[b];
    for (int i = 0; i < 3; i++) length += right[i] * right[i];
    for (int i = 0; i < 3; i++) right[i] /= sqrt(length);
    for (int i = 0; i < 3; i++)
        up[i] = along[(i + 1) % 3] * right[(i + 2) % 3] - along[(i + 2) % 3] * right[(i + 1) % 3];
}

/* A direction; at times along an axis or in a plane of two, with zeros of either sign. */
static void pick_along(random_source *r, double along[3]) {
    random_direction(r, along);
    if (!random_once_in(r, 4)) return;
    int axis = (int)random_below(r, 3);
    along[axis] = random_once_in(r, 2) ? 0.0 : -0.0;
    if (random_once_in(r, 2)) {
        for (int i = 0; i < 3; i++) along[i] = i == axis ? (random_once_in(r, 2) ? 1 : -1) : 0;
    }
}

/* Pixel i of a screen of rows of 4, 8, 16 or as many as there are, in steps from the middle. */
static void pixel(uint32_t i, uint32_t width, uint32_t count, double *x, double *y) {
    *x = (double)(i % width) - 0.5 * (width - 1);
    *y = (double)(i / width) - 0.5 * ((count - 1) / width);
}

static uint32_t pick_width(random_source *r, uint32_t count) {
    static const uint32_t WIDTHS[] = {4, 8, 16, 64};
    uint32_t width = WIDTHS[random_below(r, 4)];
    return width < count ? width : count;
}

/* From one eye, outside of the scene or in it. */
static void camera(random_source *r, const batch_space *space, rg_ray *rays, uint32_t count) {
    double eye[3], target[3], along[3], right[3], up[3], x, y, length = 0;
    uint32_t width = pick_width(r, count);
    double angle = random_decade(r, -4, -1);
    pick_point(r, space, 1, target);
    if (random_once_in(r, 2)) {
        pick_point(r, space, 1, eye);
    } else {
        random_direction(r, along);
        double away = space->spread * random_between(r, 1, 5);
        for (int i = 0; i < 3; i++) eye[i] = space->centre[i] + away * along[i];
    }
    for (int i = 0; i < 3; i++) along[i] = target[i] - eye[i], length += along[i] * along[i];
    if (!(length > 0)) along[0] = length = 1;
    for (int i = 0; i < 3; i++) along[i] /= sqrt(length);
    if (random_once_in(r, 8)) pick_along(r, along);
    make_screen(along, right, up);
    for (uint32_t n = 0; n < count; n++) {
        pixel(n, width, count, &x, &y);
        double d[3];
        for (int i = 0; i < 3; i++) d[i] = along[i] + angle * (x * right[i] + y * up[i]);
        rays[n] = rg_ray_from(eye, d);
    }
}

/* Of one direction, from points of a plane; as exactly parallel as can be. */
static void parallel(random_source *r, const batch_space *space, rg_ray *rays, uint32_t count) {
    double base[3], along[3], right[3], up[3], x, y;
    uint32_t width = pick_width(r, count);
    double step = space->spread * random_decade(r, -4, -1), back = space->spread * random_between(r, 0, 4);
    pick_along(r, along);
    make_screen(along, right, up);
    pick_point(r, space, 1, base);
    for (uint32_t n = 0; n < count; n++) {
        pixel(n, width, count, &x, &y);
        double o[3];
        for (int i = 0; i < 3; i++) o[i] = base[i] - back * along[i] + step * (x * right[i] + y * up[i]);
        rays[n] = rg_ray_from(o, along);
    }
}

static void towards(const double from[3], const double light[3], rg_ray *ray) {
    double d[3];
    for (int i = 0; i < 3; i++) d[i] = light[i] - from[i];
    *ray = rg_ray_from(from, d);
    ray->t_max = 1;
}

/* From points of a plane to one light. */
static void to_light(random_source *r, const batch_space *space, rg_ray *rays, uint32_t count) {
    double base[3], light[3], along[3], right[3], up[3], x, y;
    uint32_t width = pick_width(r, count);
    double step = space->spread * random_decade(r, -3, -1);
    pick_along(r, along);
    make_screen(along, right, up);
    pick_point(r, space, 1, base);
    pick_point(r, space, random_once_in(r, 2) ? 1 : 4, light);
    for (uint32_t n = 0; n < count; n++) {
        pixel(n, width, count, &x, &y);
        double o[3];
        for (int i = 0; i < 3; i++) o[i] = base[i] + step * (x * right[i] + y * up[i]);
        towards(o, light, &rays[n]);
    }
}

/* What does not fit in a group. */
static void spoil(random_source *r, const batch_space *space, rg_ray *ray) {
    int axis = (int)random_below(r, 3);
    double length = 0;
    for (int i = 0; i < 3; i++) length += ray->direction[i] * ray->direction[i];
    length = sqrt(length);
    switch (random_below(r, 9)) {
    case 0:
        ray->direction[axis] = -ray->direction[axis];
        break;
    case 1:
        ray->direction[axis] = random_once_in(r, 2) ? 0.0 : -0.0;
        break;
    case 2:
        ray->direction[axis] = NAN;
        break;
    case 3:
        memset(ray->direction, 0, sizeof ray->direction);
        break;
    case 4:
        ray->t_min = 1;
        ray->t_max = 0;
        break;
    case 5:
        ray->t_max = random_between(r, 0, 4) * space->spread / length;
        break;
    case 6:
        ray->t_min = random_between(r, -2, 2) * space->spread / length;
        ray->t_max = ray->t_min + random_between(r, 0, 2) * space->spread / length;
        break;
    case 7:
        for (int i = 0; i < 3; i++) ray->direction[i] *= 0x1p-30;
        ray->t_max *= 0x1p30;
        break;
    default:
        ray->t_min = -INFINITY;
        break;
    }
}

void batch_rays(random_source *r, const batch_space *space, rg_ray *rays, uint32_t count) {
    switch (random_below(r, 4)) {
    case 0:
        parallel(r, space, rays, count);
        break;
    case 1:
        to_light(r, space, rays, count);
        break;
    default:
        camera(r, space, rays, count);
        break;
    }
    /* Half of the batches are as hosts send them; in the others one ray in some is odd. */
    if (random_once_in(r, 2)) return;
    uint32_t seldom = 1 + random_below(r, 24);
    for (uint32_t n = 0; n < count; n++) {
        if (random_once_in(r, seldom)) spoil(r, space, &rays[n]);
    }
}

void batch_shadows(random_source *r, const batch_space *space, const rg_hit *hits, rg_ray *rays, uint32_t count) {
    double light[3];
    pick_point(r, space, random_once_in(r, 2) ? 1 : 4, light);
    for (uint32_t n = 0; n < count; n++) {
        double from[3];
        pick_point(r, space, 1, from);
        bool leaves = hits[n].object != RG_NO_OBJECT && isfinite(hits[n].offset);
        for (int i = 0; leaves && i < 3; i++)
            from[i] = hits[n].position[i] + (double)hits[n].offset * hits[n].normal[i];
        towards(from, light, &rays[n]);
    }
}
