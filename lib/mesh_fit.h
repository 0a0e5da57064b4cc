/* SPDX-License-Identifier: MIT */
/* The boxes of a mesh's tree, fitted to new vertices. */
#ifndef RAYGRID_LIB_MESH_FIT_H
#define RAYGRID_LIB_MESH_FIT_H

#include "mesh.h"

/**
 * Makes the boxes of all nodes larger by a pad. Returns what a ray costs by the surface area heuristic: the nodes and
 * leaves that it looks into, on average, of those that meet the box of the root.
 */
double rgi_mesh_settle(rgi_mesh *mesh, float pad);

#endif
