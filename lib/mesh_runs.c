/* SPDX-License-Identifier: MIT */
/*
 * The leaves of a mesh that is made in a hurry: its triangles are sorted along a space-filling curve, as in
 * C. Lauterbach et al., "Fast BVH Construction on GPUs" (Eurographics 2009), section 3, and cut into runs, each of
 * which is a leaf. The tree is then one over leaves, a sixteenth as many as triangles.
 */
#include "mesh_build.h"

#include "beam.h"
#include "error.h"

#include <string.h>

/* Triangles are asked for so many before they are read. */
enum { AHEAD = 24 };

/* Cells of the curve along the longest axis, as a power of two; digits of the sort, of which so many make a place. */
enum { CURVE_BITS = 10, DIGIT_BITS = 10, DIGITS = 1 << DIGIT_BITS, SORTS = 3 * CURVE_BITS / DIGIT_BITS };

/** A triangle's place on the curve, and in the lower half its number. */
typedef uint64_t key;

static uint32_t place_of(key k) {
    return (uint32_t)(k >> 32);
}

/* ------------------------------------------------------------------------------------------------ the curve */

/* Two zeros after each bit. */
static uint32_t spread(uint32_t x) {
    x = (x | x << 16) & 0x030000FF;
    x = (x | x << 8) & 0x0300F00F;
    x = (x | x << 4) & 0x030C30C3;
    return (x | x << 2) & 0x09249249;
}

/* The cells are cubes. */
static void make_keys(const rgi_making *m, key *keys) {
    const rgi_mesh *mesh = m->mesh;
    float lo[3], widest = 0, scale;
    uint32_t spreads[1 << CURVE_BITS];
    for (uint32_t i = 0; i < 1u << CURVE_BITS; i++) spreads[i] = spread(i);
    for (int a = 0; a < 3; a++) {
        float in_frame = (float)((mesh->lo[a] - mesh->origin[a]) * mesh->scale);
        float width = (float)((mesh->hi[a] - mesh->lo[a]) * mesh->scale);
        lo[a] = 3 * in_frame;
        widest = width > widest ? width : widest;
    }
    scale = ((1 << CURVE_BITS) - 1) * (1 - 0x1p-10f) / (3 * widest);
    if (!(scale < 0x1p100f)) scale = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const float *p = rgi_corner(m, i, 0), *q = rgi_corner(m, i, 1), *r = rgi_corner(m, i, 2);
        uint32_t at[3];
        for (int a = 0; a < 3; a++) {
            float steps = (p[a] + q[a] + r[a] - lo[a]) * scale;
            at[a] = steps > 0 ? (uint32_t)steps : 0;
        }
        keys[i] = (uint64_t)(spreads[at[0]] | spreads[at[1]] << 1 | spreads[at[2]] << 2) << 32 | i;
    }
}

/* By the places, the lowest digit first. Returns which of the arrays has them. */
static key *sort_keys(key *keys, key *other, uint32_t count) {
    uint32_t starts[SORTS][DIGITS];
    memset(starts, 0, sizeof starts);
    for (uint32_t i = 0; i < count; i++) {
        for (int s = 0; s < SORTS; s++) starts[s][place_of(keys[i]) >> (s * DIGIT_BITS) & (DIGITS - 1)]++;
    }
    for (int s = 0; s < SORTS; s++) {
        for (uint32_t d = 0, sum = 0; d < DIGITS; d++) {
            uint32_t of_digit = starts[s][d];
            starts[s][d] = sum;
            sum += of_digit;
        }
        for (uint32_t i = 0; i < count; i++) {
            uint32_t digit = place_of(keys[i]) >> (s * DIGIT_BITS) & (DIGITS - 1);
            other[starts[s][digit]++] = keys[i];
        }
        key *swap = keys;
        keys = other;
        other = swap;
    }
    return keys;
}

/* -------------------------------------------------------------------------------------------------- the cuts */

/** Runs on their way. A vertex that has been met in the run that begins now has a stamp of it, and its lane. */
typedef struct cutter {
    rgi_making *m;
    const key *keys;
    uint32_t *stamps; /* of each vertex: base + lane */
    uint32_t base;
} cutter;

/* Begins a run with as many triangles from `first` on as a leaf holds; vertices[i]: that those up to the i-th have.
 */
