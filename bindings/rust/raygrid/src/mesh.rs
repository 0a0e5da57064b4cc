// SPDX-License-Identifier: MIT
//! How meshes are made.

use std::ptr;

use raygrid_sys as sys;

use crate::views::{Indices, Vectors};
use crate::{Error, ErrorKind, MeshQuality, Result, Shape, sized};

/// How a mesh is made: from [`Shape::mesh_builder`]. No answer depends on it.
///
/// ```
/// use raygrid::{MeshQuality, Shape};
///
/// let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let making = Shape::mesh_builder().quality(MeshQuality::Fast).workers(2);
/// let mesh = making.mesh(&corners, &[[0_u32, 1, 2]])?;
/// let larger = making.deformed(&mesh, &corners.map(|corner| corner.map(|x| 2.0 * x)))?;
/// assert_eq!(larger.stats()?.hi, [2.0, 2.0, 0.0]);
/// # Ok::<(), raygrid::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[must_use]
pub struct MeshBuilder {
    quality: MeshQuality,
    workers: u32,
}

impl MeshBuilder {
    /// How much time the making may take.
    pub fn quality(self, quality: MeshQuality) -> Self {
        Self { quality, ..self }
    }

    /// Threads that make a mesh together, the calling one among them: 0, the default, or 1 for the calling thread alone.
    /// They end before the call does.
    pub fn workers(self, workers: u32) -> Self {
        Self { workers, ..self }
    }

    /// As [`Shape::mesh`].
    pub fn mesh<'a>(&self, vertices: impl Into<Vectors<'a>>, triangles: impl Into<Indices<'a>>) -> Result<Shape> {
        self.create(&vertices.into(), Some(&triangles.into()))
    }

    /// As [`Shape::triangles`].
    pub fn triangles<'a>(&self, vertices: impl Into<Vectors<'a>>) -> Result<Shape> {
        self.create(&vertices.into(), None)
    }

    /// As [`Shape::deformed`], for the case that the mesh is made anew.
    pub fn deformed<'a>(&self, mesh: &Shape, vertices: impl Into<Vectors<'a>>) -> Result<Shape> {
        let (config, views) = (self.raw(), views(&vertices.into(), None));
        // SAFETY: the views lead to as many vertices as they say; the mesh lives as long as `mesh`; `out` is written on
        // success.
        Shape::made(|out| unsafe { sys::rg_shape_create_deformed(&config, mesh.raw(), &views, out) })
    }

    fn create(&self, vertices: &Vectors<'_>, triangles: Option<&Indices<'_>>) -> Result<Shape> {
        let (config, views) = (self.raw(), views(vertices, triangles));
        if triangles.is_none() && views.vertex_count % 3 != 0 {
            let message = format!("{} vertices are no whole number of triangles", views.vertex_count);
            return Err(Error::new(ErrorKind::InvalidArgument, message));
        }
        // SAFETY: the views lead to as many records as they say; `out` is written on success.
        Shape::made(|out| unsafe { sys::rg_shape_create_mesh(&config, &views, out) })
    }

    fn raw(&self) -> sys::rg_shape_config {
        sized!(rg_shape_config {
            allocator: sys::rg_allocator { user: ptr::null_mut(), allocate: None, release: None },
            quality: self.quality as i32,
            workers: self.workers,
            parallel_for: None,
            parallel_for_user: ptr::null_mut(),
        })
    }
}

/// Without triangles each three vertices are one.
fn views(vertices: &Vectors<'_>, triangles: Option<&Indices<'_>>) -> sys::rg_mesh_views {
    let count = vertices.count().unwrap_or(1);
    sized!(rg_mesh_views {
        vertices: vertices.raw(),
        vertex_count: count as u64,
        indices: triangles.map(Indices::raw).unwrap_or_default(),
        triangle_count: triangles.map_or(count / 3, |each| each.count().unwrap_or(1)) as u64,
    })
}
