// SPDX-License-Identifier: MIT
//! rayon's threads in place of a scene's workers.

use rayon::prelude::*;

use crate::{Builder, ParallelFor};

impl Builder {
    /// The threads of rayon's pool in place of workers: of the one that a call comes from, else of the global one.
    ///
    /// ```
    /// use raygrid::Scene;
    ///
    /// let scene = Scene::builder().rayon().build()?;
    /// assert_eq!(scene.stats()?.workers, 0);
    /// # Ok::<(), raygrid::Error>(())
    /// ```
    pub fn rayon(self) -> Self {
        self.parallel_for(Rayon)
    }
}

struct Rayon;

impl ParallelFor for Rayon {
    /// A thread of rayon that waits here takes other jobs meanwhile. They may trace and change the scene: it is held by
    /// the pieces while they are done, not between them.
    fn run(&self, count: u64, work: &(dyn Fn() + Sync)) {
        (0..count).into_par_iter().for_each(|_| work());
    }
}
