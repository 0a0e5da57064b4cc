/* SPDX-License-Identifier: MIT */
#include "crowd.h"

#include "beam.h"

#include <stddef.h>
#include <string.h>

const crowd crowds[CROWDS] = {
    {"balls", 0, 100, 0, 0.3, 1},
    {"boxes", 0, 100, 0, 0.3, 0},
    {"mixed", 0, 100, 0, 0.3, 0.5},
    {"dense", 0, 3, -0.5, 0.5, 0.5},
    {"twelve decades", 0, 1000, -6, 6, 0.5},
    {"twelve decades of balls", 0, 1000, -6, 6, 1},
    {"far away", 1e9, 100, -1, 1, 1},
    {"very far away", 1e12, 1, -3, -2, 0.8}, /* farther apart than doubles are, just so */
    {"tiny", 0, 1e-30, -33, -31, 1},
    {"huge", 1e90, 1e89, 86, 88, 0.5},
};

crowd_store store;

static void *allocate(void *user, size_t size, size_t alignment) {
    void *block = NULL;
    (void)user;
    if (store.blocks_left == 0) return NULL;
    store.blocks_left -= store.blocks_left > 0;
    return posix_memalign(&block, alignment < sizeof block ? sizeof block : alignment, size) == 0 ? block : NULL;
}

static void release(void *user, void *block, size_t size, size_t alignment) {
    (void)user, (void)size, (void)alignment;
    free(block);
}

void crowd_begin(void) {
    const rg_allocator scarce = {NULL, allocate, release};
    store.blocks_left = -1;
    ck_assert_int_eq(rgi_memory_init(&store.memory, &scarce), RG_OK);
    rgi_slots_init(&store.records, &store.memory, sizeof(rgi_object), "objects of a test");
    rgi_lattice_init(&store.lattice, &store.memory, &store.records, offsetof(rgi_object, place), NULL,
                     rgi_kernels_best());
    ck_assert_int_eq(rgi_slots_reserve(&store.records, CROWD_MOST), RG_OK);
    for (uint32_t i = 0; i < CROWD_MOST; i++) MUST(rgi_slots_take(&store.records) == i);
    memset(store.stored, 0, sizeof store.stored);
}

void crowd_end(void) {
    rgi_lattice_free(&store.lattice);
    rgi_slots_free(&store.records);
    ck_assert_uint_eq(store.memory.bytes, 0);
}

const rgi_location *crowd_place(uint32_t slot) {
    return &((const rgi_object *)rgi_slots_at(&store.records, slot))->place;
}

void crowd_insert(uint32_t slot, const rgi_bound *bound) {
    rgi_object *object = rgi_slots_at(&store.records, slot);
    for (int a = 0; a < 3; a++) object->position[a] = bound->centre[a];
    object->reach = bound->radius;
    store.truth[slot] = *bound;
    store.stored[slot] = true;
    MUST(rgi_lattice_insert(&store.lattice, slot, bound) == RG_OK);
}

static void bound_of(const void *context, uint64_t i, uint32_t *slot, rgi_bound *bound) {
    *slot = ((const uint32_t *)context)[i];
    *bound = store.truth[*slot];
}

rg_result crowd_build(const uint32_t *slots, uint64_t count) {
    rg_result result = rgi_lattice_build(&store.lattice, bound_of, slots, count);
    for (uint64_t i = 0; i < count; i++) store.stored[slots[i]] = !result;
    return result;
}

rgi_bound ball_at(double x, double y, double z, double radius) {
    rgi_bound b = {.ball = true, .centre = {x, y, z}, .radius = radius};
    for (int a = 0; a < 3; a++) b.lo[a] = b.centre[a] - radius, b.hi[a] = b.centre[a] + radius;
    return b;
}

rgi_bound box_at(double x, double y, double z, double size) {
    rgi_bound b = {.centre = {x, y, z}};
    for (int a = 0; a < 3; a++) {
        b.lo[a] = b.centre[a] - size * unit_random();
        b.hi[a] = b.centre[a] + size * unit_random();
    }
    return b;
}

rgi_bound crowd_bound(const crowd *c) {
    double at[3], size = pow(10, c->size_from + (c->size_to - c->size_from) * unit_random());
    for (int a = 0; a < 3; a++) at[a] = c->centre * (a == 1 ? -0.7 : 1) + c->spread * (2 * unit_random() - 1);
    return unit_random() < c->balls ? ball_at(at[0], at[1], at[2], size) : box_at(at[0], at[1], at[2], size);
}

rgi_bound shifted(const rgi_bound *from, double by) {
    rgi_bound b = *from;
    for (int a = 0; a < 3; a++) {
        double shift = by * (2 * unit_random() - 1);
        b.centre[a] += shift;
        b.lo[a] = b.ball ? b.centre[a] - b.radius : b.lo[a] + shift;
        b.hi[a] = b.ball ? b.centre[a] + b.radius : b.hi[a] + shift;
    }
    return b;
}
