// SPDX-License-Identifier: MIT
//! Hits.

use std::mem::offset_of;

use bytemuck::{Pod, Zeroable};
use raygrid_sys as sys;

use crate::ObjectId;

/// [`Hit::primitive`] of a ray that hit nothing.
pub const NO_PRIMITIVE: u32 = sys::RG_NO_PRIMITIVE;

/// The closest hit of a ray. [`Hit::default`] is a miss.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C)]
pub struct Hit {
    /// In units of the direction's length; infinity for a miss, NaN for an invalid ray.
    pub t: f64,
    /// What was hit; `None` for a miss.
    pub object: Option<ObjectId>,
    /// Where, in the world: `origin + t * direction`, rounded once.
    pub position: [f64; 3],
    /// The surface's geometric normal there: outward, of length 1, in the world.
    pub normal: [f32; 3],
    /// How far along the normal, to either side, a further ray must start so that it does not hit the same spot again.
    pub offset: f32,
    /// The barycentric weight of a triangle's second corner.
    pub u: f32,
    /// The barycentric weight of a triangle's third corner.
    pub v: f32,
    /// The number of the triangle, or the face of a box; [`NO_PRIMITIVE`] for a miss.
    pub primitive: u32,
    /// 0.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub reserved: u32,
}

impl Hit {
    /// A miss.
    pub const MISS: Self = Self {
        t: f64::INFINITY,
        object: None,
        position: [0.0; 3],
        normal: [0.0; 3],
        offset: 0.0,
        u: 0.0,
        v: 0.0,
        primitive: NO_PRIMITIVE,
        reserved: 0,
    };

    /// Whether anything was hit.
    pub fn is_hit(&self) -> bool {
        self.object.is_some()
    }

    /// Whether the ray was invalid: a number of it NaN or out of its range, or its direction 0.
    pub fn is_invalid(&self) -> bool {
        self.t.is_nan()
    }

    /// Where a further ray along `direction` is to start, so that it does not hit the same spot again: off the
    /// surface, on the side that it goes to.
    ///
    /// ```
    /// use raygrid::{Ray, Scene, Shape};
    ///
    /// let scene = Scene::new()?;
    /// scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
    /// let hit = scene.trace(&Ray::new([0.0; 3], [0.0, 0.0, 1.0]))?.unwrap();
    /// let to_light = [3.0, 4.0, -3.0];
    /// assert!(!scene.occluded(&Ray::new(hit.leave(to_light), to_light))?);
    /// # Ok::<(), raygrid::Error>(())
    /// ```
    pub fn leave(&self, direction: impl Into<[f64; 3]>) -> [f64; 3] {
        let (direction, normal) = (direction.into(), self.normal.map(f64::from));
        let along: f64 = (0..3).map(|axis| direction[axis] * normal[axis]).sum();
        let offset = f64::from(self.offset).copysign(along);
        std::array::from_fn(|axis| self.position[axis] + offset * normal[axis])
    }
}

impl Default for Hit {
    fn default() -> Self {
        Self::MISS
    }
}

// SAFETY: zero is a value of every field.
unsafe impl Zeroable for Hit {}
// SAFETY: plain numbers and an Option<ObjectId>, for which any bits are a value; no padding, see below.
unsafe impl Pod for Hit {}

const _: () = {
    assert!(
        size_of::<Hit>() == 4 * size_of::<f64>() + size_of::<u64>() + 6 * size_of::<f32>() + 2 * size_of::<u32>()
    );
    assert!(size_of::<Hit>() == size_of::<sys::rg_hit>() && align_of::<Hit>() == align_of::<sys::rg_hit>());
    assert!(offset_of!(Hit, t) == offset_of!(sys::rg_hit, t));
    assert!(offset_of!(Hit, object) == offset_of!(sys::rg_hit, object));
    assert!(offset_of!(Hit, position) == offset_of!(sys::rg_hit, position));
    assert!(offset_of!(Hit, normal) == offset_of!(sys::rg_hit, normal));
    assert!(offset_of!(Hit, offset) == offset_of!(sys::rg_hit, offset));
    assert!(offset_of!(Hit, u) == offset_of!(sys::rg_hit, u));
    assert!(offset_of!(Hit, v) == offset_of!(sys::rg_hit, v));
    assert!(offset_of!(Hit, primitive) == offset_of!(sys::rg_hit, primitive));
    assert!(offset_of!(Hit, reserved) == offset_of!(sys::rg_hit, reserved));
};
