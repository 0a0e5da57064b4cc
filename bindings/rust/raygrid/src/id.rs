// SPDX-License-Identifier: MIT
//! Names of objects and grids, by value.

use std::fmt;
use std::num::NonZeroU64;

use bytemuck::{NoUninit, PodInOption, ZeroableInOption};

/// An object of a scene.
///
/// It is a plain number that outlives the object: the scene refuses the ids of removed objects, and never gives an id
/// out again. `Option<ObjectId>` takes no more room and is what hits hold. Ids belong to their scene; another scene may
/// have given the same number to an object of its own.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct ObjectId(NonZeroU64);

impl ObjectId {
    /// The id with these bits: `None` for 0, which no object has.
    pub const fn from_bits(bits: u64) -> Option<Self> {
        match NonZeroU64::new(bits) {
            Some(bits) => Some(Self(bits)),
            None => None,
        }
    }

    /// The number that it is in C.
    pub const fn to_bits(self) -> u64 {
        self.0.get()
    }

    /// A small number that is used again after a remove: an index for arrays with a place for each object, smaller
    /// than the largest number of objects that the scene ever held.
    pub const fn slot(self) -> u32 {
        self.0.get() as u32
    }

    /// How many objects have had this slot, this one among them.
    pub const fn generation(self) -> u32 {
        (self.0.get() >> 32) as u32
    }
}

impl fmt::Debug for ObjectId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ObjectId({:#x})", self.0)
    }
}

// SAFETY: a NonZeroU64 and nothing else; all its bytes are initialised.
unsafe impl NoUninit for ObjectId {}
// SAFETY: an Option of a transparent NonZeroU64 is a u64, and None is 0.
unsafe impl ZeroableInOption for ObjectId {}
// SAFETY: an Option of a transparent NonZeroU64 is a u64: any bits are a value, and there is no padding.
unsafe impl PodInOption for ObjectId {}

/// A grid of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct GridId(pub(crate) u32);

impl GridId {
    /// The grid that a scene has from the start.
    pub const OF_SCENE: Self = Self(raygrid_sys::RG_GRID_OF_SCENE);
}

impl Default for GridId {
    fn default() -> Self {
        Self::OF_SCENE
    }
}
