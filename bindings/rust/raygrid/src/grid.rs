// SPDX-License-Identifier: MIT
//! Grids: where a scene keeps its objects. A scene has one from the start, and nobody needs to know of it.

use raygrid_sys as sys;

use crate::{GridKind, sized};

/// How a grid is made. What is not said is chosen by the library, from the objects.
///
/// ```
/// use raygrid::{GridConfig, GridKind, Scene};
///
/// let scene = Scene::builder().grid(GridConfig::new(GridKind::Uniform).resolution(64)).build()?;
/// # Ok::<(), raygrid::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct GridConfig {
    kind: GridKind,
    resolution: u32,
    lo: [f64; 3],
    hi: [f64; 3],
    rebuild_factor: f64,
}

impl GridConfig {
    /// A grid of this kind; all else automatic.
    pub fn new(kind: GridKind) -> Self {
        Self { kind, ..Self::default() }
    }

    /// Cells along the longest side of the physical box, at the finest level; 0: from the number of objects.
    #[must_use]
    pub fn resolution(self, resolution: u32) -> Self {
        Self { resolution, ..self }
    }

    /// The corners of the first physical box.
    #[must_use]
    pub fn bounds(self, lo: impl Into<[f64; 3]>, hi: impl Into<[f64; 3]>) -> Self {
        Self { lo: lo.into(), hi: hi.into(), ..self }
    }

    /// Rebuild when the logical diagonal exceeds the physical one by this factor, at least 1; 0: by 2.
    #[must_use]
    pub fn rebuild_factor(self, rebuild_factor: f64) -> Self {
        Self { rebuild_factor, ..self }
    }

    /// Never rebuild by itself.
    #[must_use]
    pub fn rebuild_never(self) -> Self {
        self.rebuild_factor(sys::RG_REBUILD_NEVER)
    }

    pub(crate) fn raw(&self) -> sys::rg_grid_config {
        sized!(rg_grid_config {
            kind: self.kind as i32,
            resolution: self.resolution,
            lo: self.lo,
            hi: self.hi,
            rebuild_factor: self.rebuild_factor,
        })
    }
}

/// What is known of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GridReport {
    /// Never [`GridKind::Default`]: the kind that it stands for.
    pub kind: GridKind,
    /// Levels of cells; 0 while there is no physical box yet.
    pub levels: u32,
    /// Bit l set: level l, counted from the finest, holds objects.
    pub levels_used: u32,
    /// Cells of the finest level along each axis.
    pub resolution: [u32; 3],
    /// The low corner of where the cells are; zero while there is none.
    pub physical_lo: [f64; 3],
    /// The high corner of where the cells are; zero while there is none.
    pub physical_hi: [f64; 3],
    /// The low corner of what holds all finite objects; above `logical_hi` while there are none.
    pub logical_lo: [f64; 3],
    /// The high corner of what holds all finite objects.
    pub logical_hi: [f64; 3],
    /// Objects in this grid.
    pub objects: u64,
    /// Places in cells that they take, all together.
    pub entries: u64,
    /// Objects that no cell can hold, tested for every ray.
    pub unbounded: u64,
    /// Tiles of the physical box that hold something; 1 if nothing left it.
    pub tiles: u64,
    /// How often it was rebuilt.
    pub rebuilds: u64,
    /// From when another is begun beside it until the memory of the old one is freed.
    pub rebuilding: bool,
}

impl GridReport {
    pub(crate) fn of_raw(raw: sys::rg_grid_report) -> Self {
        let sys::rg_grid_report {
            size: _,
            kind,
            levels,
            levels_used,
            resolution,
            physical_lo,
            physical_hi,
            logical_lo,
            logical_hi,
            objects,
            entries,
            unbounded,
            tiles,
            rebuilds,
            rebuilding,
            reserved: _,
        } = raw;
        Self {
            kind: GridKind::try_from(kind).unwrap_or_default(),
            levels,
            levels_used,
            resolution,
            physical_lo,
            physical_hi,
            logical_lo,
            logical_hi,
            objects,
            entries,
            unbounded,
            tiles,
            rebuilds,
            rebuilding: rebuilding != 0,
        }
    }
}
