// SPDX-License-Identifier: MIT
//! Poses and arrays of glam's vectors. `glam::DVec3` is a point or a direction as it is.

use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3A, Vec3, Vec3A};

use crate::Pose;
use crate::views::{Float, Sealed, Triple, Vectors};

impl From<DVec3> for Pose {
    fn from(position: DVec3) -> Self {
        Self::at(position)
    }
}

impl From<DAffine3> for Pose {
    fn from(DAffine3 { matrix3, translation }: DAffine3) -> Self {
        let DMat3 { x_axis, y_axis, z_axis } = matrix3;
        let [x, y, z] = [x_axis, y_axis, z_axis].map(|axis| axis.as_vec3().to_array());
        Self::at(translation).linear(rows([x, y, z]))
    }
}

impl From<Affine3A> for Pose {
    fn from(Affine3A { matrix3, translation }: Affine3A) -> Self {
        let Mat3A { x_axis, y_axis, z_axis } = matrix3;
        let columns = [x_axis, y_axis, z_axis].map(|axis| axis.to_array());
        Self::at(translation.to_array().map(f64::from)).linear(rows(columns))
    }
}

/// The matrix with these columns, by rows.
pub(crate) fn rows(columns: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| columns[column][row]))
}

impl From<DVec3> for Vectors<'_> {
    fn from(value: DVec3) -> Self {
        value.to_array().into()
    }
}

/// Arrays of these are read and written where they lie.
macro_rules! triples {
    ($($triple:ty: $number:ty),*) => {
        $(impl Sealed for $triple {}
        // SAFETY: x, y and z one after another; Vec3A has a fourth number after these, which stays what it is.
        unsafe impl Triple<Float> for $triple {
            type Number = $number;
        })*
    };
}
triples!(DVec3: f64, Vec3: f32, Vec3A: f32);
