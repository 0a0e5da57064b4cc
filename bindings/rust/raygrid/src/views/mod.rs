// SPDX-License-Identifier: MIT
//! Arrays, used where they lie: nothing is copied, whatever their types and strides.
//!
//! A view says where a field of many records is. Slices turn into views by themselves: of floats, of `[f64; 3]`, of
//! `[f32; 3]`; `field` makes one of a field of a slice of structs, `rev` turns it round. A plain value is a view, too:
//! all records have that same value then.
//!
//! ```
//! use raygrid::views::{FloatsMut, HitViews, RayViews};
//! use raygrid::{Scene, Shape};
//!
//! let scene = Scene::new()?;
//! scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
//!
//! let directions: [[f32; 3]; 2] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
//! let mut t = [0.0_f32; 2];
//! scene.query().trace_views(RayViews::new([0.0; 3], &directions), HitViews::new().t(&mut t))?;
//! assert_eq!(t, [4.0, f32::INFINITY]);
//! # Ok::<(), raygrid::Error>(())
//! ```
//!
//! All views of a call must have as many records; where they do not, the call fails and names them.

mod element;
mod input;
mod output;
mod records;
#[cfg(test)]
mod tests;

pub use element::{Element, Flag, Float, Found, Index, Kind, Mask, Object, Primitive, Triple, Whole};
pub use input::{Floats, Ids, Indices, Masks, Triples, Vectors, View};
pub use output::{Flags, FloatsMut, IdsMut, PrimitivesMut, TriplesMut, VectorsMut, ViewMut, WholesMut};
pub use records::{HitViews, PoseViews, Poses, RayViews};

#[cfg(any(feature = "glam", feature = "mint"))]
pub(crate) use element::sealed::Sealed;
pub(crate) use records::agree;
