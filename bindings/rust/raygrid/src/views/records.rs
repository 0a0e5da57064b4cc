// SPDX-License-Identifier: MIT
//! Views of whole rays, hits and poses.

use std::marker::PhantomData;

use raygrid_sys as sys;

use super::{Float, Floats, FloatsMut, IdsMut, Masks, PrimitivesMut, Triple, Vectors, VectorsMut, WholesMut};
use crate::error::check;
use crate::{Error, ErrorKind, Pose, Ray, Result, sized};

/// How many records all these have; `None` if each is one value for all.
pub(crate) fn agree<'a>(counts: impl IntoIterator<Item = (&'a str, Option<usize>)>) -> Result<Option<usize>> {
    let mut agreed: Option<(&str, usize)> = None;
    for (name, count) in counts {
        match (agreed, count) {
            (None, Some(count)) => agreed = Some((name, count)),
            (Some((first, wanted)), Some(count)) if count != wanted => {
                let message = format!("{name} has {count} records, {first} has {wanted}");
                return Err(Error::new(ErrorKind::InvalidArgument, message));
            }
            _ => {}
        }
    }
    Ok(agreed.map(|(_, count)| count))
}

/// Rays, field by field.
#[derive(Clone, Copy, Debug)]
pub struct RayViews<'a> {
    origin: Vectors<'a>,
    direction: Vectors<'a>,
    t_min: Option<Floats<'a>>,
    t_max: Option<Floats<'a>>,
    mask: Option<Masks<'a>>,
}

impl<'a> RayViews<'a> {
    /// Rays from these origins along these directions: t from 0 to infinity, all mask bits set.
    pub fn new(origin: impl Into<Vectors<'a>>, direction: impl Into<Vectors<'a>>) -> Self {
        Self { origin: origin.into(), direction: direction.into(), t_min: None, t_max: None, mask: None }
    }

    /// The least t that counts.
    #[must_use]
    pub fn t_min(self, t_min: impl Into<Floats<'a>>) -> Self {
        Self { t_min: Some(t_min.into()), ..self }
    }

    /// The largest t that counts.
    #[must_use]
    pub fn t_max(self, t_max: impl Into<Floats<'a>>) -> Self {
        Self { t_max: Some(t_max.into()), ..self }
    }

    /// Which objects the rays see: those whose mask shares a bit.
    #[must_use]
    pub fn mask(self, mask: impl Into<Masks<'a>>) -> Self {
        Self { mask: Some(mask.into()), ..self }
    }

    /// The same rays, the last first.
    #[must_use]
    pub fn rev(self) -> Self {
        Self {
            origin: self.origin.rev(),
            direction: self.direction.rev(),
            t_min: self.t_min.map(Floats::rev),
            t_max: self.t_max.map(Floats::rev),
            mask: self.mask.map(Masks::rev),
        }
    }

    pub(crate) fn counts(&self) -> [(&'static str, Option<usize>); 5] {
        [
            ("origin", self.origin.count()),
            ("direction", self.direction.count()),
            ("t_min", self.t_min.and_then(|view| view.count())),
            ("t_max", self.t_max.and_then(|view| view.count())),
            ("mask", self.mask.and_then(|view| view.count())),
        ]
    }

    /// Holds as long as self is where it is.
    pub(crate) fn raw(&self) -> sys::rg_ray_views {
        sized!(rg_ray_views {
            origin: self.origin.raw(),
            direction: self.direction.raw(),
            t_min: self.t_min.as_ref().map(Floats::raw).unwrap_or_default(),
            t_max: self.t_max.as_ref().map(Floats::raw).unwrap_or_default(),
            mask: self.mask.as_ref().map(Masks::raw).unwrap_or_default(),
        })
    }
}

impl<'a> From<&'a [Ray]> for RayViews<'a> {
    fn from(rays: &'a [Ray]) -> Self {
        Self::new(Vectors::field(rays, |ray| &ray.origin), Vectors::field(rays, |ray| &ray.direction))
            .t_min(Floats::field(rays, |ray| &ray.t_min))
            .t_max(Floats::field(rays, |ray| &ray.t_max))
            .mask(Masks::field(rays, |ray| &ray.mask))
    }
}

