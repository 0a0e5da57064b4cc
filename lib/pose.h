/* SPDX-License-Identifier: MIT */
/* Poses: checking, inverting, and the two ways that vectors go through them. Matrices are stored by rows. */
#ifndef RAYGRID_LIB_POSE_H
#define RAYGRID_LIB_POSE_H

#include <raygrid/scene.h>

#include <stdbool.h>

/** A linear part with its scale, and their product's inverse. */
typedef struct rgi_linear {
    uint32_t link; /* of the list of free records */
    float matrix[9];
    double scale;
    double product[9]; /* scale * matrix */
    double inverse[9]; /* of the product */
} rgi_linear;

/** RG_INVALID_VALUE if the position is not finite or too large. */
rg_result rgi_check_position(const double position[3]);

/** RG_INVALID_VALUE if the scale is not in its range. */
rg_result rgi_check_scale(double scale);

/** Inverts a linear part with a scale that was checked; RG_INVALID_VALUE if it is not finite or singular. */
rg_result rgi_linear_init(rgi_linear *linear, const float matrix[9], double scale);

bool rgi_is_identity(const float matrix[9]);

/** The linear part of rg_pose_at. */
extern const float rgi_identity[9];

/** out = M v */
static inline void rgi_transform(const double m[9], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

/** out = transposed M v; with the inverse of a pose, takes local normals to the world. */
static inline void rgi_transform_transposed(const double m[9], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2];
}

#endif