static void fill_run(cutter *c, uint32_t first, rgi_run *run, uint32_t vertices[RGI_LEAF]) {
    const rgi_making *m = c->m;
    uint32_t left = m->mesh->triangle_count - first, lanes = 0;
    run->first = first;
    run->count = left < m->fill ? left : m->fill;
    if (m->mesh->soup) return;
    if (c->base > UINT32_MAX - 2 * RGI_LEAF) {
        memset(c->stamps, 0, m->mesh->vertex_count * sizeof *c->stamps);
        c->base = 0;
    }
    c->base += RGI_LEAF;
    for (uint32_t i = 0; i < run->count; i++) {
        if (left > i + AHEAD) __builtin_prefetch(m->triangles[m->order[first + i + AHEAD]]);
        const uint32_t *t = m->triangles[m->order[first + i]];
        for (int k = 0; k < 3; k++) {
            uint32_t lane = c->stamps[t[k]] - c->base;
            if (lane >= RGI_LEAF) {
                if (lanes == RGI_LEAF) {
                    run->count = i;
                    return;
                }
                lane = lanes++;
                c->stamps[t[k]] = c->base + lane;
                run->numbers[lane] = t[k];
            }
            run->corner[k][i] = (uint8_t)lane;
        }
        vertices[i] = lanes;
    }
}

/* How many triangles of a run that could have more it gets: at least half of them, up to where the curve makes its
 * longest leap. */
static uint32_t best_count(const cutter *c, const rgi_run *run) {
    uint32_t best = run->count, most = 0;
    if (run->first + run->count == c->m->mesh->triangle_count) return best;
    for (uint32_t i = run->count; i > run->count / 2; i--) {
        const key *k = c->keys + run->first + i;
        uint32_t leap = place_of(k[-1]) ^ place_of(k[0]);
        if (leap <= most) continue;
        most = leap;
        best = i;
    }
    return best;
}

/* What is not used: corners at the first vertex, of which there are as many as are needed. */
static void end_run(rgi_run *run, uint32_t count, uint32_t vertices) {
    run->count = count;
    run->vertices = vertices;
    for (uint32_t i = count; i < RGI_LEAF; i++) run->corner[0][i] = run->corner[1][i] = run->corner[2][i] = 0;
    for (uint32_t k = vertices; k < RGI_LEAF; k++) run->numbers[k] = run->numbers[0];
}

static void cut(cutter *c) {
    rgi_making *m = c->m;
    for (uint32_t first = 0; first < m->mesh->triangle_count;) {
        rgi_run *run = &m->runs[m->item_count++];
        uint32_t vertices[RGI_LEAF] = {0};
        fill_run(c, first, run, vertices);
        uint32_t count = best_count(c, run);
        end_run(run, count, vertices[count - 1]);
        first += count;
    }
}

/* ------------------------------------------------------------------------------------------------ altogether */

static rg_result make_room(rgi_making *m, key *keys[2], uint32_t **stamps) {
    rgi_memory *memory = m->mesh->memory;
    const uint32_t count = m->mesh->triangle_count;
    rg_result result = RG_OK;
    m->run_room = count / 2 + 2; /* a run has two triangles at the least, but for the last */
    for (int i = 0; i < 2 && !result; i++)
        result = rgi_allocate(memory, count, sizeof *keys[i], "building a mesh", &keys[i]);
    if (!result) result = rgi_allocate(memory, count, sizeof *m->order, "building a mesh", &m->order);
    if (!result) result = rgi_allocate(memory, m->run_room, sizeof *m->runs, "building a mesh", &m->runs);
    if (result || m->mesh->soup) return result;
    return rgi_allocate(memory, m->mesh->vertex_count, sizeof **stamps, "building a mesh", stamps);
}

rg_result rgi_runs_make(rgi_making *m) {
    rgi_mesh *mesh = m->mesh;
    const uint32_t count = mesh->triangle_count;
    key *keys[2] = {NULL, NULL};
    uint32_t *stamps = NULL;
    rg_result result = make_room(m, keys, &stamps);
    if (!result) {
        make_keys(m, keys[0]);
        cutter c = {m, sort_keys(keys[0], keys[1], count), stamps, 0};
        for (uint32_t i = 0; i < count; i++) m->order[i] = (uint32_t)c.keys[i];
        if (stamps) memset(stamps, 0, mesh->vertex_count * sizeof *stamps);
        cut(&c);
    }
    for (int i = 0; i < 2; i++) rgi_release(mesh->memory, keys[i], count, sizeof *keys[i]);
    rgi_release(mesh->memory, stamps, mesh->vertex_count, sizeof *stamps);
    if (result) return result;
    result = rgi_allocate(mesh->memory, m->item_count, sizeof *m->items, "building a mesh", &m->items);
    if (!result) mesh->kernels->wrap_items(m);
    return result;
}

void rgi_runs_free(rgi_making *m) {
    rgi_memory *memory = m->mesh->memory;
    rgi_release(memory, m->order, m->mesh->triangle_count, sizeof *m->order);
    rgi_release(memory, m->runs, m->run_room, sizeof *m->runs);
}
