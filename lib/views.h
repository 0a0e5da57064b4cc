/* SPDX-License-Identifier: MIT */
/* Reading and writing the host's memory through views. Records may lie at any address: hence memcpy. */
#ifndef RAYGRID_LIB_VIEWS_H
#define RAYGRID_LIB_VIEWS_H

#include <raygrid/base.h>

#include <stdbool.h>
#include <string.h>

/** Types that a view may have, as bits (1 << type). */
enum {
    RGI_FLOATS = 1 << RG_F64 | 1 << RG_F32,
    RGI_INDICES = 1 << RG_U16 | 1 << RG_U32 | 1 << RG_U64,
    RGI_U32 = 1 << RG_U32,
    RGI_U64 = 1 << RG_U64,
    RGI_U8 = 1 << RG_U8
};

/** The refusal of a view that is missing, or else of its type. */
rg_result rgi_refuse_view(const void *data, rg_type type, const char *name);

/** RG_INVALID_ARGUMENT if a view that is given has a type not in `types`, or a required one is missing. */
static inline rg_result rgi_check_view(const void *data, rg_type type, unsigned types, int required,
                                       const char *name) {
    bool right = data ? (unsigned)type <= RG_U64 && types >> type & 1 : !required;
    return right ? RG_OK : rgi_refuse_view(data, type, name);
}
rg_result rgi_check_view3(const void *x, const void *y, const void *z, rg_type type, unsigned types, int required,
                          const char *name);

static inline double rgi_read_float(const char *at, rg_type type) {
    if (type == RG_F32) {
        float f;
        memcpy(&f, at, sizeof f);
        return f;
    }
    double d;
    memcpy(&d, at, sizeof d);
    return d;
}

static inline uint64_t rgi_read_integer(const char *at, rg_type type) {
    uint64_t u64;
    uint32_t u32;
    uint16_t u16;
    switch (type) {
    case RG_U16:
        memcpy(&u16, at, sizeof u16);
        return u16;
    case RG_U32:
        memcpy(&u32, at, sizeof u32);
        return u32;
    case RG_U64:
        memcpy(&u64, at, sizeof u64);
        return u64;
    default:
        return (unsigned char)*at;
    }
}

static inline void rgi_write_float(char *at, rg_type type, double value) {
    if (type == RG_F32) {
        float f = (float)value;
        memcpy(at, &f, sizeof f);
    } else {
        memcpy(at, &value, sizeof value);
    }
}

static inline void rgi_write_integer(char *at, rg_type type, uint64_t value) {
    if (type == RG_U64) {
        memcpy(at, &value, sizeof value);
    } else if (type == RG_U32) {
        uint32_t u32 = (uint32_t)value;
        memcpy(at, &u32, sizeof u32);
    } else {
        *(unsigned char *)at = (unsigned char)value;
    }
}

static inline const char *rgi_record(const void *data, ptrdiff_t stride, uint64_t i) {
    return (const char *)data + stride * (ptrdiff_t)i;
}

static inline char *rgi_record_out(void *data, ptrdiff_t stride, uint64_t i) {
    return (char *)data + stride * (ptrdiff_t)i;
}

static inline double rgi_load(const rg_input *view, uint64_t i, double missing) {
    return view->data ? rgi_read_float(rgi_record(view->data, view->stride, i), view->type) : missing;
}

static inline uint64_t rgi_load_integer(const rg_input *view, uint64_t i, uint64_t missing) {
    return view->data ? rgi_read_integer(rgi_record(view->data, view->stride, i), view->type) : missing;
}

static inline void rgi_load3(const rg_input3 *view, uint64_t i, double out[3]) {
    out[0] = rgi_read_float(rgi_record(view->x, view->stride, i), view->type);
    out[1] = rgi_read_float(rgi_record(view->y, view->stride, i), view->type);
    out[2] = rgi_read_float(rgi_record(view->z, view->stride, i), view->type);
}

/** Three columns, rounded to float, as a matrix by rows. */
static inline void rgi_load_columns(const rg_input3 columns[3], uint64_t i, float matrix[9]) {
    double column[3];
    for (int j = 0; j < 3; j++) {
        rgi_load3(&columns[j], i, column);
        for (int r = 0; r < 3; r++) matrix[3 * r + j] = (float)column[r];
    }
}

static inline void rgi_load3_integer(const rg_input3 *view, uint64_t i, uint64_t out[3]) {
    out[0] = rgi_read_integer(rgi_record(view->x, view->stride, i), view->type);
    out[1] = rgi_read_integer(rgi_record(view->y, view->stride, i), view->type);
    out[2] = rgi_read_integer(rgi_record(view->z, view->stride, i), view->type);
}

static inline void rgi_store(const rg_output *view, uint64_t i, double value) {
    if (view->data) rgi_write_float(rgi_record_out(view->data, view->stride, i), view->type, value);
}

static inline void rgi_store_integer(const rg_output *view, uint64_t i, uint64_t value) {
    if (view->data) rgi_write_integer(rgi_record_out(view->data, view->stride, i), view->type, value);
}

static inline void rgi_store3(const rg_output3 *view, uint64_t i, double x, double y, double z) {
    if (!view->x) return;
    rgi_write_float(rgi_record_out(view->x, view->stride, i), view->type, x);
    rgi_write_float(rgi_record_out(view->y, view->stride, i), view->type, y);
    rgi_write_float(rgi_record_out(view->z, view->stride, i), view->type, z);
}

#endif
