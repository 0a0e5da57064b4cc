/* SPDX-License-Identifier: MIT */
/* Many objects at once into an empty lattice: from the top down, each node's cell parted as an insert would part it.
 */
#include "lattice_parts.h"

#include "error.h"
#include "vec.h"

#include <stdlib.h>
#include <string.h>

enum { SAMPLE = 255 };

static int compare(const void *a, const void *b) {
    double x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/*
 * The frame: the unit is near the median of the objects' sizes and the origin at the median of their places, of a
 * sample. So a few that are far away, or of another order of magnitude, do not take the floats' bits from the others.
 */
void rgi_lattice_choose_frame(rgi_lattice *lattice, rgi_bound_source source, const void *context, uint64_t count,
                              const rgi_lattice *old) {
    double values[4][SAMPLE];
    uint64_t samples = count < SAMPLE ? count : SAMPLE, kept = 0;
    for (uint64_t i = 0; i < samples; i++) {
        rgi_bound bound;
        uint32_t slot;
        source(context, i * count / samples, &slot, &bound);
        double size = 0, sum = 0;
        for (int a = 0; a < 3; a++) {
            size = rgi_max(size, bound.hi[a] - bound.lo[a]);
            values[a][kept] = bound.centre[a];
            sum += fabs(bound.centre[a]);
        }
        values[3][kept] = size;
        kept += size < INFINITY && sum < INFINITY;
    }
    rgi_bound frame = {.ball = false};
    for (int k = 0; k < 4 && kept; k++) {
        qsort(values[k], kept, sizeof(double), compare);
        double median = values[k][kept / 2];
        if (k < 3) {
            frame.centre[k] = median;
        } else {
            for (int a = 0; a < 3; a++) frame.hi[a] = median;
        }
    }
    if (old && !kept) {
        rgi_lattice_box(old, frame.lo, frame.hi);
        for (int a = 0; a < 3; a++) frame.centre[a] = 0.5 * (frame.lo[a] + frame.hi[a]);
    }
    rgi_lattice_make_frame(lattice, &frame);
    lattice->framed = old != NULL;
}

/* Stores entries as a chain, whatever their number. */
static bool build_chain(rgi_lattice *lattice, const rgi_entry *entries, uint64_t count, uint32_t parent) {
    for (uint64_t first = 0; first < count; first += RGI_BLOCK) {
        uint32_t here = count - first < RGI_BLOCK ? (uint32_t)(count - first) : RGI_BLOCK, room = RGI_SMALLEST;
        bool balls = true;
        while (room < here) room *= 2;
        for (uint32_t i = 0; i < here; i++) balls &= entries[first + i].ball;
        rgi_ref ref = rgi_lattice_take(lattice, rgi_block_kind(room, balls));
        if (!ref) return false;
        rgi_lattice_link(lattice, parent, ref);
        for (uint32_t i = 0; i < here; i++) rgi_entry_write(lattice, ref, i, &entries[first + i]);
        rgi_block_at(lattice, ref)->count = (uint8_t)here;
    }
    rgi_lattice_count_members(lattice, parent, (int)count);
    return true;
}

static uint32_t lane_of(const rgi_node *n, const rgi_entry *e) {
    return e->least > n->half ? RGI_OWN : rgi_node_octant(n, e->centre);
}

/* Sorts entries into `sorted` by their places in a node; ends[i] is where those of place i end. Sets the boxes. */
static void sort_into(rgi_lattice *lattice, uint32_t index, const rgi_entry *entries, rgi_entry *sorted,
                      uint64_t count, uint64_t ends[RGI_OWN + 1]) {
    const rgi_node *n = rgi_node_at(lattice, index);
    uint64_t at[RGI_OWN + 1] = {0}, sum = 0;
    float lo[RGI_OWN + 1][3], hi[RGI_OWN + 1][3];
    for (uint32_t lane = 0; lane <= RGI_OWN; lane++) rgi_bounds_empty(lo[lane], hi[lane]);
    for (uint64_t i = 0; i < count; i++) at[lane_of(n, &entries[i])]++;
    for (uint32_t lane = 0; lane <= RGI_OWN; lane++) {
        uint64_t here = at[lane];
        at[lane] = sum;
        sum += here;
        ends[lane] = sum;
    }
    for (uint64_t i = 0; i < count; i++) {
        uint32_t lane = lane_of(n, &entries[i]);
        rgi_bounds_unite(lo[lane], hi[lane], entries[i].lo, entries[i].hi);
        sorted[at[lane]++] = entries[i];
    }
    for (uint32_t lane = 0; lane < RGI_OWN; lane++)
        rgi_lattice_set_box(lattice, index << 4 | lane, lo[lane], hi[lane]);
}

/* By recursion, as deep as there are widths of cells. `other` is room for as many entries. False: no memory. */
static bool build(rgi_lattice *lattice, rgi_entry *entries, rgi_entry *other, uint64_t count, uint32_t parent) {
    rgi_survey s;
    rgi_cell cell;
    uint32_t index;
    uint64_t ends[RGI_OWN + 1], movable = 0;
    if (count <= RGI_BLOCK) return build_chain(lattice, entries, count, parent);
    rgi_survey_begin(&s);
    for (uint64_t i = 0; i < count; i++) rgi_survey_add(&s, &entries[i]);
    bool parted = rgi_lattice_parting_cell(lattice, parent, &s, &cell);
    for (uint64_t i = 0; i < count && parted; i++) movable += entries[i].least <= cell.half;
    if (!parted || movable < RGI_WORTH_PARTING) return build_chain(lattice, entries, count, parent);
    if (!rgi_lattice_make_node(lattice, &cell, &index)) return false;
    *rgi_lattice_holder(lattice, parent) = index << 2;
    rgi_node_at(lattice, index)->parent = parent;
    if (parent != RGI_ROOT) rgi_node_at(lattice, parent >> 4)->nodes++;
    sort_into(lattice, index, entries, other, count, ends);
    uint64_t first = 0;
    for (uint32_t lane = 0; lane <= RGI_OWN; lane++) {
        uint64_t here = ends[lane] - first;
        bool own = lane == RGI_OWN;
        if (here && own && !build_chain(lattice, other + first, here, index << 4 | lane)) return false;
        if (here && !own && !build(lattice, other + first, entries + first, here, index << 4 | lane)) return false;
        first = ends[lane];
    }
    return true;
}

rg_result rgi_lattice_build(rgi_lattice *lattice, rgi_bound_source source, const void *context, uint64_t count) {
    rgi_entry *entries;
    uint64_t bounded = 0;
    if (count == 0) return RG_OK;
    rg_result result = rgi_allocate(lattice->memory, 2 * count, sizeof *entries, "building a grid", &entries);
    if (result) return result;
    rgi_lattice_choose_frame(lattice, source, context, count, NULL);
    for (uint64_t i = 0; i < count && !result; i++) {
        rgi_bound bound;
        uint32_t slot;
        source(context, i, &slot, &bound);
        lattice->boxes |= !bound.ball;
        if (rgi_entry_make(lattice, slot, &bound, &entries[bounded])) {
            rgi_bounds_unite(lattice->lo, lattice->hi, entries[bounded].lo, entries[bounded].hi);
            bounded++;
        } else {
            result = rgi_lattice_insert_unbounded(lattice, slot);
        }
    }
    lattice->arena.chunks.bulk = true;
    if (!result && bounded && !build(lattice, entries, entries + count, bounded, RGI_ROOT))
        result = rgi_fail(RG_OUT_OF_MEMORY, "no memory for a grid of %llu objects", (unsigned long long)count);
    lattice->arena.chunks.bulk = false;
    if (!result) lattice->count = bounded;
    rgi_release(lattice->memory, entries, 2 * count, sizeof *entries);
    return result;
}
