// SPDX-License-Identifier: MIT
//! Poses and arrays of mint's points and vectors. Those of doubles are points or directions as they are.

use mint::{ColumnMatrix3x4, Point3, RowMatrix3x4, Vector3};

use crate::Pose;
use crate::views::{Float, Sealed, Triple};

impl From<RowMatrix3x4<f64>> for Pose {
    /// The first three columns are the linear part, the last one is the position.
    fn from(RowMatrix3x4 { x, y, z }: RowMatrix3x4<f64>) -> Self {
        let linear = [x, y, z].map(|row| [row.x as f32, row.y as f32, row.z as f32]);
        Self::at([x.w, y.w, z.w]).linear(linear)
    }
}

impl From<ColumnMatrix3x4<f64>> for Pose {
    /// The first three columns are the linear part, the last one is the position.
    fn from(matrix: ColumnMatrix3x4<f64>) -> Self {
        RowMatrix3x4::from(matrix).into()
    }
}

/// Arrays of these are read and written where they lie.
macro_rules! triples {
    ($($triple:ident<$number:ty>),*) => {
        $(const _: () = assert!(size_of::<$triple<$number>>() == size_of::<[$number; 3]>());
        impl Sealed for $triple<$number> {}
        // SAFETY: repr(C) of x, y and z.
        unsafe impl Triple<Float> for $triple<$number> {
            type Number = $number;
        })*
    };
}
triples!(Point3<f64>, Point3<f32>, Vector3<f64>, Vector3<f32>);

impl From<Point3<f64>> for Pose {
    fn from(position: Point3<f64>) -> Self {
        Self::at(position)
    }
}

impl From<Vector3<f64>> for Pose {
    fn from(position: Vector3<f64>) -> Self {
        Self::at(position)
    }
}
