// SPDX-License-Identifier: MIT
//! That views lead where they say: read and written here as the library does, by pointer and stride. Miri runs these.

use raygrid_sys as sys;

use super::*;
use crate::{Hit, ObjectId, Pose, Ray};

/// The record that the library finds at an index.
///
/// # Safety
/// There must be a `T` at that place.
unsafe fn at<T: Copy>(first: *const std::ffi::c_void, stride: isize, index: usize) -> T {
    // SAFETY: the caller's.
    unsafe { first.cast::<u8>().offset(stride * index as isize).cast::<T>().read_unaligned() }
}

fn read<T: Copy>(view: &sys::rg_input, count: usize) -> Vec<T> {
    // SAFETY: only used for views of T with that many records.
    (0..count).map(|i| unsafe { at(view.data, view.stride, i) }).collect()
}

fn read3<T: Copy>(view: &sys::rg_input3, count: usize) -> Vec<[T; 3]> {
    let [x, y, z] = [view.x, view.y, view.z];
    // SAFETY: only used for views of T with that many records.
    (0..count).map(|i| [x, y, z].map(|first| unsafe { at(first, view.stride, i) })).collect()
}

fn write<T>(view: &sys::rg_output, index: usize, value: T) {
    let place = view.data.cast::<u8>().wrapping_offset(view.stride * index as isize);
    // SAFETY: only used for views of T with more records than that.
    unsafe { place.cast::<T>().write_unaligned(value) };
}

#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Agent {
    place: [f32; 3],
    radius: f32,
    id: u64,
    aim: [f64; 3],
}

fn agents() -> Vec<Agent> {
    let agent = |i: u8| {
        let x = f64::from(i);
        Agent { place: [x as f32, 1.0, 2.0], radius: x as f32 / 2.0, id: 7 + u64::from(i), aim: [3.0, x, 4.0] }
    };
    (0..4).map(agent).collect()
}

