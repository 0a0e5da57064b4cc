// SPDX-License-Identifier: MIT
#![doc = include_str!("../README.md")]

mod enums;
mod error;
mod frame;
mod grid;
mod hit;
mod host;
mod id;
mod mesh;
mod pose;
mod query;
mod ray;
mod replay;
mod report;
mod scene;
mod scene_many;
mod shape;
mod sink;
mod source;
mod user_shape;
pub mod views;

#[cfg(feature = "glam")]
mod with_glam;
#[cfg(feature = "mint")]
mod with_mint;
#[cfg(feature = "rayon")]
mod with_rayon;

pub use enums::{Call, Coherence, Cull, GridKind, Isa, MeshQuality, ShapeKind};
pub use error::{Error, ErrorKind, Result};
pub use frame::Frame;
pub use grid::{GridConfig, GridReport};
pub use hit::{Hit, NO_PRIMITIVE};
pub use host::{Builder, ParallelFor};
pub use id::{GridId, ObjectId};
pub use mesh::{MeshBuilder, MeshData};
pub use pose::Pose;
pub use query::{Query, Traced};
pub use ray::Ray;
pub use replay::{Replay, Step};
pub use report::{ObjectReport, SceneReport, ShapeReport, Without};
pub use scene::Scene;
pub use scene_many::Insert;
pub use shape::{Shape, ShapeId, Shapes};
pub use sink::Sink;
pub use source::Source;
pub use user_shape::{LocalHit, LocalRay, UserShape};

/// No coordinate, length or position may be larger than this in magnitude.
pub const COORDINATE_MAX: f64 = raygrid_sys::RG_COORDINATE_MAX;

/// No radius may be smaller than this.
pub const RADIUS_MIN: f64 = raygrid_sys::RG_RADIUS_MIN;

/// The version of the C library that is running: major, minor, patch.
pub fn version() -> (u32, u32, u32) {
    // SAFETY: takes nothing, may be called by any thread.
    let version = unsafe { raygrid_sys::rg_version() };
    (version / 1_000_000, version / 1000 % 1000, version % 1000)
}

/// A struct of the library that starts with its size. Either all of its fields are given, so that a new one does not
/// compile before it is thought of here; or none, for the library to fill.
macro_rules! sized {
    ($name:ident {}) => {
        raygrid_sys::$name { size: size_of::<raygrid_sys::$name>(), ..Default::default() }
    };
    ($name:ident { $($field:ident: $value:expr),+ $(,)? }) => {
        raygrid_sys::$name { size: size_of::<raygrid_sys::$name>(), $($field: $value),+ }
    };
}
pub(crate) use sized;
