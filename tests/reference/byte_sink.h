/* SPDX-License-Identifier: MIT */
/* byte_sink.h: memory that snapshots and recordings are written to, and read from again. */
#ifndef RAYGRID_TESTS_BYTE_SINK_H
#define RAYGRID_TESTS_BYTE_SINK_H

#include <raygrid/raygrid.h>
#include <stdlib.h>
#include <string.h>

typedef struct byte_sink {
    unsigned char *bytes;
    size_t size, room;
    size_t most; /* fails when there would be more; 0: never */
    uint64_t calls;
} byte_sink;

static inline int32_t byte_sink_write(void *user, const void *bytes, size_t size) {
    byte_sink *sink = (byte_sink *)user;
    sink->calls++;
    if (sink->most && sink->size + size > sink->most) return 7;
    if (sink->size + size > sink->room) {
        sink->room = 2 * (sink->size + size);
        sink->bytes = (unsigned char *)realloc(sink->bytes, sink->room);
        if (!sink->bytes) abort();
    }
    memcpy(sink->bytes + sink->size, bytes, size);
    sink->size += size;
    return 0;
}

static inline void byte_sink_free(byte_sink *sink) {
    free(sink->bytes);
    memset(sink, 0, sizeof *sink);
}

/** A sink and a source for the library; callbacks for user-defined shapes are given by who has some, and get the
 *  byte_sink as their user. */
static inline rg_sink byte_sink_sink(byte_sink *sink) {
    rg_sink s;
    memset(&s, 0, sizeof s);
    s.size = sizeof s;
    s.user = sink;
    s.write = byte_sink_write;
    return s;
}

static inline rg_source byte_sink_source(const byte_sink *sink) {
    rg_source s;
    memset(&s, 0, sizeof s);
    s.size = sizeof s;
    s.bytes = sink->bytes;
    s.byte_count = sink->size;
    return s;
}

/** Whether two hold the same bytes. */
static inline int byte_sink_equal(const byte_sink *a, const byte_sink *b) {
    return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

#endif
