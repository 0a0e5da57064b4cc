/* SPDX-License-Identifier: MIT */
#include "stream.h"

#include "error.h"
#include "struct_size.h"

#include <inttypes.h>

enum { SINK_LEAST = sizeof(rg_sink), HEAD_WORDS = 2 };

rg_result rgi_stream_check_machine(void) {
    const uint64_t one = 1;
    unsigned char first;
    memcpy(&first, &one, sizeof first);
    if (first == 1 && sizeof(double) == RGI_WORD) return RG_OK;
    return rgi_fail(RG_INVALID_ARGUMENT, "snapshots and recordings are little-endian, this machine is not");
}

/* -------------------------------------------------------------------------------------------------- writing */

rg_result rgi_writer_begin(rgi_writer *w, const rg_sink *sink, uint32_t what) {
    if (!sink) return rgi_fail(RG_INVALID_ARGUMENT, "sink is NULL");
    rg_result result = rgi_struct_read(&w->sink, sizeof w->sink, SINK_LEAST, sink, "rg_sink");
    if (!result && !w->sink.write) result = rgi_fail(RG_INVALID_ARGUMENT, "rg_sink.write is NULL");
    if (!result) result = rgi_stream_check_machine();
    if (result) return result;
    w->sum = w->bytes = 0;
    w->fill = 0;
    w->failed = 0;
    rgi_put(w, RGI_MAGIC);
    rgi_put_pair(w, RG_FORMAT_VERSION, what);
    return RG_OK;
}

bool rgi_writer_flush(rgi_writer *w) {
    if (!w->failed && w->fill) w->failed = w->sink.write(w->sink.user, w->buffer, w->fill);
    if (!w->failed) w->bytes += w->fill;
    w->fill = 0;
    return !w->failed;
}

/* -------------------------------------------------------------------------------------------------- reading */

static uint64_t next_word(rgi_reader *r) {
    uint64_t word;
    memcpy(&word, r->bytes + r->at, sizeof word);
    r->at += RGI_WORD;
    return word;
}

static uint64_t next_summed(rgi_reader *r) {
    uint64_t word = next_word(r);
    r->sum = rgi_mix(r->sum, word);
    return word;
}

rg_result rgi_reader_begin(rgi_reader *r, const void *bytes, uint64_t size) {
    *r = (rgi_reader){bytes, size, 0, 0, 0, 0};
    if (size < HEAD_WORDS * RGI_WORD)
        return rgi_fail(RG_INVALID_DATA, "%" PRIu64 " bytes are no snapshot and no recording", size);
    if (next_summed(r) != RGI_MAGIC)
        return rgi_fail(RG_INVALID_DATA, "byte 0: this is no snapshot and no recording of raygrid");
    uint64_t word = next_summed(r);
    r->version = (uint32_t)word;
    r->what = (uint32_t)(word >> 32);
    if (r->version < 1 || r->version > RG_FORMAT_VERSION)
        return rgi_fail(RG_INVALID_DATA, "byte 8: the format is of version %" PRIu32 ", this library reads 1 to %d",
                        r->version, RG_FORMAT_VERSION);
    if (r->what != RGI_SNAPSHOT && r->what != RGI_RECORDING)
        return rgi_fail(RG_INVALID_DATA, "byte 12: kind %" PRIu32 " is neither a snapshot nor a recording", r->what);
    return RG_OK;
}

rg_result rgi_reader_next(rgi_reader *r, rgi_stream_record *record) {
    rgi_reader next = *r;
    uint64_t left = (r->size - r->at) / RGI_WORD;
    record->offset = r->at;
    if (left < RGI_RECORD_AROUND)
        return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": the bytes end here, without an end", r->at);
    uint64_t head = next_summed(&next);
    record->kind = head & 0xFF;
    record->count = head >> 8;
    record->words = next.bytes + next.at;
    if (record->count > left - RGI_RECORD_AROUND)
        return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": the bytes end within a record of %" PRIu64 " words",
                        r->at, record->count);
    for (uint64_t i = 0; i < record->count; i++) (void)next_summed(&next);
    if (next_word(&next) != next.sum)
        return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": the checksum of this record is another", r->at);
    *r = next;
    return RG_OK;
}

rg_result rgi_stream_demand(const rgi_stream_record *record, uint64_t count) {
    if (record->count == count) return RG_OK;
    return rgi_fail(RG_INVALID_DATA,
                    "byte %" PRIu64 ": a record of kind %" PRIu32 " has %" PRIu64 " words, not %" PRIu64,
                    record->offset, record->kind, record->count, count);
}

rg_result rgi_stream_blame(const rgi_stream_record *record, rg_result result) {
    if (result == RG_OK || result == RG_OUT_OF_MEMORY || result == RG_OUT_OF_THREADS || result == RG_BUSY ||
        result == RG_CALLBACK_FAILED || result == RG_INVALID_DATA)
        return result;
    rgi_fail_prefix("byte %" PRIu64 ": ", record->offset);
    return RG_INVALID_DATA;
}
