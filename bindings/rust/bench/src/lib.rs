// SPDX-License-Identifier: MIT
//! What the program `raygrid-bench` and the benchmark `calls` share.

pub mod clock;
pub mod engines;
pub mod world;