#[test]
fn slices_fields_and_values_are_read() {
    let radii = [1.0_f32, 2.0, 3.0];
    let view = Floats::from(&radii);
    assert_eq!((view.raw().type_, view.count()), (sys::RG_F32, Some(3)));
    assert_eq!(read::<f32>(&view.raw(), 3), radii);
    assert_eq!(read::<f32>(&view.rev().raw(), 3), [3.0, 2.0, 1.0]);
    let all = Floats::from(5.0);
    assert_eq!((read::<f64>(&all.raw(), 3), all.rev().count()), (vec![5.0; 3], None));

    let agents = agents();
    let view = Floats::field(&agents, |agent| &agent.radius);
    assert_eq!(read::<f32>(&view.raw(), 4), [0.0, 0.5, 1.0, 1.5]);
    assert_eq!(read::<f32>(&view.rev().raw(), 4), [1.5, 1.0, 0.5, 0.0]);
    let places = Vectors::field(&agents, |agent| &agent.place);
    assert_eq!((places.raw().type_, read3::<f32>(&places.raw(), 4)[3]), (sys::RG_F32, [3.0, 1.0, 2.0]));
    let aims = Vectors::field(&agents, |agent| &agent.aim).rev();
    assert_eq!((aims.raw().type_, read3::<f64>(&aims.raw(), 4)[3]), (sys::RG_F64, [3.0, 0.0, 4.0]));
    let (x, y, z) = ([1.0, 2.0], [3.0, 4.0], [5.0, 6.0]);
    assert_eq!(read3::<f64>(&Vectors::components(&x, &y, &z).raw(), 2), [[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]);
    assert_eq!(read3::<f64>(&Vectors::from([1.0, 2.0, 3.0]).raw(), 2), [[1.0, 2.0, 3.0]; 2]);
    let triangles = [[0_u16, 1, 2], [3, 4, 5]];
    let indices = Indices::from(&triangles);
    assert_eq!((indices.raw().type_, read3::<u16>(&indices.raw(), 2)), (sys::RG_U16, triangles.to_vec()));
}

#[test]
fn rays_and_their_reverse() {
    let rays = [Ray::new([1.0, 2.0, 3.0], [0.0, 0.0, 1.0]).from(0.5).mask(3), Ray::between([4.0; 3], [6.0; 3])];
    for (views, order) in [(RayViews::from(&rays[..]), [0, 1]), (RayViews::from(&rays[..]).rev(), [1, 0])] {
        let raw = views.raw();
        assert_eq!(raw.size, size_of::<sys::rg_ray_views>());
        assert_eq!(read3::<f64>(&raw.origin, 2), order.map(|i| rays[i].origin));
        assert_eq!(read3::<f64>(&raw.direction, 2), order.map(|i| rays[i].direction));
        assert_eq!(read::<f64>(&raw.t_min, 2), order.map(|i| rays[i].t_min));
        assert_eq!(read::<f64>(&raw.t_max, 2), order.map(|i| rays[i].t_max));
        assert_eq!(read::<u32>(&raw.mask, 2), order.map(|i| rays[i].mask));
    }
}

#[test]
fn fields_are_written_and_nothing_else() {
    let mut written = agents();
    let id = ObjectId::from_bits(9);
    let mut ids = [None; 4];
    let view = FloatsMut::field(&mut written, |agent| &mut agent.radius).rev();
    for i in 0..4_u8 {
        write(&view.raw(), i.into(), f32::from(i) * 10.0);
    }
    let view = VectorsMut::field(&mut written, |agent| &mut agent.aim);
    let sys::rg_output3 { y, stride, .. } = view.raw();
    write(&sys::rg_output { data: y, stride, type_: sys::RG_F64 }, 2, -1.0_f64);
    write(&IdsMut::from(&mut ids).raw(), 1, 9_u64);
    assert_eq!(ids, [None, id, None, None]);
    for (i, (got, was)) in written.iter().zip(agents()).enumerate() {
        let aim = if i == 2 { [was.aim[0], -1.0, was.aim[2]] } else { was.aim };
        assert_eq!(*got, Agent { radius: (3 - i) as f32 * 10.0, aim, ..was });
    }
}

#[test]
fn empty_slices_have_no_place() {
    let none: [Agent; 0] = [];
    let view = Floats::field(&none, |agent| &agent.radius).rev();
    assert_eq!((view.count(), view.raw().stride), (Some(0), -(size_of::<Agent>() as isize)));
    assert_eq!(Vectors::field(&none, |agent| &agent.aim).count(), Some(0));
}

#[test]
fn counts_agree_or_are_named() {
    let (mut t, mut u, mut v) = ([0.0; 2], [0.0; 2], [0.0; 3]);
    let views = HitViews::new().t(&mut t).u(&mut u).v(&mut v);
    let error = agree(views.counts()).unwrap_err();
    assert_eq!(error.to_string(), "v has 3 records, t has 2");
    assert_eq!(agree([("a", None), ("b", Some(4)), ("c", Some(4))]), Ok(Some(4)));
    assert_eq!(agree([("a", None)]), Ok(None));
}

#[test]
fn parts_of_poses() {
    let places = [[1.0_f32, 2.0, 3.0]; 2];
    let columns = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let poses = Poses::from(Poses::at(&places).columns(columns).scale(4.0));
    let raw = poses.raw().unwrap();
    assert_eq!(read3::<f32>(&raw.position, 2), places);
    assert_eq!(raw.column.map(|column| read3::<f64>(&column, 2)[1]), columns);
    assert_eq!(read::<f64>(&raw.scale, 2), [4.0; 2]);
}

#[test]
fn records_are_laid_out_as_in_c() {
    let pose = Pose::at([1.0, 2.0, 3.0]).linear([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]).scale(0.5);
    // SAFETY: that is what is tested.
    let raw = unsafe { *pose.raw() };
    assert_eq!((raw.position, raw.scale), (pose.position, 0.5));
    assert_eq!(raw.linear, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    assert_eq!(Pose::of_raw(&raw), pose);
    let hit = Hit { t: 1.0, object: ObjectId::from_bits(7), u: 0.25, v: 0.5, primitive: 3, ..Hit::MISS };
    // SAFETY: that is what is tested.
    let raw = unsafe { std::ptr::from_ref(&hit).cast::<sys::rg_hit>().read() };
    assert_eq!((raw.t, raw.object, raw.u, raw.v, raw.primitive), (1.0, 7, 0.25, 0.5, 3));
}
