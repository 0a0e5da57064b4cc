// SPDX-License-Identifier: MIT
//! The scene: equal spheres at random in a unit cube, of which they fill 5 %; rays of random origin and direction.
//!
//! All coordinates are floats, since that is what the peers compute with.

use raygrid::Ray;

/// Numbers that look random: splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 24) as f32
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    pub fn point(&mut self) -> [f32; 3] {
        [self.unit(), self.unit(), self.unit()]
    }

    /// On the unit sphere.
    pub fn direction(&mut self) -> [f32; 3] {
        loop {
            let way = self.point().map(|x| 2.0 * x - 1.0);
            let length = way.iter().map(|x| x * x).sum::<f32>().sqrt();
            if length > 0.1 && length <= 1.0 {
                return way.map(|x| x / length);
            }
        }
    }
}

pub struct World {
    pub centres: Vec<[f32; 3]>,
    pub radius: f32,
    random: Random,
}

impl World {
    pub fn new(count: usize) -> Self {
        let mut random = Random(count as u64);
        let radius = (0.05 / (count as f32 * 4.0 / 3.0 * std::f32::consts::PI)).cbrt();
        Self { centres: (0..count).map(|_| random.point()).collect(), radius, random }
    }

    /// Moves a share of the spheres by up to a radius along each axis, and says which, each once.
    pub fn step(&mut self, share: f64) -> Vec<usize> {
        let count = self.centres.len();
        let wanted = (count as f64 * share) as usize;
        let first = self.random.below(count);
        // Spheres are in random places, so a stretch of the list is a random choice of them.
        let moved: Vec<usize> = (first..first + wanted).map(|i| i % count).collect();
        for &one in &moved {
            for axis in 0..3 {
                let x = self.centres[one][axis] + self.radius * (2.0 * self.random.unit() - 1.0);
                self.centres[one][axis] = x.clamp(0.0, 1.0);
            }
        }
        moved
    }

    pub fn rays(&mut self, count: usize) -> Vec<Ray> {
        let mut one = || {
            let (origin, way) = (self.random.point(), self.random.direction());
            Ray::new(origin.map(f64::from), way.map(f64::from))
        };
        (0..count).map(|_| one()).collect()
    }

    /// The closest hit in doubles, by trying all: t and the sphere; and whether a float may see another one: the ray
    /// passes a silhouette or starts on a surface within a hundred-thousandth of a radius or of the distance.
    pub fn brute(&self, ray: &Ray) -> (Option<(f64, usize)>, bool) {
        let (mut best, mut sure) = (None, true);
        for (i, centre) in self.centres.iter().enumerate() {
            let radius = f64::from(self.radius);
            let to: [f64; 3] = std::array::from_fn(|axis| f64::from(centre[axis]) - ray.origin[axis]);
            let dd: f64 = ray.direction.iter().map(|x| x * x).sum();
            let middle = to.iter().zip(ray.direction).map(|(a, b)| a * b).sum::<f64>() / dd;
            let foot: f64 = (0..3).map(|axis| (to[axis] - middle * ray.direction[axis]).powi(2)).sum();
            let margin = 1e-5 * (radius + middle.abs()) * radius;
            if foot > radius * radius + margin {
                continue;
            }
            let half = ((radius * radius - foot).max(0.0) / dd).sqrt();
            let t = if middle - half >= 0.0 { middle - half } else { middle + half };
            if t >= -margin && best.is_none_or(|(other, _)| t < other) {
                sure = foot < radius * radius - margin && t.abs() > margin / radius;
                best = Some((t, i));
            }
        }
        (best, sure)
    }
}

/// The unit of all peers that leave the test of a sphere to their user: the closest-point form (Haines et al., Ray
/// Tracing Gems, chapter 7), in floats; infinity for a miss. Direction of length 1.
#[inline]
pub fn sphere_hit(origin: [f32; 3], direction: [f32; 3], centre: [f32; 3], radius: f32) -> f32 {
    let to = [centre[0] - origin[0], centre[1] - origin[1], centre[2] - origin[2]];
    let middle = to[0] * direction[0] + to[1] * direction[1] + to[2] * direction[2];
    let foot: f32 = (0..3).map(|axis| (to[axis] - middle * direction[axis]).powi(2)).sum();
    let below = radius * radius - foot;
    if below < 0.0 {
        return f32::INFINITY;
    }
    let half = below.sqrt();
    let t = if middle - half >= 0.0 { middle - half } else { middle + half };
    if t >= 0.0 { t } else { f32::INFINITY }
}
