// SPDX-License-Identifier: MIT
//! Shapes: the geometry that objects share.

use std::fmt;
use std::marker::PhantomData;
use std::mem::ManuallyDrop;
use std::ptr::{self, NonNull};

use raygrid_sys as sys;

use crate::error::check;
use crate::views::{Indices, Vectors};
use crate::{MeshBuilder, MeshData, Result, ShapeReport, UserShape, sized, user_shape};

/// A shape: sphere, box, capsule, triangle mesh, or one of your own.
///
/// It never changes, and any number of objects of any number of scenes may share it. This is a counted reference to it,
/// as `Arc` is: a clone is the same shape, and objects keep it for themselves.
///
/// ```
/// use raygrid::{Ray, Scene, Shape};
///
/// let crates = Shape::box_between([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0])?;
/// let scene = Scene::new()?;
/// scene.insert_many(&crates, &[[0.0, 0.0, 5.0], [4.0, 0.0, 5.0]])?;
/// drop(crates);
/// assert_eq!(scene.trace(&Ray::new([4.0, 0.0, 0.0], [0.0, 0.0, 1.0]))?.unwrap().t, 4.0);
/// # Ok::<(), raygrid::Error>(())
/// ```
#[repr(transparent)]
pub struct Shape(NonNull<sys::rg_shape>);

// SAFETY: "All functions here may be called from any thread at any time" (raygrid/shape.h); shapes do not change.
unsafe impl Send for Shape {}
// SAFETY: as above.
unsafe impl Sync for Shape {}

impl Shape {
    /// A sphere around the local origin, of a radius from [`RADIUS_MIN`](crate::RADIUS_MIN) to
    /// [`COORDINATE_MAX`](crate::COORDINATE_MAX).
    pub fn sphere(radius: f64) -> Result<Self> {
        // SAFETY: `out` is written on success.
        Self::made(|out| unsafe { sys::rg_shape_create_sphere(ptr::null(), radius, out) })
    }

    /// A box from the corner `lo` to the corner `hi`. It may have no thickness, and be infinite, on any axis; an
    /// infinite axis needs a pose without a linear part.
    pub fn box_between(lo: impl Into<[f64; 3]>, hi: impl Into<[f64; 3]>) -> Result<Self> {
        let (lo, hi) = (lo.into(), hi.into());
        // SAFETY: the corners are three doubles each; `out` is written on success.
        Self::made(|out| unsafe { sys::rg_shape_create_box(ptr::null(), lo.as_ptr(), hi.as_ptr(), out) })
    }

    /// A capsule: all points within `radius` of the segment from `a` to `b`.
    pub fn capsule(a: impl Into<[f64; 3]>, b: impl Into<[f64; 3]>, radius: f64) -> Result<Self> {
        let (a, b) = (a.into(), b.into());
        // SAFETY: the ends are three doubles each; `out` is written on success.
        Self::made(|out| unsafe { sys::rg_shape_create_capsule(ptr::null(), a.as_ptr(), b.as_ptr(), radius, out) })
    }

