// SPDX-License-Identifier: MIT
//! Scenes: calls on many objects, which do all or, on any error, nothing.

use raygrid_sys as sys;

use crate::error::check;
use crate::views::{Ids, Masks, Poses, agree};
use crate::{GridId, ObjectId, Result, Scene, Shapes, sized};

/// What is to be inserted, with all that may be said of it.
///
/// ```
/// use raygrid::views::Poses;
/// use raygrid::{GridConfig, Insert, Scene, Shape};
///
/// let scene = Scene::new()?;
/// let walls = scene.create_grid(&GridConfig::default())?;
/// let places = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0]];
/// let poses = Poses::at(&places).scale(&[1.0, 0.5]);
/// let ids = scene.insert_all(Insert::new(&Shape::sphere(1.0)?, poses).mask(0b10).grid(walls))?;
/// assert_eq!(scene.lookup(ids[1])?.mask, 0b10);
/// # Ok::<(), raygrid::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Insert<'a> {
    shapes: Shapes<'a>,
    poses: Poses<'a>,
    mask: Option<Masks<'a>>,
    grid: GridId,
}

impl<'a> Insert<'a> {
    /// Objects of these shapes with these poses.
    pub fn new(shapes: impl Into<Shapes<'a>>, poses: impl Into<Poses<'a>>) -> Self {
        Self { shapes: shapes.into(), poses: poses.into(), mask: None, grid: GridId::OF_SCENE }
    }

    /// Which rays see them: those whose mask shares a bit. Not said: all.
    #[must_use]
    pub fn mask(self, mask: impl Into<Masks<'a>>) -> Self {
        Self { mask: Some(mask.into()), ..self }
    }

    /// Where they are stored. Not said: in the scene's own grid.
    #[must_use]
    pub fn grid(self, grid: GridId) -> Self {
        Self { grid, ..self }
    }
}

impl Scene {
    /// Inserts many objects: as many as there are poses. One shape may serve all.
    pub fn insert_many<'a>(
        &self,
        shapes: impl Into<Shapes<'a>>,
        poses: impl Into<Poses<'a>>,
    ) -> Result<Vec<ObjectId>> {
        self.insert_all(Insert::new(shapes, poses))
    }

    /// Inserts many objects, as [`Insert`] says.
    pub fn insert_all(&self, insert: Insert<'_>) -> Result<Vec<ObjectId>> {
        let own = [("shapes", insert.shapes.count()), ("mask", insert.mask.and_then(|mask| mask.count()))];
        let count = agree(insert.poses.counts().into_iter().chain(own))?.unwrap_or(1);
        let (shapes, shapes_stride) = insert.shapes.raw();
        let poses = insert.poses.raw()?;
        let views = sized!(rg_insert_views {
            shapes: shapes,
            shapes_stride: shapes_stride,
            poses: &poses,
            mask: insert.mask.as_ref().map(Masks::raw).unwrap_or_default(),
            grid: insert.grid.0,
            reserved: 0,
        });
        let mut ids: Vec<ObjectId> = Vec::with_capacity(count);
        let output = sys::rg_output {
            data: ids.as_mut_ptr().cast(),
            stride: size_of::<ObjectId>() as isize,
            type_: sys::RG_U64,
        };
        // SAFETY: the scene lives as long as self; the views lead to `count` records each; there is room for the ids.
        let result = check(unsafe { sys::rg_scene_insert_many(self.raw(), &views, count as u64, &output) });
        if result.is_ok() {
            // SAFETY: on success all ids were written, and no object has the id 0.
            unsafe { ids.set_len(count) };
        }
        self.changed(result.map(|()| ids))
    }

    /// Moves many objects. What poses do not say, linear parts or scales, each object keeps. An object that is named
    /// twice ends at its last pose.
    pub fn move_many<'a>(&self, objects: impl Into<Ids<'a>>, poses: impl Into<Poses<'a>>) -> Result<()> {
        let (objects, poses) = (objects.into(), poses.into());
        let own = [("objects", objects.count())];
        let count = agree(own.into_iter().chain(poses.counts()))?.unwrap_or(1);
        let (ids, views) = (objects.raw(), poses.raw()?);
        // SAFETY: the scene lives as long as self; the views lead to `count` records each.
        self.changed(check(unsafe { sys::rg_scene_move_many(self.raw(), &ids, &views, count as u64) }))
    }

    /// Removes many objects. An id that is stale or given twice is [`InvalidId`](crate::ErrorKind::InvalidId).
    pub fn remove_many<'a>(&self, objects: impl Into<Ids<'a>>) -> Result<()> {
        let objects = objects.into();
        let (ids, count) = (objects.raw(), objects.count().unwrap_or(1) as u64);
        // SAFETY: the scene lives as long as self; the view leads to `count` ids.
        self.changed(check(unsafe { sys::rg_scene_remove_many(self.raw(), &ids, count) }))
    }
}
