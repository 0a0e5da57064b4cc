// SPDX-License-Identifier: MIT
//! Views that are read.

use std::ffi::c_void;
use std::marker::PhantomData;

use bytemuck::NoUninit;
use raygrid_sys as sys;

use super::element::{Element, Float, Index, Kind, Mask, Object, Place, Triple, offset_in};

/// A value for all records, or one each.
#[derive(Clone, Copy, Debug)]
enum Given<V, P> {
    All(V),
    Each(P),
}

/// One number a record, read where it lies: from a slice, a field of a slice of structs, or one value for all.
#[derive(Clone, Copy, Debug)]
pub struct View<'a, K: Kind> {
    given: Given<K::Value, Place>,
    lifetime: PhantomData<&'a K::Value>,
}

/// One float a record.
pub type Floats<'a> = View<'a, Float>;

/// One mask a record.
pub type Masks<'a> = View<'a, Mask>;

/// One object a record.
pub type Ids<'a> = View<'a, Object>;

impl<'a, K: Kind> View<'a, K> {
    /// A field of structs. `field` is asked of the first one only; the others have theirs at the same place.
    ///
    /// ```
    /// use raygrid::views::Floats;
    ///
    /// let disks = [[5.0, 1.0], [6.0, 2.0]]; // any type that is bytemuck::NoUninit
    /// let radii = Floats::field(&disks, |disk| &disk[1]);
    /// ```
    ///
    /// # Panics
    /// If what `field` returns is not in the struct that it is handed.
    pub fn field<R: NoUninit, T: Element<K>>(records: &'a [R], field: impl FnOnce(&R) -> &T) -> Self {
        let offset = records.first().map_or(0, |first| offset_in(first, field(first)));
        let place = Place {
            first: records.as_ptr().cast::<u8>().cast_mut().wrapping_add(offset),
            stride: size_of::<R>() as isize,
            count: records.len(),
            element: T::TYPE,
        };
        Self { given: Given::Each(place), lifetime: PhantomData }
    }

    /// The same records, the last first.
    #[must_use]
    pub fn rev(self) -> Self {
        let given = match self.given {
            Given::All(value) => Given::All(value),
            Given::Each(place) => Given::Each(place.rev()),
        };
        Self { given, ..self }
    }

    /// How many records there are; `None`: one value for all.
    pub fn count(&self) -> Option<usize> {
        match self.given {
            Given::All(_) => None,
            Given::Each(place) => Some(place.count),
        }
    }

    /// Holds as long as self is where it is.
    pub(crate) fn raw(&self) -> sys::rg_input {
        match &self.given {
            Given::All(value) => {
                sys::rg_input { data: std::ptr::from_ref(value).cast(), stride: 0, type_: K::Value::TYPE }
            }
            Given::Each(place) => {
                sys::rg_input { data: place.first.cast(), stride: place.stride, type_: place.element }
            }
        }
    }
}

impl<'a, K: Kind, T: Element<K>> From<&'a [T]> for View<'a, K> {
    fn from(values: &'a [T]) -> Self {
        let first = values.as_ptr().cast::<u8>().cast_mut();
        let place = Place::packed(first, size_of::<T>(), values.len(), T::TYPE);
        Self { given: Given::Each(place), lifetime: PhantomData }
    }
}

impl<'a, K: Kind, T: Element<K>> From<&'a Vec<T>> for View<'a, K> {
    fn from(values: &'a Vec<T>) -> Self {
        values.as_slice().into()
    }
}

impl<'a, K: Kind, T: Element<K>, const N: usize> From<&'a [T; N]> for View<'a, K> {
    fn from(values: &'a [T; N]) -> Self {
        values.as_slice().into()
    }
}

/// One value for all records.
macro_rules! one_for_all {
    ($($kind:ty: $value:ty),*) => {
        $(impl From<$value> for View<'_, $kind> {
            fn from(value: $value) -> Self {
                Self { given: Given::All(value), lifetime: PhantomData }
            }
        })*
    };
}
one_for_all!(Float: f64, Mask: u32, Object: crate::ObjectId);

