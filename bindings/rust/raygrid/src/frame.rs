// SPDX-License-Identifier: MIT
//! Frames: what a scene held at one instant.

use std::ops::Deref;

use raygrid_sys as sys;

use crate::error::check;
use crate::{Builder, Result, Scene};

/// What a scene held at one instant, under the same ids, while the scene goes on to change: from [`Scene::frame`].
///
/// It is traced and read as the scene that it derefs to; what would change that one is
/// [`ErrorKind::Busy`](crate::ErrorKind::Busy). It may outlive its scene, which then ends with it.
///
/// ```
/// use raygrid::{Ray, Scene, Shape};
///
/// let scene = Scene::new()?;
/// let ball = scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
/// let frame = scene.frame()?;
/// scene.move_to(ball, [0.0, 0.0, 9.0])?;
///
/// let ray = Ray::new([0.0; 3], [0.0, 0.0, 1.0]);
/// assert_eq!(frame.trace(&ray)?.map(|hit| hit.t), Some(4.0));
/// frame.update()?;
/// assert_eq!(frame.trace(&ray)?.map(|hit| hit.t), Some(8.0));
/// # Ok::<(), raygrid::Error>(())
/// ```
#[derive(Debug)]
pub struct Frame(Scene);

impl Scene {
    /// A frame of the scene as it is now, with all defaults.
    pub fn frame(&self) -> Result<Frame> {
        self.frame_by(Self::builder())
    }

    /// A frame of the scene as it is now, made as the builder says; its grids are as the scene's. It takes as much
    /// memory as the scene's objects, and each change of the scene some nanoseconds more as long as it is there.
    pub fn frame_by(&self, builder: Builder) -> Result<Frame> {
        let made = builder.make(Some(self.keeper()), |config, out| {
            // SAFETY: the scene lives as long as self, and for the frame as long as it keeps its share.
            unsafe { sys::rg_scene_create_frame(self.raw(), config, out) }
        });
        made.map(Frame)
    }
}

impl Frame {
    /// Takes over what has changed in the scene since the last update, all of one instant. Traces of the frame see it
    /// whole or not at all.
    pub fn update(&self) -> Result<()> {
        // SAFETY: the frame lives as long as self, and what it follows as long as the frame.
        self.0.changed(check(unsafe { sys::rg_scene_update_frame(self.0.raw()) }))
    }
}

impl Deref for Frame {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.0
    }
}
