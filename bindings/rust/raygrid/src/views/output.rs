// SPDX-License-Identifier: MIT
//! Views that are written.

use std::marker::PhantomData;

use bytemuck::Pod;
use raygrid_sys as sys;

use super::element::{Element, Flag, Float, Found, Kind, Place, Primitive, Triple, Whole, offset_in};

/// One number a record, written where it lies: to a slice, or to a field of a slice of structs.
#[derive(Debug)]
pub struct ViewMut<'a, K: Kind> {
    place: Place,
    lifetime: PhantomData<&'a mut K::Value>,
}

/// One float a record.
pub type FloatsMut<'a> = ViewMut<'a, Float>;

/// What each ray found.
pub type IdsMut<'a> = ViewMut<'a, Found>;

/// One primitive a record.
pub type PrimitivesMut<'a> = ViewMut<'a, Primitive>;

/// One count a record.
pub type WholesMut<'a> = ViewMut<'a, Whole>;

/// Yes or no for each record.
pub type Flags<'a> = ViewMut<'a, Flag>;

impl<'a, K: Kind> ViewMut<'a, K> {
    /// A field of structs. `field` is asked of the first one only; the others have theirs at the same place.
    ///
    /// # Panics
    /// If what `field` returns is not in the struct that it is handed.
    pub fn field<R: Pod, T: Element<K>>(records: &'a mut [R], field: impl FnOnce(&mut R) -> &mut T) -> Self {
        let offset = match records.first_mut() {
            Some(first) => {
                let record = std::ptr::from_ref(first);
                offset_in(record, field(first))
            }
            None => 0,
        };
        let place = Place {
            stride: size_of::<R>() as isize,
            count: records.len(),
            element: T::TYPE,
            first: records.as_mut_ptr().cast::<u8>().wrapping_add(offset),
        };
        Self { place, lifetime: PhantomData }
    }

    /// The same records, the last first.
    #[must_use]
    pub fn rev(self) -> Self {
        Self { place: self.place.rev(), ..self }
    }

    /// How many records there are.
    pub fn count(&self) -> usize {
        self.place.count
    }

    pub(crate) fn raw(&self) -> sys::rg_output {
        let Place { first, stride, element, .. } = self.place;
        sys::rg_output { data: first.cast(), stride, type_: element }
    }
}

impl<'a, K: Kind, T: Element<K>> From<&'a mut [T]> for ViewMut<'a, K> {
    fn from(values: &'a mut [T]) -> Self {
        let place = Place::packed(values.as_mut_ptr().cast(), size_of::<T>(), values.len(), T::TYPE);
        Self { place, lifetime: PhantomData }
    }
}

impl<'a, K: Kind, T: Element<K>> From<&'a mut Vec<T>> for ViewMut<'a, K> {
    fn from(values: &'a mut Vec<T>) -> Self {
        values.as_mut_slice().into()
    }
}

impl<'a, K: Kind, T: Element<K>, const N: usize> From<&'a mut [T; N]> for ViewMut<'a, K> {
    fn from(values: &'a mut [T; N]) -> Self {
        values.as_mut_slice().into()
    }
}

/// Three numbers a record, written where they lie: to a slice of arrays, three slices, or a field of a slice of structs.
#[derive(Debug)]
pub struct TriplesMut<'a, K: Kind> {
    places: [Place; 3],
    lifetime: PhantomData<&'a mut K::Value>,
}

/// A point or a direction a record.
pub type VectorsMut<'a> = TriplesMut<'a, Float>;

impl<'a, K: Kind> TriplesMut<'a, K> {
    fn each<T: Element<K>>(first: *mut u8, size: usize, count: usize) -> Self {
        let at =
            |component: usize| Place::packed(first.wrapping_add(component * size_of::<T>()), size, count, T::TYPE);
        Self { places: [at(0), at(1), at(2)], lifetime: PhantomData }
    }

    /// Slices of the three components.
    ///
    /// # Panics
    /// If they are not of one length.
    pub fn components<T: Element<K>>(x: &'a mut [T], y: &'a mut [T], z: &'a mut [T]) -> Self {
        assert!(x.len() == y.len() && x.len() == z.len(), "x, y and z must have as many numbers each");
        let place =
            |values: &mut [T]| Place::packed(values.as_mut_ptr().cast(), size_of::<T>(), values.len(), T::TYPE);
        Self { places: [place(x), place(y), place(z)], lifetime: PhantomData }
    }

    /// A field of structs. `field` is asked of the first one only; the others have theirs at the same place.
    ///
    /// # Panics
    /// If what `field` returns is not in the struct that it is handed.
    pub fn field<R: Pod, T: Element<K>>(records: &'a mut [R], field: impl FnOnce(&mut R) -> &mut [T; 3]) -> Self {
        let offset = match records.first_mut() {
            Some(first) => {
                let record = std::ptr::from_ref(first);
                offset_in(record, field(first))
            }
            None => 0,
        };
        Self::each::<T>(records.as_mut_ptr().cast::<u8>().wrapping_add(offset), size_of::<R>(), records.len())
    }

    /// The same records, the last first.
    #[must_use]
    pub fn rev(self) -> Self {
        Self { places: self.places.map(Place::rev), ..self }
    }

    /// How many records there are.
    pub fn count(&self) -> usize {
        self.places[0].count
    }

    pub(crate) fn raw(&self) -> sys::rg_output3 {
        let [x, y, z] = self.places.map(|place| place.first.cast());
        sys::rg_output3 { x, y, z, stride: self.places[0].stride, type_: self.places[0].element }
    }
}

impl<'a, K: Kind, T: Triple<K>> From<&'a mut [T]> for TriplesMut<'a, K> {
    fn from(values: &'a mut [T]) -> Self {
        Self::each::<T::Number>(values.as_mut_ptr().cast(), size_of::<T>(), values.len())
    }
}

impl<'a, K: Kind, T: Triple<K>> From<&'a mut Vec<T>> for TriplesMut<'a, K> {
    fn from(values: &'a mut Vec<T>) -> Self {
        values.as_mut_slice().into()
    }
}

impl<'a, K: Kind, T: Triple<K>, const N: usize> From<&'a mut [T; N]> for TriplesMut<'a, K> {
    fn from(values: &'a mut [T; N]) -> Self {
        values.as_mut_slice().into()
    }
}
