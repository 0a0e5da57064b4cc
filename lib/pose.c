/* SPDX-License-Identifier: MIT */
#include "pose.h"

#include "error.h"
#include "vec.h"

#include <string.h>

const float rgi_identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

rg_pose rg_pose_at(double x, double y, double z) {
    rg_pose pose;
    memset(&pose, 0, sizeof pose);
    rgi_set(pose.position, x, y, z);
    memcpy(pose.linear, rgi_identity, sizeof pose.linear);
    pose.scale = 1;
    return pose;
}

bool rgi_is_identity(const float matrix[9]) {
    for (int i = 0; i < 9; i++) {
        if (matrix[i] != rgi_identity[i]) return false;
    }
    return true;
}

rg_result rgi_check_position(const double position[3]) {
    for (int i = 0; i < 3; i++) {
        if (!(fabs(position[i]) <= RG_COORDINATE_MAX))
            return rgi_fail(RG_INVALID_VALUE, "position.%c is %g, which is not finite or beyond %g", "xyz"[i],
                            position[i], RG_COORDINATE_MAX);
    }
    return RG_OK;
}

rg_result rgi_check_scale(double scale) {
    if (scale >= RG_RADIUS_MIN && scale <= RG_COORDINATE_MAX) return RG_OK;
    return rgi_fail(RG_INVALID_VALUE, "scale of the pose is %g, not in [%g, %g]", scale, RG_RADIUS_MIN,
                    RG_COORDINATE_MAX);
}

/*
 * The inverse by cofactors. Products of two floats are exact in double, so the cofactors have one rounding and the
 * determinant an error below 2^-50 of the product of the rows' lengths (Hadamard's bound on it): against 2^-40 of
 * that product, what counts as singular is decided safely.
 */
rg_result rgi_linear_init(rgi_linear *linear, const float matrix[9], double scale) {
    double rows[3][3], cofactors[3][3], lengths = 1;
    for (int i = 0; i < 9; i++) {
        if (!isfinite(matrix[i]))
            return rgi_fail(RG_INVALID_VALUE, "linear[%d] of the pose is %g, which is not finite", i,
                            (double)matrix[i]);
        rows[i / 3][i % 3] = matrix[i];
    }
    for (int i = 0; i < 3; i++) {
        rgi_cross(rows[(i + 1) % 3], rows[(i + 2) % 3], cofactors[i]);
        lengths *= sqrt(rgi_dot(rows[i], rows[i]));
    }
    double determinant = rgi_dot(rows[0], cofactors[0]);
    if (!(fabs(determinant) > 0x1p-40 * lengths))
        return rgi_fail(RG_INVALID_VALUE, "the pose is singular: its linear part has determinant %g", determinant);
    memcpy(linear->matrix, matrix, sizeof linear->matrix);
    linear->scale = scale;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            linear->product[3 * i + j] = scale * matrix[3 * i + j];
            linear->inverse[3 * i + j] = cofactors[j][i] / determinant / scale;
        }
    }
    return RG_OK;
}
