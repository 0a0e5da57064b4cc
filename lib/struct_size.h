/* SPDX-License-Identifier: MIT */
/* The size field that lets public structs grow at the end without breaking older or newer callers. */
#ifndef RAYGRID_LIB_STRUCT_SIZE_H
#define RAYGRID_LIB_STRUCT_SIZE_H

#include <raygrid/base.h>

/**
 * Copies a caller's struct, whose first field is its size, into `known` of `known_size` bytes, the first `least` of
 * which every version has. NULL gives all zeros. RG_INVALID_ARGUMENT: the size is smaller than `least`, absurd, or
 * larger than known and not zero beyond. `name` is the struct's in the message.
 */
rg_result rgi_struct_read(void *known, size_t known_size, size_t least, const void *given, const char *name);

/** The same without a copy where the caller's struct has just the fields that are known: *view is that, or `room`. */
rg_result rgi_struct_view(const void *given, void *room, size_t known_size, size_t least, const char *name,
                          const void **view);

/** Copies the first bytes of `known` to the caller's struct, as many as both have; its size field stays. */
rg_result rgi_struct_write(const void *known, size_t known_size, size_t least, void *given, const char *name);

/** Fills a config of the caller's with `known` and sets its size field to `size`; what is beyond gets zeros. */
rg_result rgi_struct_default(const void *known, size_t known_size, size_t least, void *given, size_t size,
                             const char *name);

#endif
