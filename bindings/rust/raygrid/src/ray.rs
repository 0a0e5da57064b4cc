// SPDX-License-Identifier: MIT
//! Rays.

use std::mem::offset_of;

use bytemuck::{Pod, Zeroable};
use raygrid_sys as sys;

/// A ray: the points `origin + t * direction` with `t_min <= t <= t_max`.
///
/// Anything that turns into `[f64; 3]` is a point or a direction, the double vectors of glam and mint among it.
///
/// ```
/// use raygrid::Ray;
///
/// let ray = Ray::new([0.0, 0.0, 0.0], [0.0, 0.0, 2.0]).until(10.0);
/// assert_eq!((ray.t_min, ray.t_max), (0.0, 10.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C)]
pub struct Ray {
    /// Where t is 0.
    pub origin: [f64; 3],
    /// Of any length but 0. Distances t are in units of this length.
    pub direction: [f64; 3],
    /// The least t that counts; may be negative or -infinity.
    pub t_min: f64,
    /// The largest t that counts; may be infinity.
    pub t_max: f64,
    /// It sees objects with `object mask & mask != 0`.
    pub mask: u32,
    /// Ignored.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub reserved: u32,
}

impl Ray {
    /// The ray from `origin` along `direction`: t from 0 to infinity, all mask bits set.
    pub fn new(origin: impl Into<[f64; 3]>, direction: impl Into<[f64; 3]>) -> Self {
        Self {
            origin: origin.into(),
            direction: direction.into(),
            t_min: 0.0,
            t_max: f64::INFINITY,
            mask: u32::MAX,
            reserved: 0,
        }
    }

    /// The straight way from `start` to `end`: t from 0 to 1.
    ///
    /// ```
    /// use raygrid::{Ray, Scene, Shape};
    ///
    /// let scene = Scene::new()?;
    /// scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
    /// assert!(scene.occluded(&Ray::between([0.0, 0.0, 0.0], [0.0, 0.0, 9.0]))?);
    /// assert!(!scene.occluded(&Ray::between([0.0, 0.0, 0.0], [0.0, 0.0, 3.0]))?);
    /// # Ok::<(), raygrid::Error>(())
    /// ```
    pub fn between(start: impl Into<[f64; 3]>, end: impl Into<[f64; 3]>) -> Self {
        let (start, end) = (start.into(), end.into());
        Self { t_max: 1.0, ..Self::new(start, std::array::from_fn(|axis| end[axis] - start[axis])) }
    }

    /// The same ray from this t on.
    #[must_use]
    pub fn from(self, t_min: f64) -> Self {
        Self { t_min, ..self }
    }

    /// The same ray up to this t.
    #[must_use]
    pub fn until(self, t_max: f64) -> Self {
        Self { t_max, ..self }
    }

    /// The same ray with this mask.
    #[must_use]
    pub fn mask(self, mask: u32) -> Self {
        Self { mask, ..self }
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> [f64; 3] {
        std::array::from_fn(|axis| self.origin[axis] + t * self.direction[axis])
    }
}

// SAFETY: zero is a value of every field.
unsafe impl Zeroable for Ray {}
// SAFETY: plain numbers, for which any bits are a value; no padding, see below.
unsafe impl Pod for Ray {}

const _: () = {
    assert!(size_of::<Ray>() == 8 * size_of::<f64>() + 2 * size_of::<u32>());
    assert!(size_of::<Ray>() == size_of::<sys::rg_ray>() && align_of::<Ray>() == align_of::<sys::rg_ray>());
    assert!(offset_of!(Ray, origin) == offset_of!(sys::rg_ray, origin));
    assert!(offset_of!(Ray, direction) == offset_of!(sys::rg_ray, direction));
    assert!(offset_of!(Ray, t_min) == offset_of!(sys::rg_ray, t_min));
    assert!(offset_of!(Ray, t_max) == offset_of!(sys::rg_ray, t_max));
    assert!(offset_of!(Ray, mask) == offset_of!(sys::rg_ray, mask));
};
