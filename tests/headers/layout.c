/* SPDX-License-Identifier: MIT */
/*
 * The layout of the public structs where pointers and size_t have 8 bytes, written down: an entry that fails
 * is a change of the ABI. Adding a field at the end of a struct that starts with `size` needs a line here; any other
 * change needs a new soversion. test_headers.py checks that no field is missing.
 */
#include <raygrid/raygrid.h>

#define SIZE(type, bytes) typedef char type##_has_another_size[sizeof(type) == (bytes) ? 1 : -1]
#define FIELD(type, field, at) typedef char type##_##field##_has_moved[offsetof(type, field) == (at) ? 1 : -1]

#if UINTPTR_MAX == 0xFFFFFFFFFFFFFFFF

/* base.h */

SIZE(rg_allocator, 24);
FIELD(rg_allocator, user, 0);
FIELD(rg_allocator, allocate, 8);
FIELD(rg_allocator, release, 16);

SIZE(rg_input, 24);
FIELD(rg_input, data, 0);
FIELD(rg_input, stride, 8);
FIELD(rg_input, type, 16);

SIZE(rg_input3, 40);
FIELD(rg_input3, x, 0);
FIELD(rg_input3, y, 8);
FIELD(rg_input3, z, 16);
FIELD(rg_input3, stride, 24);
FIELD(rg_input3, type, 32);

SIZE(rg_output, 24);
FIELD(rg_output, data, 0);
FIELD(rg_output, stride, 8);
FIELD(rg_output, type, 16);

SIZE(rg_output3, 40);
FIELD(rg_output3, x, 0);
FIELD(rg_output3, y, 8);
FIELD(rg_output3, z, 16);
FIELD(rg_output3, stride, 24);
FIELD(rg_output3, type, 32);

/* shape.h */

SIZE(rg_shape_config, 56);
FIELD(rg_shape_config, size, 0);
FIELD(rg_shape_config, allocator, 8);
FIELD(rg_shape_config, quality, 32);
FIELD(rg_shape_config, workers, 36);
FIELD(rg_shape_config, parallel_for, 40);
FIELD(rg_shape_config, parallel_for_user, 48);

SIZE(rg_mesh_views, 120);
FIELD(rg_mesh_views, size, 0);
FIELD(rg_mesh_views, vertices, 8);
FIELD(rg_mesh_views, vertex_count, 48);
FIELD(rg_mesh_views, indices, 56);
FIELD(rg_mesh_views, triangle_count, 96);
FIELD(rg_mesh_views, released, 104);
FIELD(rg_mesh_views, user, 112);

SIZE(rg_local_ray, 64);
FIELD(rg_local_ray, origin, 0);
FIELD(rg_local_ray, direction, 24);
FIELD(rg_local_ray, t_min, 48);
FIELD(rg_local_ray, t_max, 56);

SIZE(rg_local_hit, 56);
FIELD(rg_local_hit, t, 0);
FIELD(rg_local_hit, normal, 8);
FIELD(rg_local_hit, u, 32);
FIELD(rg_local_hit, v, 40);
FIELD(rg_local_hit, primitive, 48);

SIZE(rg_user_shape, 88);
FIELD(rg_user_shape, size, 0);
FIELD(rg_user_shape, user, 8);
FIELD(rg_user_shape, lo, 16);
FIELD(rg_user_shape, hi, 40);
FIELD(rg_user_shape, intersect, 64);
FIELD(rg_user_shape, occluded, 72);
FIELD(rg_user_shape, destroy, 80);

SIZE(rg_shape_report, 80);
FIELD(rg_shape_report, size, 0);
FIELD(rg_shape_report, kind, 8);
FIELD(rg_shape_report, lo, 16);
FIELD(rg_shape_report, hi, 40);
FIELD(rg_shape_report, triangle_count, 64);
FIELD(rg_shape_report, bytes, 72);

/* grid.h */

SIZE(rg_grid_config, 72);
FIELD(rg_grid_config, size, 0);
FIELD(rg_grid_config, kind, 8);
FIELD(rg_grid_config, resolution, 12);
FIELD(rg_grid_config, lo, 16);
FIELD(rg_grid_config, hi, 40);
FIELD(rg_grid_config, rebuild_factor, 64);

SIZE(rg_grid_report, 176);
FIELD(rg_grid_report, size, 0);
FIELD(rg_grid_report, kind, 8);
FIELD(rg_grid_report, levels, 12);
FIELD(rg_grid_report, levels_used, 16);
FIELD(rg_grid_report, resolution, 20);
FIELD(rg_grid_report, physical_lo, 32);
FIELD(rg_grid_report, physical_hi, 56);
FIELD(rg_grid_report, logical_lo, 80);
FIELD(rg_grid_report, logical_hi, 104);
FIELD(rg_grid_report, objects, 128);
FIELD(rg_grid_report, entries, 136);
FIELD(rg_grid_report, unbounded, 144);
FIELD(rg_grid_report, tiles, 152);
FIELD(rg_grid_report, rebuilds, 160);
FIELD(rg_grid_report, rebuilding, 168);
FIELD(rg_grid_report, reserved, 172);

/* scene.h */

