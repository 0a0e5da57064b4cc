// SPDX-License-Identifier: MIT
#![doc = include_str!("../README.md")]
#![no_std]

#[allow(missing_docs, non_camel_case_types, clippy::all)]
#[rustfmt::skip]
mod bindings;

pub use bindings::*;
