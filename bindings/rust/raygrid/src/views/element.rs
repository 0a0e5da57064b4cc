// SPDX-License-Identifier: MIT
//! What the records of a view may be.

use bytemuck::NoUninit;
use raygrid_sys as sys;

use crate::ObjectId;

pub(crate) mod sealed {
    /// Only types that the library knows.
    pub trait Sealed {}
}

/// What the numbers of a view mean, with the value that all records may share.
pub trait Kind: sealed::Sealed {
    /// One such number.
    type Value: Copy + Element<Self>;
}

/// A type that numbers of this kind may be read from or written to: one of `raygrid.h`'s.
pub trait Element<K: ?Sized>: sealed::Sealed + NoUninit {
    #[doc(hidden)]
    const TYPE: sys::rg_type;
}

/// Three numbers of this kind: an array, or a vector of another crate.
///
/// # Safety
/// It starts with three `Number`s one after another, which may be any bits.
pub unsafe trait Triple<K: ?Sized>: sealed::Sealed {
    #[doc(hidden)]
    type Number: Element<K>;
}

impl<T: sealed::Sealed> sealed::Sealed for [T; 3] {}
// SAFETY: that is what an array is.
unsafe impl<K: Kind, T: Element<K>> Triple<K> for [T; 3] {
    type Number = T;
}

/// A kind of numbers, and the types that they may have.
macro_rules! kind {
    ($(#[$doc:meta])* $name:ident: $value:ty, $($element:ty = $constant:ident),*) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub enum $name {}
        impl sealed::Sealed for $name {}
        impl Kind for $name {
            type Value = $value;
        }
        $(impl Element<$name> for $element {
            const TYPE: sys::rg_type = sys::$constant;
        })*
    };
}

kind! {
    /// Real numbers: `f64` or `f32`.
    Float: f64, f64 = RG_F64, f32 = RG_F32
}
kind! {
    /// Masks: `u32`.
    Mask: u32, u32 = RG_U32
}
kind! {
    /// Objects: [`ObjectId`].
    Object: ObjectId, ObjectId = RG_U64
}
kind! {
    /// Numbers of vertices: `u16`, `u32` or `u64`.
    Index: u64, u16 = RG_U16, u32 = RG_U32, u64 = RG_U64
}
kind! {
    /// What rays found: `Option<ObjectId>`.
    Found: Option<ObjectId>, Option<ObjectId> = RG_U64
}
kind! {
    /// Numbers of primitives: `u32` or `u64`.
    Primitive: u64, u32 = RG_U32, u64 = RG_U64
}
kind! {
    /// Counts: `u32`.
    Whole: u32, u32 = RG_U32
}
kind! {
    /// Yes or no: `bool` or `u8`.
    Flag: bool, bool = RG_U8, u8 = RG_U8
}

impl sealed::Sealed for f64 {}
impl sealed::Sealed for f32 {}
impl sealed::Sealed for u8 {}
impl sealed::Sealed for u16 {}
impl sealed::Sealed for u32 {}
impl sealed::Sealed for u64 {}
impl sealed::Sealed for bool {}
impl sealed::Sealed for ObjectId {}
impl sealed::Sealed for Option<ObjectId> {}

/// Where a field of many records lies: the first, and bytes from one to the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) first: *mut u8,
    pub(crate) stride: isize,
    pub(crate) count: usize,
    pub(crate) element: sys::rg_type,
}

impl Place {
    /// Records one after another, each of `size` bytes.
    pub(crate) fn packed(first: *mut u8, size: usize, count: usize, element: sys::rg_type) -> Self {
        Self { first, stride: size as isize, count, element }
    }

    /// The same records, the last first.
    pub(crate) fn rev(self) -> Self {
        let last = self.count.saturating_sub(1);
        // The last record is in the same slice as the first.
        let first = self.first.wrapping_offset(self.stride * last as isize);
        Self { first, stride: -self.stride, ..self }
    }
}

/// How many bytes into a record its field lies.
///
/// # Panics
/// If it does not lie in the record at all.
pub(crate) fn offset_in<R, F>(record: *const R, field: *const F) -> usize {
    let offset = field.addr().wrapping_sub(record.addr());
    assert!(
        offset <= size_of::<R>() && size_of::<F>() <= size_of::<R>() - offset,
        "a field must lie in the record that it is asked of"
    );
    offset
}
