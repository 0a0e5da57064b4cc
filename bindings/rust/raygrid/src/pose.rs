// SPDX-License-Identifier: MIT
//! Where an object is.

use std::mem::offset_of;

use raygrid_sys as sys;

/// Where an object is: `world = position + scale * linear * local`.
///
/// Whatever takes a pose takes a position alone, too: `[f64; 3]`, and with the features `glam` and `mint` their
/// vectors and affine transforms.
///
/// ```
/// use raygrid::Pose;
///
/// let lying = Pose::at([0.0, 2.0, 0.0]).linear([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).scale(2.0);
/// assert_eq!(lying.position, [0.0, 2.0, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C)]
pub struct Pose {
    /// Where the local origin is.
    pub position: [f64; 3],
    /// Any invertible matrix, by rows: rotation, scale, mirror, shear.
    pub linear: [[f32; 3]; 3],
    /// A factor to `linear`. Spheres of all sizes need one shape only: a scale each.
    pub scale: f64,
}

/// The linear part that changes nothing.
const IDENTITY: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Pose {
    /// The pose that only moves: identity as linear part, scale 1.
    pub fn at(position: impl Into<[f64; 3]>) -> Self {
        Self { position: position.into(), linear: IDENTITY, scale: 1.0 }
    }

    /// The same pose with this linear part, by rows.
    #[must_use]
    pub fn linear(self, linear: [[f32; 3]; 3]) -> Self {
        Self { linear, ..self }
    }

    /// The same pose with this scale.
    #[must_use]
    pub fn scale(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    pub(crate) fn raw(&self) -> *const sys::rg_pose {
        std::ptr::from_ref(self).cast()
    }

    pub(crate) fn of_raw(raw: &sys::rg_pose) -> Self {
        let rows = &raw.linear;
        let linear = std::array::from_fn(|row| std::array::from_fn(|column| rows[3 * row + column]));
        Self { position: raw.position, linear, scale: raw.scale }
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self::at([0.0; 3])
    }
}

impl From<[f64; 3]> for Pose {
    fn from(position: [f64; 3]) -> Self {
        Self::at(position)
    }
}

impl From<&Pose> for Pose {
    fn from(pose: &Pose) -> Self {
        *pose
    }
}

const _: () = {
    assert!(size_of::<Pose>() == size_of::<sys::rg_pose>() && align_of::<Pose>() == align_of::<sys::rg_pose>());
    assert!(offset_of!(Pose, position) == offset_of!(sys::rg_pose, position));
    assert!(offset_of!(Pose, linear) == offset_of!(sys::rg_pose, linear));
    assert!(offset_of!(Pose, scale) == offset_of!(sys::rg_pose, scale));
};
