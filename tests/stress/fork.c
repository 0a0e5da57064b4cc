/* SPDX-License-Identifier: MIT */
/*
 * fork: the child of a process that has a scene traces, changes and destroys its own copy, without the parent's
 * workers; the parent goes on with its scene as if nothing had been. While nobody is at work on the scene; also with
 * a rebuild under way, which the child's changes end.
 */
#define _POSIX_C_SOURCE 200809L
#include "field.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Everything that a scene is for, and its end. */
static void live_on(struct field *field) {
    field_check(field);
    field_move(field, 70);
    field_check(field);
    for (int i = 0; i < FIELD; i += 2) MUST(rg_scene_remove(field->scene, field->objects[i]));
    for (int i = 0; i < FIELD; i += 2) MUST(rg_scene_insert(field->scene, field->ball, NULL, &field->objects[i]));
    field_move(field, 10);
    field_check(field);
    field_move_until_rebuilding(field);
    field_check(field);
    for (int turn = 0; turn < 100 && report_grid(field->scene).rebuilding; turn++) field_move(field, turn);
    demand(!report_grid(field->scene).rebuilding, "the rebuild comes to its end");
    field_check(field);
    MUST(rg_grid_rebuild(field->scene, RG_GRID_OF_SCENE));
    field_check(field);
    field_end(field);
}

static void fork_and_go_on(struct field *field, const char *what) {
    int status = 0;
    fflush(NULL);
    pid_t child = fork();
    demand(child >= 0, "fork");
    if (child == 0) {
        live_on(field);
        _exit(EXIT_SUCCESS);
    }
    field_check(field);
    demand(waitpid(child, &status, 0) == child, "waitpid");
    demand(WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS, what);
    field_check(field);
}

/* Until the grid is quiet: then no worker is inside the scene. */
static void come_to_rest(const struct field *field) {
    const struct timespec briefly = {0, 1000000};
    while (report_grid(field->scene).rebuilding) nanosleep(&briefly, NULL);
}

int main(void) {
    static struct field field;
    for (int k = 0; k < 3; k++) {
        for (uint32_t workers = 1; workers <= 2; workers++) {
            field_begin(&field, KINDS[k], workers);
            if (workers > 1) come_to_rest(&field);
            fork_and_go_on(&field, "the child lives on with its copy");
            if (workers == 1) {
                field_move_until_rebuilding(&field);
                fork_and_go_on(&field, "the child lives on with its copy, and ends the rebuild");
            }
            live_on(&field);
        }
    }
    return EXIT_SUCCESS;
}
