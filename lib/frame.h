/* SPDX-License-Identifier: MIT */
/*
 * Frames: scenes that follow another one, to the instant of their last update. The leader notes which of its slots
 * have changed since, each once; an update takes over what those slots hold now. Both copies of an object have the
 * same slot, generation and shape.
 */
#ifndef RAYGRID_LIB_FRAME_H
#define RAYGRID_LIB_FRAME_H

#include "scene.h"

/** What a frame has to catch up with. Belongs to the frame; changed under the leader's lock. */
typedef struct rgi_follower {
    struct rgi_follower *next; /* of the same leader */
    rg_scene *leader;
    rgi_memory *memory;
    uint32_t *changed; /* slots */
    uint64_t count, room;
    uint8_t *marks; /* a bit for each slot that is in the list */
    uint64_t marks_room;
    bool all;   /* every slot may have changed: there was no memory to note them */
    bool grids; /* so have the grids */
    pthread_mutex_t updating;
} rgi_follower;

/** Notes a change in all followers. With the scene held for it. */
void rgi_followers_note(rg_scene *scene, uint32_t slot);
void rgi_followers_note_grids(rg_scene *scene);

static inline void rgi_scene_changed(rg_scene *scene, uint32_t slot) {
    if (scene->followers) rgi_followers_note(scene, slot);
}

/** Before a frame is freed: its leader forgets it. */
void rgi_follower_end(rg_scene *frame);

#endif
