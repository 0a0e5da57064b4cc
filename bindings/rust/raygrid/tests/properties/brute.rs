// SPDX-License-Identifier: MIT
//! Brute force: the closest hit of a ray among posed spheres, boxes and triangles, and how sure it is.
//!
//! All is done in the shape's own frame, where a posed object is its plain shape and t stays what it is.

use raygrid::{Pose, Ray};

/// Rays that pass a silhouette or an edge of the answer by less than this, relative to the shape, are not judged.
const MARGIN: f64 = 1e-9;

/// A shape in its own frame.
#[derive(Clone, Debug)]
pub enum Plain {
    /// Of radius 1.
    Sphere,
    Box([f64; 3], [f64; 3]),
    Triangles(Vec<[[f64; 3]; 3]>),
}

/// A ray's hit, and whether it is sure.
pub struct Found {
    pub t: f64,
    pub sure: bool,
}

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: V, b: V) -> V {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The ray in the frame of what is posed, by Cramer's rule.
fn to_local(pose: &Pose, ray: &Ray) -> (V, V) {
    let column = |j: usize| -> V { std::array::from_fn(|i| pose.scale * f64::from(pose.linear[i][j])) };
    let [x, y, z] = [column(0), column(1), column(2)];
    let determinant = dot(x, cross(y, z));
    let solve = |w: V| [dot(w, cross(y, z)), dot(x, cross(w, z)), dot(x, cross(y, w))].map(|part| part / determinant);
    (solve(minus(ray.origin, pose.position)), solve(ray.direction))
}

/// The nearer of two crossings that is not behind the ray; both are given as far as they are there.
fn first(near: f64, far: f64, there: bool, sure: bool) -> Found {
    let t = if near >= 0.0 { near } else { far };
    let clear = near.abs().min(far.abs()) > MARGIN;
    Found { t: if there && t >= 0.0 { t } else { f64::INFINITY }, sure: sure && (!there || clear) }
}

fn sphere(o: V, d: V) -> Found {
    let dd = dot(d, d);
    let middle = -dot(o, d) / dd;
    let foot: V = std::array::from_fn(|axis| o[axis] + middle * d[axis]);
    let below = 1.0 - dot(foot, foot);
    let half = (below.max(0.0) / dd).sqrt();
    first(middle - half, middle + half, below >= 0.0, below.abs() > MARGIN)
}

fn slabs(o: V, d: V, lo: V, hi: V) -> Found {
    let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (a, b) = ((lo[axis] - o[axis]) / d[axis], (hi[axis] - o[axis]) / d[axis]);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    let gap = (far - near).abs() > MARGIN * (1.0 + near.abs() + far.abs());
    first(near, far, near <= far, gap && near.is_finite() && far.is_finite())
}

/// Möller and Trumbore's test.
fn triangle(o: V, d: V, [a, b, c]: [V; 3]) -> Found {
    let (e, f) = (minus(b, a), minus(c, a));
    let p = cross(d, f);
    let determinant = dot(p, e);
    let size = (dot(d, d) * dot(e, e) * dot(f, f)).sqrt();
    if determinant.abs() <= 1e-6 * size {
        return Found { t: f64::INFINITY, sure: false };
    }
    let s = minus(o, a);
    let q = cross(s, e);
    let (u, v, t) = (dot(s, p) / determinant, dot(d, q) / determinant, dot(f, q) / determinant);
    let least = u.min(v).min(1.0 - u - v);
    let t = if least >= 0.0 && t >= 0.0 { t } else { f64::INFINITY };
    Found { t, sure: least < -1e-6 || (least > 1e-6 && (t.is_infinite() || t > MARGIN)) }
}

/// The hit of one posed object.
pub fn hit(plain: &Plain, pose: &Pose, ray: &Ray) -> Found {
    let (o, d) = to_local(pose, ray);
    match plain {
        Plain::Sphere => sphere(o, d),
        Plain::Box(lo, hi) => slabs(o, d, *lo, *hi),
        Plain::Triangles(triangles) => {
            let mut best = Found { t: f64::INFINITY, sure: true };
            for one in triangles {
                let found = triangle(o, d, *one);
                best.sure &= found.sure;
                best.t = best.t.min(found.t);
            }
            best
        }
    }
}