SIZE(rg_scene_config, 88);
FIELD(rg_scene_config, size, 0);
FIELD(rg_scene_config, workers, 8);
FIELD(rg_scene_config, reserved, 12);
FIELD(rg_scene_config, allocator, 16);
FIELD(rg_scene_config, parallel_for, 40);
FIELD(rg_scene_config, parallel_for_user, 48);
FIELD(rg_scene_config, log, 56);
FIELD(rg_scene_config, log_user, 64);
FIELD(rg_scene_config, grid, 72);
FIELD(rg_scene_config, memory_limit, 80);

SIZE(rg_pose, 72);
FIELD(rg_pose, position, 0);
FIELD(rg_pose, linear, 24);
FIELD(rg_pose, scale, 64);

SIZE(rg_pose_views, 192);
FIELD(rg_pose_views, size, 0);
FIELD(rg_pose_views, position, 8);
FIELD(rg_pose_views, column, 48);
FIELD(rg_pose_views, scale, 168);

SIZE(rg_insert_views, 64);
FIELD(rg_insert_views, size, 0);
FIELD(rg_insert_views, shapes, 8);
FIELD(rg_insert_views, shapes_stride, 16);
FIELD(rg_insert_views, poses, 24);
FIELD(rg_insert_views, mask, 32);
FIELD(rg_insert_views, grid, 56);
FIELD(rg_insert_views, reserved, 60);

SIZE(rg_object_report, 144);
FIELD(rg_object_report, size, 0);
FIELD(rg_object_report, pose, 8);
FIELD(rg_object_report, shape, 80);
FIELD(rg_object_report, mask, 88);
FIELD(rg_object_report, grid, 92);
FIELD(rg_object_report, lo, 96);
FIELD(rg_object_report, hi, 120);

SIZE(rg_scene_report, 56);
FIELD(rg_scene_report, size, 0);
FIELD(rg_scene_report, objects, 8);
FIELD(rg_scene_report, slots, 16);
FIELD(rg_scene_report, bytes, 24);
FIELD(rg_scene_report, invalid_rays, 32);
FIELD(rg_scene_report, workers, 40);
FIELD(rg_scene_report, grids, 44);
FIELD(rg_scene_report, isa, 48);
FIELD(rg_scene_report, left_out, 52);

/* trace.h */

SIZE(rg_ray, 72);
FIELD(rg_ray, origin, 0);
FIELD(rg_ray, direction, 24);
FIELD(rg_ray, t_min, 48);
FIELD(rg_ray, t_max, 56);
FIELD(rg_ray, mask, 64);
FIELD(rg_ray, reserved, 68);

SIZE(rg_hit, 72);
FIELD(rg_hit, t, 0);
FIELD(rg_hit, object, 8);
FIELD(rg_hit, position, 16);
FIELD(rg_hit, normal, 40);
FIELD(rg_hit, offset, 52);
FIELD(rg_hit, u, 56);
FIELD(rg_hit, v, 60);
FIELD(rg_hit, primitive, 64);
FIELD(rg_hit, reserved, 68);

SIZE(rg_ray_views, 160);
FIELD(rg_ray_views, size, 0);
FIELD(rg_ray_views, origin, 8);
FIELD(rg_ray_views, direction, 48);
FIELD(rg_ray_views, t_min, 88);
FIELD(rg_ray_views, t_max, 112);
FIELD(rg_ray_views, mask, 136);

SIZE(rg_hit_views, 280);
FIELD(rg_hit_views, size, 0);
FIELD(rg_hit_views, t, 8);
FIELD(rg_hit_views, object, 32);
FIELD(rg_hit_views, primitive, 56);
FIELD(rg_hit_views, normal, 80);
FIELD(rg_hit_views, u, 120);
FIELD(rg_hit_views, v, 144);
FIELD(rg_hit_views, position, 168);
FIELD(rg_hit_views, offset, 208);
FIELD(rg_hit_views, cells, 232);
FIELD(rg_hit_views, tests, 256);

SIZE(rg_trace_config, 40);
FIELD(rg_trace_config, size, 0);
FIELD(rg_trace_config, cull, 8);
FIELD(rg_trace_config, coherence, 12);
FIELD(rg_trace_config, filter, 16);
FIELD(rg_trace_config, filter_user, 24);
FIELD(rg_trace_config, invalid, 32);

/* record.h */

SIZE(rg_sink, 32);
FIELD(rg_sink, size, 0);
FIELD(rg_sink, user, 8);
FIELD(rg_sink, write, 16);
FIELD(rg_sink, number_shape, 24);

SIZE(rg_source, 48);
FIELD(rg_source, size, 0);
FIELD(rg_source, bytes, 8);
FIELD(rg_source, byte_count, 16);
FIELD(rg_source, user, 24);
FIELD(rg_source, find_shape, 32);
FIELD(rg_source, shapes, 40);

SIZE(rg_replay_report, 48);
FIELD(rg_replay_report, size, 0);
FIELD(rg_replay_report, calls, 8);
FIELD(rg_replay_report, offset, 16);
FIELD(rg_replay_report, objects, 24);
FIELD(rg_replay_report, object, 32);
FIELD(rg_replay_report, call, 40);
FIELD(rg_replay_report, grid, 44);

#endif

int main(void) {
    return 0;
}
