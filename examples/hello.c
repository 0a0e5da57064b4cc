/* SPDX-License-Identifier: MIT */
#include <raygrid/raygrid.h>
#include <stdio.h>

int main(void) {
    rg_scene *scene;
    rg_shape *ball;
    rg_object object;
    rg_pose pose = rg_pose_at(0, 0, 5);
    rg_ray ray = rg_ray_from((double[3]){0, 0, 0}, (double[3]){0, 0, 1});
    rg_hit hit;

    rg_scene_create(NULL, &scene);
    rg_shape_create_sphere(NULL, 1.0, &ball);
    rg_scene_insert(scene, ball, &pose, &object);
    rg_scene_trace(scene, &ray, &hit, 1);
    printf("inserted: %g\n", hit.t);
    rg_scene_move_to(scene, object, (double[3]){0, 0, 9});
    rg_scene_trace(scene, &ray, &hit, 1);
    printf("moved: %g\n", hit.t);
    rg_scene_remove(scene, object);
    rg_scene_trace(scene, &ray, &hit, 1);
    printf("removed: %g\n", hit.t);
    rg_shape_release(&ball);
    rg_scene_destroy(&scene);
    return 0;
}
