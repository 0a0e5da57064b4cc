/* SPDX-License-Identifier: MIT */
/*
 * What snapshots and recordings are made of: 64-bit words, little-endian, in records, with a checksum that runs from
 * the first word to the last. docs/recording.md is the format; this is its lowest layer.
 */
#ifndef RAYGRID_LIB_STREAM_H
#define RAYGRID_LIB_STREAM_H

#include <raygrid/record.h>

#include <stdbool.h>
#include <string.h>

/** What the bytes are. */
enum { RGI_SNAPSHOT = 1, RGI_RECORDING = 2 };

/** Kinds of records: below RGI_RECORD_GRID the calls, by their rg_call. The state comes in this order. */
enum {
    RGI_RECORD_GRID = 32,  /* a place for a grid */
    RGI_RECORD_SHAPE = 33, /* before a call, too: a shape that was not used before */
    RGI_RECORD_SLOTS = 34, /* objects and what is between them */
    RGI_RECORD_FREE = 35,  /* the list of free slots */
    RGI_RECORD_STATE = 36, /* counts of all that; the state ends */
    RGI_RECORD_END = 37    /* the recording ends */
};

/** Bytes of a word; words around those of a record: its head before, its checksum behind. */
enum { RGI_WORD = 8, RGI_RECORD_AROUND = 2 };

/** The number of words is in the upper 56 bits of a record's head. */
#define RGI_MOST_WORDS ((UINT64_C(1) << 56) - 1)

/** "raygrid" and the byte 0x1a, which is in no text, read as a word. */
#define RGI_MAGIC UINT64_C(0x1a64697267796172)

/**
 * The checksum takes in one word. For either argument fixed it is one-to-one in the other: so a single word that is
 * wrong is always noticed, and more than one but for a chance of 2^-64. The factor is 2^64 / golden ratio, odd.
 */
static inline uint64_t rgi_mix(uint64_t sum, uint64_t word) {
    sum = (sum ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    return sum ^ sum >> 32;
}

/** RG_INVALID_ARGUMENT on machines whose words are not those of the format. */
rg_result rgi_stream_check_machine(void);

/* -------------------------------------------------------------------------------------------------- writing */

typedef struct rgi_writer {
    rg_sink sink;
    uint64_t sum;
    uint64_t bytes; /* that the sink has taken */
    uint32_t fill;  /* bytes in the buffer */
    int32_t failed; /* what the sink returned when it failed; then nothing more is written */
    unsigned char buffer[4096];
} rgi_writer;

/** Reads a sink and begins with the head of a file of that kind. RG_INVALID_ARGUMENT. */
rg_result rgi_writer_begin(rgi_writer *writer, const rg_sink *sink, uint32_t what);

/** Hands on what is in the buffer. False if the sink has failed, now or before. */
bool rgi_writer_flush(rgi_writer *writer);

static inline void rgi_put_unsummed(rgi_writer *writer, uint64_t word) {
    if (writer->fill == sizeof writer->buffer) (void)rgi_writer_flush(writer);
    memcpy(writer->buffer + writer->fill, &word, sizeof word);
    writer->fill += RGI_WORD;
}

static inline void rgi_put(rgi_writer *writer, uint64_t word) {
    writer->sum = rgi_mix(writer->sum, word);
    rgi_put_unsummed(writer, word);
}

static inline void rgi_put_pair(rgi_writer *writer, uint32_t low, uint32_t high) {
    rgi_put(writer, low | (uint64_t)high << 32);
}

static inline void rgi_put_doubles(rgi_writer *writer, const double *values, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        uint64_t word;
        memcpy(&word, &values[i], sizeof word);
        rgi_put(writer, word);
    }
}

/** A record: its head, so many words put, its end. */
static inline void rgi_put_head(rgi_writer *writer, uint32_t kind, uint64_t words) {
    rgi_put(writer, kind | words << 8);
}

static inline void rgi_put_end(rgi_writer *writer) {
    rgi_put_unsummed(writer, writer->sum);
}

/* -------------------------------------------------------------------------------------------------- reading */

typedef struct rgi_reader {
    const unsigned char *bytes;
    uint64_t size, at;
    uint64_t sum;
    uint32_t version, what;
} rgi_reader;

typedef struct rgi_stream_record {
    const unsigned char *words;
    uint64_t count;  /* of words */
    uint64_t offset; /* of its head in the file */
    uint32_t kind;
} rgi_stream_record;

/** Checks the head of a file and begins to read. RG_INVALID_DATA. */
rg_result rgi_reader_begin(rgi_reader *reader, const void *bytes, uint64_t size);

/** Whether all has been read. */
static inline bool rgi_reader_done(const rgi_reader *reader) {
    return reader->at == reader->size;
}

/** Reads the next record and checks its checksum. RG_INVALID_DATA: the reader has not moved. */
rg_result rgi_reader_next(rgi_reader *reader, rgi_stream_record *record);

/** RG_INVALID_DATA unless the record has so many words. */
rg_result rgi_stream_demand(const rgi_stream_record *record, uint64_t count);

/** RG_INVALID_DATA in place of a failure to make what the record asks for; "byte ...: " in front of the message. What
 * is not the data's fault (memory, threads, callbacks, a scene in use) stays as it is. */
rg_result rgi_stream_blame(const rgi_stream_record *record, rg_result result);

static inline uint64_t rgi_word(const rgi_stream_record *record, uint64_t i) {
    uint64_t word;
    memcpy(&word, record->words + i * RGI_WORD, sizeof word);
    return word;
}

static inline void rgi_get_doubles(const rgi_stream_record *record, uint64_t i, double *values, uint32_t count) {
    memcpy(values, record->words + i * RGI_WORD, count * sizeof *values);
}

#endif