/// Which fields of hits are wanted, and where. What is not asked for is not computed.
#[derive(Debug, Default)]
pub struct HitViews<'a> {
    raw: sys::rg_hit_views,
    /// The first view, and the first that has another count.
    counts: [Option<(&'static str, usize)>; 2],
    lifetime: PhantomData<&'a mut f64>,
}

/// The setter of a field.
macro_rules! wanted {
    ($(#[$doc:meta] $name:ident: $view:ident,)*) => {
        $(#[$doc]
        #[must_use]
        pub fn $name(mut self, $name: impl Into<$view<'a>>) -> Self {
            let view = $name.into();
            self.raw.$name = view.raw();
            self.note(stringify!($name), view.count());
            self
        })*
    };
}

impl<'a> HitViews<'a> {
    /// Nothing, yet.
    pub fn new() -> Self {
        Self::default()
    }

    wanted! {
        /// The distance, in units of the direction's length; infinity for a miss, NaN for an invalid ray.
        t: FloatsMut,
        /// What was hit.
        object: IdsMut,
        /// The number of the triangle, or the face of a box.
        primitive: PrimitivesMut,
        /// The surface's normal.
        normal: VectorsMut,
        /// The barycentric weight of a triangle's second corner.
        u: FloatsMut,
        /// The barycentric weight of a triangle's third corner.
        v: FloatsMut,
        /// Where, in the world.
        position: VectorsMut,
        /// How far along the normal a further ray must start.
        offset: FloatsMut,
        /// Cells that the ray looked into, all grids and levels.
        cells: WholesMut,
        /// Objects that the ray was tested against, repeats counted.
        tests: WholesMut,
    }

    fn note(&mut self, name: &'static str, count: usize) {
        match self.counts {
            [None, _] => self.counts[0] = Some((name, count)),
            [Some((_, first)), None] if first != count => self.counts[1] = Some((name, count)),
            _ => {}
        }
    }

    pub(crate) fn counts(&self) -> impl Iterator<Item = (&'static str, Option<usize>)> {
        self.counts.into_iter().flatten().map(|(name, count)| (name, Some(count)))
    }

    pub(crate) fn raw(&self) -> sys::rg_hit_views {
        sys::rg_hit_views { size: size_of::<sys::rg_hit_views>(), ..self.raw }
    }
}

/// Where many objects are: `&[Pose]`, or positions by views, and if need be linear parts and scales.
#[derive(Clone, Copy, Debug)]
pub struct Poses<'a>(Given<'a>);

#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "lives on the stack for the time of a call")]
enum Given<'a> {
    Records(&'a [Pose]),
    Views(PoseViews<'a>),
}

impl<'a> Poses<'a> {
    /// Objects at these positions, to which linear parts and scales may be added.
    pub fn at(position: impl Into<Vectors<'a>>) -> PoseViews<'a> {
        PoseViews { position: position.into(), columns: None, scale: None }
    }

    pub(crate) fn counts(&self) -> [(&'static str, Option<usize>); 5] {
        match &self.0 {
            Given::Records(poses) => [("poses", Some(poses.len())), ("", None), ("", None), ("", None), ("", None)],
            Given::Views(views) => views.counts(),
        }
    }

    /// Holds as long as self is where it is.
    pub(crate) fn raw(&self) -> Result<sys::rg_pose_views> {
        let mut raw = sized!(rg_pose_views {});
        match &self.0 {
            Given::Records(poses) => {
                let (first, stride) = (poses.as_ptr().cast(), size_of::<Pose>() as isize);
                // SAFETY: `raw` is as large as it says; the poses are not looked at.
                check(unsafe { sys::rg_pose_views_of(&mut raw, raw.size, first, stride) })?;
            }
            Given::Views(views) => raw = views.raw(),
        }
        Ok(raw)
    }
}

impl<'a> From<&'a [Pose]> for Poses<'a> {
    fn from(poses: &'a [Pose]) -> Self {
        Self(Given::Records(poses))
    }
}

impl<'a> From<&'a Vec<Pose>> for Poses<'a> {
    fn from(poses: &'a Vec<Pose>) -> Self {
        poses.as_slice().into()
    }
}

impl<'a> From<PoseViews<'a>> for Poses<'a> {
    fn from(views: PoseViews<'a>) -> Self {
        Self(Given::Views(views))
    }
}

/// Poses, part by part. What is not given, an insert takes as the identity and 1, and each object keeps in a move.
#[derive(Clone, Copy, Debug)]
pub struct PoseViews<'a> {
    position: Vectors<'a>,
    columns: Option<[Vectors<'a>; 3]>,
    scale: Option<Floats<'a>>,
}

impl<'a> PoseViews<'a> {
    /// The same, with linear parts by columns: the world images of the local axes.
    #[must_use]
    pub fn columns<V: Into<Vectors<'a>>>(self, columns: [V; 3]) -> Self {
        Self { columns: Some(columns.map(Into::into)), ..self }
    }

    /// The same, with scales.
    #[must_use]
    pub fn scale(self, scale: impl Into<Floats<'a>>) -> Self {
        Self { scale: Some(scale.into()), ..self }
    }

    fn counts(&self) -> [(&'static str, Option<usize>); 5] {
        let column = |axis: usize| self.columns.and_then(|columns| columns[axis].count());
        [
            ("position", self.position.count()),
            ("column 0", column(0)),
            ("column 1", column(1)),
            ("column 2", column(2)),
            ("scale", self.scale.and_then(|view| view.count())),
        ]
    }

    /// Holds as long as self is where it is.
    fn raw(&self) -> sys::rg_pose_views {
        let columns = self.columns.as_ref();
        sized!(rg_pose_views {
            position: self.position.raw(),
            column: columns.map(|columns| columns.each_ref().map(Vectors::raw)).unwrap_or_default(),
            scale: self.scale.as_ref().map(Floats::raw).unwrap_or_default(),
        })
    }
}

impl<'a, T: Triple<Float>> From<&'a [T]> for Poses<'a> {
    fn from(positions: &'a [T]) -> Self {
        Self::at(positions).into()
    }
}

impl<'a, T: Triple<Float>> From<&'a Vec<T>> for Poses<'a> {
    fn from(positions: &'a Vec<T>) -> Self {
        Self::at(positions).into()
    }
}

impl<'a, T: Triple<Float>, const N: usize> From<&'a [T; N]> for Poses<'a> {
    fn from(positions: &'a [T; N]) -> Self {
        Self::at(positions).into()
    }
}

impl<'a> From<Vectors<'a>> for Poses<'a> {
    fn from(positions: Vectors<'a>) -> Self {
        Self::at(positions).into()
    }
}

impl From<[f64; 3]> for Poses<'_> {
    fn from(position: [f64; 3]) -> Self {
        Self::at(position).into()
    }
}
