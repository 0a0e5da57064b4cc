/* SPDX-License-Identifier: MIT */
/*
 * raygrid: ray queries in scenes where everything may appear, move and vanish at any moment.
 *
 *   base.h   results, hooks of the host, views of its memory
 *   shape.h  shapes: sphere, box, capsule, mesh, user-defined
 *   scene.h  scenes, their objects and grids: insert, move, remove
 *   grid.h   what a grid is and how it is set up
 *   trace.h  rays, hits, trace and occluded
 *   record.h snapshots and recordings of scenes
 */
#ifndef RAYGRID_RAYGRID_H
#define RAYGRID_RAYGRID_H

#include <raygrid/base.h>
#include <raygrid/grid.h>
#include <raygrid/record.h>
#include <raygrid/scene.h>
#include <raygrid/shape.h>
#include <raygrid/trace.h>

#endif
