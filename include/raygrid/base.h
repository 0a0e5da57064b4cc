/* SPDX-License-Identifier: MIT */
/*
 * raygrid/base.h: version, result codes, hooks of the host, and views of the host's memory.
 *
 * Conventions of all raygrid headers:
 *   - Coordinates are right-handed or left-handed as the host likes; raygrid never asks. One length unit, the
 *     host's. Matrices act on column vectors and are stored by rows.
 *   - "World" is the frame of the scene, "local" the frame of a shape. A pose takes local points to the world.
 *   - Every call that can fail returns an rg_result. On failure nothing has changed and no output was written,
 *     unless the function says otherwise; rg_error_message() then names the value that was wrong.
 *   - Structs that start with a `size` field are filled by their default function, or zeroed by hand and given
 *     their size: in every such struct the value 0 means "the default". They only ever grow at the end. A struct
 *     that is larger than this library knows is accepted as long as all bytes beyond what it knows are zero.
 *     Structs without a size (rg_allocator, views of fields, rg_pose, rg_ray, rg_hit, and what callbacks see) never
 *     change within a major version.
 *   - Nothing here needs alignment beyond that of the C types.
 *   - The library has no global state, makes no threads but the workers of a scene and those that are asked to help
 *     with a mesh (rg_shape_config.workers), installs no handlers, reads no environment variables, never prints and
 *     never ends the process.
 */
#ifndef RAYGRID_BASE_H
#define RAYGRID_BASE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define RG_API __attribute__((visibility("default")))
#else
#define RG_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define RG_VERSION_MAJOR 0
#define RG_VERSION_MINOR 1
#define RG_VERSION_PATCH 0

/** The version of the library that is running, as major * 1000000 + minor * 1000 + patch. Any thread. */
RG_API uint32_t rg_version(void);

/* ------------------------------------------------------------------------------------------------ results */

/** What became of a call. 0 is success; all others are failures. */
typedef int32_t rg_result;

enum {
    RG_OK = 0,
    /** A pointer is NULL that must not be, a struct's size or an enumeration value is unknown. */
    RG_INVALID_ARGUMENT = 1,
    /** A number is NaN, infinite, out of its range; a pose is singular; a mesh index has no vertex. */
    RG_INVALID_VALUE = 2,
    /** The id of an object or grid is stale, of another scene, or was never given out. */
    RG_INVALID_ID = 3,
    /** A count is beyond what the library can address. */
    RG_LIMIT_EXCEEDED = 4,
    /** The allocator returned NULL. */
    RG_OUT_OF_MEMORY = 5,
    /** The system refused to start a worker thread. */
    RG_OUT_OF_THREADS = 6,
    /** The call would change a scene from inside a callback of that scene, or remove what is still in use. */
    RG_BUSY = 7,
    /** A callback of the host reported failure or returned NaN. */
    RG_CALLBACK_FAILED = 8,
    /** A snapshot or recording is damaged, of another version, or not what the call takes. */
    RG_INVALID_DATA = 9
};

/** The name of a result code, such as "RG_INVALID_VALUE"; "unknown" for a number that is none. Any thread. */
RG_API const char *rg_result_name(rg_result result);

/**
 * What was wrong with the last call of this thread that failed: a sentence that names the offending value, or ""
 * if none failed yet. The text belongs to the thread and holds until its next failing call. Successful calls leave
 * it.
 */
RG_API const char *rg_error_message(void);

/* ------------------------------------------------------------------------------------- hooks of the host */

/**
 * Where memory comes from. Both functions are called from any thread that calls into the library, and from its
 * workers. Leave both NULL for malloc and free.
 *   allocate: `size` > 0 bytes aligned to `alignment`, a power of two <= 64; NULL if there are none.
 *   release:  gets back what allocate returned, with the same size and alignment. Never called with NULL.
 */
typedef struct rg_allocator {
    void *user;
    void *(*allocate)(void *user, size_t size, size_t alignment);
    void (*release)(void *user, void *memory, size_t size, size_t alignment);
} rg_allocator;

/**
 * The host's own job system: call body(context, i) once for each i in [0, count), on any threads in any order, and
 * return when all calls have returned. Calls of body never fail and never wait for one another.
 */
typedef void (*rg_parallel_for)(void *user, uint64_t count, void (*body)(void *context, uint64_t index),
                                void *context);

/** Receives one line of text, without a line end, when something happens that a developer may want to know. */
typedef void (*rg_log)(void *user, const char *message);

/* -------------------------------------------------------------------------------- views of host memory */

/** The type of the numbers that a view reads or writes. */
typedef int32_t rg_type;

enum { RG_F64 = 0, RG_F32 = 1, RG_U8 = 2, RG_U16 = 3, RG_U32 = 4, RG_U64 = 5 };

/*
 * A view says where the field of record i lies: at `data + i * stride` bytes. Strides may be negative, or 0 to give
 * all records the same value. `data` NULL means: not given, or not wanted. Three-component views have a pointer for
 * each component, so that {x,y,z} records, three separate arrays, and any NumPy layout are used where they lie.
 * A NULL x means the view is not given; then y and z are ignored. The memory stays the host's and is only touched
 * during the call, unless the host lends it for longer (rg_mesh_views.released).
 */

/** One number a record, read. */
typedef struct rg_input {
    const void *data;
    ptrdiff_t stride; /* bytes */
    rg_type type;
} rg_input;

/** Three numbers a record, read. */
typedef struct rg_input3 {
    const void *x, *y, *z;
    ptrdiff_t stride; /* bytes, the same for the three */
    rg_type type;
} rg_input3;

/** One number a record, written. */
typedef struct rg_output {
    void *data;
    ptrdiff_t stride; /* bytes */
    rg_type type;
} rg_output;

/** Three numbers a record, written. */
typedef struct rg_output3 {
    void *x, *y, *z;
    ptrdiff_t stride; /* bytes, the same for the three */
    rg_type type;
} rg_output3;

/** A view of records that hold x, y, z one after another, the first at `xyz`, each `stride` bytes after the last. */
RG_API rg_input3 rg_input3_packed(const void *xyz, ptrdiff_t stride, rg_type type);

/** The same for writing. */
RG_API rg_output3 rg_output3_packed(void *xyz, ptrdiff_t stride, rg_type type);

#ifdef __cplusplus
}
#endif
#endif
