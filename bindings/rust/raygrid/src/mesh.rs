// SPDX-License-Identifier: MIT
//! How meshes are made.

use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::sync::Arc;

use raygrid_sys as sys;

use crate::host::forget_panic;
use crate::views::{Float, Index, Indices, Triple, Vectors};
use crate::{Error, ErrorKind, MeshQuality, Result, Shape, sized};

/// What a mesh may read where it lies, in place of a copy of what it needs later: see [`Shape::mesh_of`].
///
/// The mesh owns it, and drops it when nothing reads it any more: at once if the mesh needs nothing of it, which is so if
/// all vertices are floats, in whichever type, of common size, and triangles share vertices or have no indices; else when
/// no object and no one else has the mesh any more, in the call that took the last reference away. An `Arc` of such data
/// is such data.
///
/// ```
/// use raygrid::views::{Indices, Vectors};
/// use raygrid::{MeshData, Shape};
/// use std::sync::Arc;
///
/// struct Model {
///     corners: Vec<[f64; 3]>,
///     faces: Vec<[u16; 3]>,
/// }
///
/// impl MeshData for Model {
///     fn vertices(&self) -> Vectors<'_> {
///         (&self.corners).into()
///     }
///
///     fn triangles(&self) -> Option<Indices<'_>> {
///         Some((&self.faces).into())
///     }
/// }
///
/// let model = Arc::new(Model { corners: vec![[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]], faces: vec![[0, 1, 2]] });
/// let mesh = Shape::mesh_of(Arc::clone(&model))?;
/// assert_eq!(Arc::strong_count(&model), 2);
/// drop(mesh);
/// assert_eq!(Arc::strong_count(&model), 1);
/// # Ok::<(), raygrid::Error>(())
/// ```
pub trait MeshData: Send + Sync + 'static {
    /// The vertices. Asked once.
    fn vertices(&self) -> Vectors<'_>;

    /// The corners of each triangle; `None`: each three vertices are one. Asked once, if at all.
    fn triangles(&self) -> Option<Indices<'_>> {
        None
    }
}

impl<D: MeshData> MeshData for Arc<D> {
    fn vertices(&self) -> Vectors<'_> {
        D::vertices(self)
    }

    fn triangles(&self) -> Option<Indices<'_>> {
        D::triangles(self)
    }
}

/// Each three vertices are a triangle.
impl<T: Triple<Float> + Send + Sync + 'static> MeshData for Vec<T> {
    fn vertices(&self) -> Vectors<'_> {
        self.into()
    }
}

/// Vertices and triangles.
impl<T, U> MeshData for (Vec<T>, Vec<U>)
where
    T: Triple<Float> + Send + Sync + 'static,
    U: Triple<Index> + Send + Sync + 'static,
{
    fn vertices(&self) -> Vectors<'_> {
        (&self.0).into()
    }

    fn triangles(&self) -> Option<Indices<'_>> {
        Some((&self.1).into())
    }
}

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
        let (vertices, triangles) = (vertices.into(), triangles.into());
        // SAFETY: both are there during the call.
        unsafe { self.create(&views(&vertices, Some(&triangles)), None) }
    }

    /// As [`Shape::triangles`].
    pub fn triangles<'a>(&self, vertices: impl Into<Vectors<'a>>) -> Result<Shape> {
        let vertices = vertices.into();
        // SAFETY: it is there during the call.
        unsafe { self.create(&views(&vertices, None), None) }
    }

    /// As [`Shape::deformed`], for the case that the mesh is made anew.
    pub fn deformed<'a>(&self, mesh: &Shape, vertices: impl Into<Vectors<'a>>) -> Result<Shape> {
        let vertices = vertices.into();
        // SAFETY: `vertices` is there during the call.
        unsafe { self.create(&views(&vertices, None), Some(mesh)) }
    }

    /// As [`Shape::mesh_of`].
    pub fn mesh_of(&self, data: impl MeshData) -> Result<Shape> {
        self.lend(data, None)
    }

    /// As [`Shape::deformed`], with vertices that the new mesh reads where they lie: its triangles are those of `mesh`,
    /// which `data` is not asked for.
    pub fn deformed_of(&self, mesh: &Shape, data: impl MeshData) -> Result<Shape> {
        self.lend(data, Some(mesh))
    }

    fn lend<D: MeshData>(&self, data: D, old: Option<&Shape>) -> Result<Shape> {
        let loan = Loan(Box::into_raw(Box::new(data)));
        // SAFETY: it is there until it is dropped below or by `released`.
        let data = unsafe { &*loan.0 };
        let vertices = data.vertices();
        if vertices.count().is_none() {
            // A view of one value for all leads into itself, which ends here.
            return Err(Error::new(
                ErrorKind::InvalidArgument,
                "vertices to be borrowed must be one each".to_owned(),
            ));
        }
        let triangles = if old.is_none() { data.triangles() } else { None };
        let mut views = views(&vertices, triangles.as_ref());
        views.released = Some(released::<D>);
        views.user = loan.0.cast();
        // SAFETY: what the views lead to is borrowed from the data, which has its place in memory and to which nobody
        // gets mutable access until `released` drops it.
        let shape = unsafe { self.create(&views, old) }?;
        std::mem::forget(loan);
        Ok(shape)
    }

    /// # Safety
    /// The views must lead to as many records as they say: until the call returns or, if they have a `released`, until
    /// that was called.
    unsafe fn create(&self, views: &sys::rg_mesh_views, old: Option<&Shape>) -> Result<Shape> {
        let config = self.raw();
        if old.is_none() && views.indices.x.is_null() && views.vertex_count % 3 != 0 {
            let message = format!("{} vertices are no whole number of triangles", views.vertex_count);
            return Err(Error::new(ErrorKind::InvalidArgument, message));
        }
        // SAFETY: as the caller says; the old mesh lives as long as `old`; `out` is written on success.
        Shape::made(|out| unsafe {
            match old {
                Some(mesh) => sys::rg_shape_create_deformed(&config, mesh.raw(), views, out),
                None => sys::rg_shape_create_mesh(&config, views, out),
            }
        })
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

/// Data that a mesh is to read, as long as it is not made.
struct Loan<D>(*mut D);

impl<D> Drop for Loan<D> {
    fn drop(&mut self) {
        // SAFETY: it was made of a Box, and no mesh has it.
        drop(unsafe { Box::from_raw(self.0) });
    }
}

unsafe extern "C" fn released<D>(user: *mut c_void) {
    // SAFETY: `user` was made of a Box by `lend`; the library calls this once, when it reads nothing of it any more.
    let data = unsafe { Box::from_raw(user.cast::<D>()) };
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| drop(data))) {
        forget_panic(panic, ());
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
        released: None,
        user: ptr::null_mut(),
    })
}
