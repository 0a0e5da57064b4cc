/* SPDX-License-Identifier: MIT */
#include "peer.h"

#include "peer_build.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

static const int WIDTHS[] = {1, 4, 8, 16};

/* The peer asks its hosts to let the processor take denormals for zero. Only here: raygrid does not. */
static unsigned flush_denormals(void) {
#if defined(__SSE__)
    unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040);
    return before;
#else
    return 0;
#endif
}

static void restore_denormals(unsigned before) {
#if defined(__SSE__)
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

/* ------------------------------------------------------------------------------------------------- traces */

union word {
    float f;
    uint32_t u;
};

struct packet {
    union word row[ROWS * 16];
    int valid[16];
} __attribute__((aligned(64)));

/* What is the same in all packets of a set. */
static inline void start(struct packet *packet, uint32_t n) {
    memset(packet, 0, sizeof *packet);
    for (uint32_t i = 0; i < n; i++) {
        packet->row[ROW_MASK * n + i].u = UINT32_MAX;
        packet->valid[i] = -1;
    }
}

static inline void load(struct packet *packet, const struct bench_rays *rays, uint32_t from, uint32_t n,
                        uint32_t used) {
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < used; i++) {
            packet->row[(ROW_ORIGIN + k) * n + i].f = rays->origin[k][from + i];
            packet->row[(ROW_DIRECTION + k) * n + i].f = rays->direction[k][from + i];
        }
    }
    for (uint32_t i = 0; i < n; i++) packet->row[ROW_T_FAR * n + i].f = rays->t_max;
}

static inline void forget_hits(struct packet *packet, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        packet->row[ROW_GEOMETRY * n + i].u = RTC_INVALID_GEOMETRY_ID;
        packet->row[ROW_PRIMITIVE * n + i].u = RTC_INVALID_GEOMETRY_ID;
        packet->row[ROW_INSTANCE * n + i].u = RTC_INVALID_GEOMETRY_ID;
        packet->row[ROW_INSTANCE_PRIMITIVE * n + i].u = RTC_INVALID_GEOMETRY_ID;
    }
}

/* An id has the geometry above the primitive; of an instance its own geometry and number in an array. */
static inline void store_hits(const struct packet *packet, const struct bench_answers *answers, uint32_t from,
                              uint32_t n, uint32_t used, bool instances) {
    for (uint32_t i = 0; i < used; i++) {
        uint32_t geometry = packet->row[ROW_GEOMETRY * n + i].u, primitive = packet->row[ROW_PRIMITIVE * n + i].u;
        if (instances && packet->row[ROW_INSTANCE * n + i].u != RTC_INVALID_GEOMETRY_ID) {
            geometry = packet->row[ROW_INSTANCE * n + i].u;
            primitive = packet->row[ROW_INSTANCE_PRIMITIVE * n + i].u;
        }
        answers->t[from + i] = packet->row[ROW_T_FAR * n + i].f;
        answers->id[from + i] = (uint64_t)geometry << 32 | primitive;
    }
    for (uint32_t k = 0; answers->normal[0] && k < 3; k++) {
        for (uint32_t i = 0; i < used; i++) {
            answers->normal[k][from + i] = packet->row[(ROW_NORMAL + k) * n + i].f;
        }
    }
}

/* `width` is a number in each of its calls, so that the compiler unrolls the loops over n. */
static inline void trace_width(struct peer *peer, const struct bench_rays *rays, int width, bool coherent,
                               const struct bench_answers *answers) {
    uint32_t n = (uint32_t)WIDTHS[width];
    bool instances = peer->parts[PEER_INSTANCES].count > 0;
    struct embree_query query = embree_query_make(peer->api, coherent);
    struct packet packet;
    start(&packet, n);
    for (uint32_t from = 0; from < rays->count; from += n) {
        uint32_t used = rays->count - from < n ? rays->count - from : n;
        if (used == n) {
            load(&packet, rays, from, n, n);
        } else {
            load(&packet, rays, from, n, used);
            for (uint32_t i = used; i < n; i++) packet.valid[i] = 0;
        }
        if (rays->any) {
            embree_ask(peer->api, &query, true, width, packet.valid, peer->scene, &packet);
            for (uint32_t i = 0; i < used; i++) {
                answers->occluded[from + i] = packet.row[ROW_T_FAR * n + i].f < 0;
            }
        } else {
            forget_hits(&packet, n);
            embree_ask(peer->api, &query, false, width, packet.valid, peer->scene, &packet);
            store_hits(&packet, answers, from, n, used, instances);
        }
    }
}

void peer_trace(struct peer *peer, const struct bench_rays *rays, struct peer_way way,
                const struct bench_answers *answers) {
    unsigned before = flush_denormals();
    switch (way.width) {
    case 0:
        trace_width(peer, rays, 0, way.coherent, answers);
        break;
    case 1:
        trace_width(peer, rays, 1, way.coherent, answers);
        break;
    case 2:
        trace_width(peer, rays, 2, way.coherent, answers);
        break;
    default:
        trace_width(peer, rays, 3, way.coherent, answers);
    }
    restore_denormals(before);
}

struct peer_way peer_best_way(struct peer *peer, const struct bench_rays *rays, bool single,
                              const struct bench_answers *answers, double *seconds) {
    enum { TRIED = 8192, TIMES = 3 };
    struct peer_way best = {0, false};
    double least = DBL_MAX;
    struct bench_rays some = *rays;
    if (rays->count > TRIED) {
        uint32_t middle = (rays->count - TRIED) / 2 & ~63u; /* whole tiles of a picture */
        some.count = TRIED;
        for (int k = 0; k < 3; k++) {
            some.origin[k] += middle;
            some.direction[k] += middle;
        }
    }
    /* Embree 3.13.5 with AVX-512 does not come back from rtcOccluded16 where there are instances. */
    bool hangs = rays->any && peer->parts[PEER_INSTANCES].count > 0 && peer->api->version < 40000;
    int widths = single ? 1 : hangs ? 3 : 4;
    for (int width = 0; width < widths; width++) {
        for (int coherent = 0; coherent < 2; coherent++) {
            struct peer_way way = {width, coherent};
            for (int i = 0; i < TIMES; i++) {
                double before = bench_thread_seconds();
                peer_trace(peer, &some, way, answers);
                double now = bench_thread_seconds() - before;
                if (now < least) {
                    least = now;
                    best = way;
                }
            }
        }
    }
    if (seconds) *seconds = least;
    return best;
}

const char *peer_way_name(struct peer_way way) {
    static const char *const NAMES[4][2] = {
        {"1", "1 coherent"}, {"4", "4 coherent"}, {"8", "8 coherent"}, {"16", "16 coherent"}};
    return NAMES[way.width][way.coherent];
}

uint32_t peer_body(const struct peer *peer, uint64_t id) {
    uint32_t geometry = (uint32_t)(id >> 32), primitive = (uint32_t)id;
    if (geometry == RTC_INVALID_GEOMETRY_ID) return UINT32_MAX;
    for (int p = 0; p < PEER_PARTS; p++) {
        const struct peer_part *part = &peer->parts[p];
        bool one_by_one = p == PEER_INSTANCES && !in_array(peer);
        uint32_t at = one_by_one ? geometry - part->id : primitive / part->each;
        bool inside = one_by_one ? geometry >= part->id : geometry == part->id;
        if (part->count && inside && at < part->count) return part->bodies[at];
    }
    return UINT32_MAX;
}
