/* SPDX-License-Identifier: MIT */
/*
 * The records of a scene's state, which snapshots and recordings begin with; and what the records of calls have in
 * common with them: shapes, poses, configurations of grids.
 */
#ifndef RAYGRID_LIB_SNAPSHOT_H
#define RAYGRID_LIB_SNAPSHOT_H

#include "scene.h"
#include "shape_numbers.h"
#include "stream.h"

/* ---------------------------------------------------------------------------------------------------- parts */

/** What there is to a pose besides its position, and to a slot besides its generation. */
enum { RGI_HAS_LINEAR = 1, RGI_HAS_SCALE = 2, RGI_IS_LIVE = 4, RGI_SLOT_FLAGS = 7 };

/** Words: of a position, of a linear part (nine floats and four bytes of zeros), of a scale; of a grid's
 * configuration. */
enum { RGI_POSITION_WORDS = 3, RGI_LINEAR_WORDS = 5, RGI_SCALE_WORDS = 1, RGI_CONFIG_WORDS = 8 };

/** The bits of RGI_HAS_LINEAR and RGI_HAS_SCALE without which the pose would not be the same to the last bit. */
uint32_t rgi_pose_flags(const float linear[9], double scale);

static inline uint64_t rgi_pose_words(uint64_t flags) {
    return RGI_POSITION_WORDS + (flags & RGI_HAS_LINEAR ? RGI_LINEAR_WORDS : 0) +
           (flags & RGI_HAS_SCALE ? RGI_SCALE_WORDS : 0);
}

void rgi_put_pose(rgi_writer *writer, uint32_t flags, const double position[3], const float linear[9], double scale);

/** Reads what rgi_put_pose has put, from word i on. */
void rgi_get_pose(const rgi_stream_record *record, uint64_t i, uint64_t flags, rg_pose *pose);

void rgi_put_config(rgi_writer *writer, const rg_grid_config *config);

/** Reads a configuration and checks it. RG_INVALID_DATA. */
rg_result rgi_get_config(const rgi_stream_record *record, uint64_t i, rg_grid_config *config);

/**
 * The number of a shape; a shape that has none gets one, and its record is written. `memory` for what that takes.
 * RG_OUT_OF_MEMORY, RG_INVALID_ARGUMENT (a user-defined shape without a number): nothing was written.
 */
rg_result rgi_write_shape(rgi_writer *writer, rgi_shape_numbers *numbers, rg_shape *shape, uint32_t *number);

/* --------------------------------------------------------------------------------------------------- saving */

/** Writes the state of a scene that is held. `numbers`: empty; has its shapes afterwards. */
rg_result rgi_snapshot_write(const rg_scene *scene, rgi_writer *writer, rgi_shape_numbers *numbers);

/* -------------------------------------------------------------------------------------------------- loading */

/** A file that is being read, and what came of it. */
typedef struct rgi_loader {
    rgi_memory memory;
    rgi_reader reader;
    rg_source source;
    rg_scene *scene;
    rg_shape **shapes; /* by their numbers; each a reference */
    uint64_t shape_count, shape_room;
} rgi_loader;

/**
 * Reads a source's state into a new scene, loader->scene. Whatever comes out, rgi_loader_free follows; on failure
 * there is no scene. Errors: as rg_scene_load.
 */
rg_result rgi_snapshot_read(rgi_loader *loader, const rg_scene_config *config, const rg_source *source);

/** RG_INVALID_DATA unless what was read is a snapshot, which is its state and nothing behind it. */
rg_result rgi_snapshot_end(const rgi_loader *loader);

/** Gives the shapes back, not the scene. */
void rgi_loader_free(rgi_loader *loader);

/** Makes the next shape of a record. */
rg_result rgi_read_shape(rgi_loader *loader, const rgi_stream_record *record);

/** The shape of a number. RG_INVALID_DATA. */
rg_result rgi_find_shape(const rgi_loader *loader, const rgi_stream_record *record, uint32_t number,
                         rg_shape **shape);

#endif