/// Three numbers a record, read where they lie: from a slice of arrays, three slices, a field of a slice of structs, or
/// one value for all.
#[derive(Clone, Copy, Debug)]
pub struct Triples<'a, K: Kind> {
    given: Given<[K::Value; 3], [Place; 3]>,
    lifetime: PhantomData<&'a K::Value>,
}

/// A point or a direction a record.
pub type Vectors<'a> = Triples<'a, Float>;

/// The corners of a triangle a record.
pub type Indices<'a> = Triples<'a, Index>;

impl<'a, K: Kind> Triples<'a, K> {
    fn each<T: Element<K>>(first: *const u8, size: usize, count: usize) -> Self {
        let at = |component: usize| {
            let first = first.cast_mut().wrapping_add(component * size_of::<T>());
            Place::packed(first, size, count, T::TYPE)
        };
        Self { given: Given::Each([at(0), at(1), at(2)]), lifetime: PhantomData }
    }

    /// Slices of the three components.
    ///
    /// # Panics
    /// If they are not of one length.
    pub fn components<T: Element<K>>(x: &'a [T], y: &'a [T], z: &'a [T]) -> Self {
        assert!(x.len() == y.len() && x.len() == z.len(), "x, y and z must have as many numbers each");
        let place = |values: &[T]| {
            Place::packed(values.as_ptr().cast::<u8>().cast_mut(), size_of::<T>(), values.len(), T::TYPE)
        };
        Self { given: Given::Each([place(x), place(y), place(z)]), lifetime: PhantomData }
    }

    /// A field of structs. `field` is asked of the first one only; the others have theirs at the same place.
    ///
    /// # Panics
    /// If what `field` returns is not in the struct that it is handed.
    pub fn field<R: NoUninit, T: Element<K>>(records: &'a [R], field: impl FnOnce(&R) -> &[T; 3]) -> Self {
        let offset = records.first().map_or(0, |first| offset_in(first, field(first)));
        let first = records.as_ptr().cast::<u8>().wrapping_add(offset);
        Self::each::<T>(first, size_of::<R>(), records.len())
    }

    /// The same records, the last first.
    #[must_use]
    pub fn rev(self) -> Self {
        let given = match self.given {
            Given::All(value) => Given::All(value),
            Given::Each(places) => Given::Each(places.map(Place::rev)),
        };
        Self { given, ..self }
    }

    /// How many records there are; `None`: one value for all.
    pub fn count(&self) -> Option<usize> {
        match self.given {
            Given::All(_) => None,
            Given::Each([x, ..]) => Some(x.count),
        }
    }

    /// Holds as long as self is where it is.
    pub(crate) fn raw(&self) -> sys::rg_input3 {
        match &self.given {
            Given::All([x, y, z]) => {
                let [x, y, z] = [x, y, z].map(|one| std::ptr::from_ref(one).cast::<c_void>());
                sys::rg_input3 { x, y, z, stride: 0, type_: K::Value::TYPE }
            }
            Given::Each(places) => {
                let [x, y, z] = places.map(|place| place.first.cast_const().cast::<c_void>());
                sys::rg_input3 { x, y, z, stride: places[0].stride, type_: places[0].element }
            }
        }
    }
}

impl<'a, K: Kind, T: Triple<K>> From<&'a [T]> for Triples<'a, K> {
    fn from(values: &'a [T]) -> Self {
        Self::each::<T::Number>(values.as_ptr().cast(), size_of::<T>(), values.len())
    }
}

impl<'a, K: Kind, T: Triple<K>> From<&'a Vec<T>> for Triples<'a, K> {
    fn from(values: &'a Vec<T>) -> Self {
        values.as_slice().into()
    }
}

impl<'a, K: Kind, T: Triple<K>, const N: usize> From<&'a [T; N]> for Triples<'a, K> {
    fn from(values: &'a [T; N]) -> Self {
        values.as_slice().into()
    }
}

impl From<[f64; 3]> for Vectors<'_> {
    fn from(value: [f64; 3]) -> Self {
        Self { given: Given::All(value), lifetime: PhantomData }
    }
}
