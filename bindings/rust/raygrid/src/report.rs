// SPDX-License-Identifier: MIT
//! What is known of scenes, objects and shapes.

use std::fmt;
use std::ops::BitOr;

use raygrid_sys as sys;

use crate::{GridId, Isa, Pose, ShapeId, ShapeKind};

/// What traces of a scene do without, because it holds nothing that needs it: a set of flags.
///
/// ```
/// use raygrid::{Scene, Without};
///
/// let scene = Scene::builder().workers(1).build()?;
/// assert!(scene.stats()?.left_out.contains(Without::THREADS | Without::MASKS));
/// # Ok::<(), raygrid::Error>(())
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Without(u32);

impl Without {
    /// Spheres only, in grids of the loose kind: no boxes are tested in leaves.
    pub const BOXES: Self = Self(sys::RG_WITHOUT_BOXES as u32);
    /// No object was ever given a mask that hides it from some rays.
    pub const MASKS: Self = Self(sys::RG_WITHOUT_MASKS as u32);
    /// Every object has cells: none is tested for every ray.
    pub const UNBOUNDED: Self = Self(sys::RG_WITHOUT_UNBOUNDED as u32);
    /// Nothing has left the physical boxes of uniform and hierarchical grids.
    pub const TILES: Self = Self(sys::RG_WITHOUT_TILES as u32);
    /// Hierarchical grids: levels that hold nothing are passed over.
    pub const LEVELS: Self = Self(sys::RG_WITHOUT_LEVELS as u32);
    /// At most one grid holds objects.
    pub const GRIDS: Self = Self(sys::RG_WITHOUT_GRIDS as u32);
    /// The calling thread traces alone.
    pub const THREADS: Self = Self(sys::RG_WITHOUT_THREADS as u32);

    /// All flags by their names.
    pub const NAMES: &'static [(&'static str, Self)] = &[
        ("BOXES", Self::BOXES),
        ("MASKS", Self::MASKS),
        ("UNBOUNDED", Self::UNBOUNDED),
        ("TILES", Self::TILES),
        ("LEVELS", Self::LEVELS),
        ("GRIDS", Self::GRIDS),
        ("THREADS", Self::THREADS),
    ];

    /// The bits as they are in C.
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Whether all flags of `other` are set.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for Without {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl fmt::Debug for Without {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let set = Self::NAMES.iter().filter(|(_, flag)| self.contains(*flag));
        f.debug_set().entries(set.map(|(name, _)| format_args!("{name}").to_string())).finish()
    }
}

/// What is known of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SceneReport {
    /// Objects that it holds.
    pub objects: u64,
    /// The largest number of objects it held at once.
    pub slots: u64,
    /// Bytes of memory, shapes not counted.
    pub bytes: u64,
    /// Rays refused as invalid by all traces so far.
    pub invalid_rays: u64,
    /// Threads that trace together, the calling one among them; 0 with a host's [`ParallelFor`](crate::ParallelFor).
    pub workers: u32,
    /// Grids, the scene's own among them.
    pub grids: u32,
    /// The instructions that its kernels use.
    pub isa: Isa,
    /// What its traces do without.
    pub left_out: Without,
}

impl SceneReport {
    pub(crate) fn of_raw(raw: sys::rg_scene_report) -> Self {
        let sys::rg_scene_report { size: _, objects, slots, bytes, invalid_rays, workers, grids, isa, left_out } =
            raw;
        let isa = Isa::try_from(isa).unwrap_or_default();
        Self { objects, slots, bytes, invalid_rays, workers, grids, isa, left_out: Without(left_out) }
    }
}

/// What is known of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ObjectReport {
    /// Where it is.
    pub pose: Pose,
    /// Which shape it has: that of this [`Shape::id`](crate::Shape::id).
    pub shape: ShapeId,
    /// Rays see it if their mask shares a bit with this one.
    pub mask: u32,
    /// Where it is stored.
    pub grid: GridId,
    /// The low corner of the world box that holds it.
    pub lo: [f64; 3],
    /// The high corner of the world box that holds it.
    pub hi: [f64; 3],
}

impl ObjectReport {
    pub(crate) fn of_raw(raw: sys::rg_object_report) -> Self {
        let sys::rg_object_report { size: _, pose, shape, mask, grid, lo, hi } = raw;
        let (pose, shape, grid) = (Pose::of_raw(&pose), ShapeId::of_raw(shape), GridId(grid));
        Self { pose, shape, mask, grid, lo, hi }
    }
}

/// What is known of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShapeReport {
    /// What kind of geometry it is.
    pub kind: ShapeKind,
    /// The low corner of the local box that holds it.
    pub lo: [f64; 3],
    /// The high corner of the local box that holds it.
    pub hi: [f64; 3],
    /// Of a mesh: its triangles; else 0.
    pub triangle_count: u64,
    /// Memory that it holds.
    pub bytes: u64,
}

impl ShapeReport {
    pub(crate) fn of_raw(raw: sys::rg_shape_report) -> Self {
        let sys::rg_shape_report { size: _, kind, lo, hi, triangle_count, bytes } = raw;
        Self { kind: ShapeKind::try_from(kind).unwrap_or_default(), lo, hi, triangle_count, bytes }
    }
}