    /// A mesh of triangles, each given by the numbers of its three corners. All is copied.
    ///
    /// ```
    /// use raygrid::Shape;
    ///
    /// let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let tetrahedron = Shape::mesh(&corners, &[[0_u32, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// assert_eq!(tetrahedron.stats()?.triangle_count, 4);
    /// # Ok::<(), raygrid::Error>(())
    /// ```
    pub fn mesh<'a>(vertices: impl Into<Vectors<'a>>, triangles: impl Into<Indices<'a>>) -> Result<Self> {
        Self::mesh_builder().mesh(vertices, triangles)
    }

    /// A mesh that reads what it needs of the data where it lies, and drops it when it needs it no more; answers are those
    /// of a mesh that has copied it.
    ///
    /// ```
    /// use raygrid::Shape;
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
    /// let faces = vec![[0_u32, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let copied = Shape::mesh(&corners, &faces)?.stats()?.bytes;
    /// assert_eq!(copied - Shape::mesh_of((corners, faces))?.stats()?.bytes, 4 * 24);
    /// # Ok::<(), raygrid::Error>(())
    /// ```
    pub fn mesh_of(data: impl MeshData) -> Result<Self> {
        Self::mesh_builder().mesh_of(data)
    }

    /// A mesh of triangles, each the next three vertices. All is copied.
    pub fn triangles<'a>(vertices: impl Into<Vectors<'a>>) -> Result<Self> {
        Self::mesh_builder().triangles(vertices)
    }

    /// A mesh of the triangles of this one with new vertices, as many as it has: made much faster than a new mesh. This
    /// one stays as it is; [`Scene::replace_shape`](crate::Scene::replace_shape) puts the new one in its place.
    ///
    /// ```
    /// use raygrid::{Ray, Scene, Shape};
    ///
    /// let mut corners = [[-1.0_f32, -1.0, 5.0], [1.0, -1.0, 5.0], [0.0, 1.0, 5.0]];
    /// let mut sail = Shape::triangles(&corners)?;
    /// let scene = Scene::new()?;
    /// scene.insert(&sail, [0.0; 3])?;
    /// for step in 1..4 {
    ///     corners.iter_mut().for_each(|corner| corner[2] -= 1.0);
    ///     let bent = sail.deformed(&corners)?;
    ///     scene.replace_shape(&sail, &bent)?;
    ///     sail = bent;
    ///     let hit = scene.trace(&Ray::new([0.0; 3], [0.0, 0.0, 1.0]))?.unwrap();
    ///     assert_eq!(hit.t, 5.0 - f64::from(step));
    /// }
    /// # Ok::<(), raygrid::Error>(())
    /// ```
    pub fn deformed<'a>(&self, vertices: impl Into<Vectors<'a>>) -> Result<Self> {
        Self::mesh_builder().deformed(self, vertices)
    }

    /// How a mesh is to be made.
    pub fn mesh_builder() -> MeshBuilder {
        MeshBuilder::default()
    }

    /// A shape of your own.
    pub fn user(shape: impl UserShape) -> Result<Self> {
        user_shape::create(shape)
    }

    /// The shape that `create` makes, or why it does not.
    pub(crate) fn made(create: impl FnOnce(*mut *mut sys::rg_shape) -> sys::rg_result) -> Result<Self> {
        let mut out = ptr::null_mut();
        check(create(&mut out))?;
        Ok(Self(NonNull::new(out).expect("a shape that was made is there")))
    }

    /// What is known of the shape.
    pub fn stats(&self) -> Result<ShapeReport> {
        let mut report = sized!(rg_shape_report {});
        // SAFETY: the shape lives as long as self; the report says its size.
        check(unsafe { sys::rg_shape_stats(self.raw(), &mut report) })?;
        Ok(ShapeReport::of_raw(report))
    }

    /// Which shape this is: all its clones have the same.
    pub fn id(&self) -> ShapeId {
        ShapeId::of_raw(self.raw())
    }

    pub(crate) fn raw(&self) -> *mut sys::rg_shape {
        self.0.as_ptr()
    }

    /// Gives the reference away.
    pub(crate) fn into_raw(self) -> *mut sys::rg_shape {
        ManuallyDrop::new(self).raw()
    }
}

impl Clone for Shape {
    fn clone(&self) -> Self {
        // SAFETY: the shape lives as long as self; the reference is the clone's.
        unsafe { sys::rg_shape_retain(self.raw()) };
        Self(self.0)
    }
}

impl Drop for Shape {
    fn drop(&mut self) {
        let mut raw = self.raw();
        // SAFETY: the reference was self's, which is not used any more.
        unsafe { sys::rg_shape_release(&mut raw) };
    }
}

impl fmt::Debug for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.stats() {
            Ok(report) => report.fmt(f),
            Err(error) => error.fmt(f),
        }
    }
}

/// Tells shapes apart, as long as they are there: the id of a shape that is gone may become another's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ShapeId(usize);

impl ShapeId {
    pub(crate) fn of_raw(raw: *const sys::rg_shape) -> Self {
        Self(raw.addr())
    }
}

/// The shapes of many objects: `&Shape`, one for all, or `&[Shape]`, one each.
#[derive(Clone, Copy, Debug)]
pub struct Shapes<'a> {
    first: *const Shape,
    count: Option<usize>,
    lifetime: PhantomData<&'a Shape>,
}

impl Shapes<'_> {
    pub(crate) fn count(&self) -> Option<usize> {
        self.count
    }

    /// The first pointer, and the bytes from one to the next.
    pub(crate) fn raw(&self) -> (*const std::ffi::c_void, isize) {
        (self.first.cast(), if self.count.is_some() { size_of::<Shape>() as isize } else { 0 })
    }
}

impl<'a> From<&'a Shape> for Shapes<'a> {
    fn from(shape: &'a Shape) -> Self {
        Self { first: shape, count: None, lifetime: PhantomData }
    }
}

impl<'a> From<&'a [Shape]> for Shapes<'a> {
    fn from(shapes: &'a [Shape]) -> Self {
        Self { first: shapes.as_ptr(), count: Some(shapes.len()), lifetime: PhantomData }
    }
}

impl<'a> From<&'a Vec<Shape>> for Shapes<'a> {
    fn from(shapes: &'a Vec<Shape>) -> Self {
        shapes.as_slice().into()
    }
}
