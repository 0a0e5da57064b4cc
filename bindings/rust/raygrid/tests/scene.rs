// SPDX-License-Identifier: MIT
//! What is not in the conformance suite: how the interface reads in Rust, and that it keeps its word.

use std::collections::HashSet;
use std::error::Error as _;

use raygrid::views::{Floats, FloatsMut, HitViews, Ids, Poses, RayViews, Vectors, VectorsMut};
use raygrid::{
    Cull, ErrorKind, GridConfig, GridId, GridKind, Hit, Insert, MeshQuality, ObjectId, Pose, Ray, Result, Scene,
    Shape, Without,
};

const ALONG_Z: [f64; 3] = [0.0, 0.0, 1.0];

fn t_of(scene: &Scene, x: f64) -> Result<Option<f64>> {
    Ok(scene.trace(&Ray::new([x, 0.0, 0.0], ALONG_Z))?.map(|hit| hit.t))
}

#[test]
fn errors_name_what_was_wrong() -> Result<()> {
    let scene = Scene::new()?;
    let ball = scene.insert(&Shape::sphere(1.0)?, [0.0; 3])?;
    scene.remove(ball)?;
    let error = scene.move_to(ball, [1.0, 2.0, 3.0]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidId);
    assert!(error.message().contains(&format!("{:x}", ball.to_bits())), "{error}");
    assert_eq!(format!("{error:?}"), format!("InvalidId: {error}"));
    assert!(error.source().is_none());
    let error = scene.insert(&Shape::sphere(1.0)?, [0.0, f64::NAN, 0.0]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidValue);
    assert_eq!(Scene::builder().workers(5000).build().unwrap_err().kind(), ErrorKind::InvalidValue);
    assert_eq!(Shape::triangles(&[[0.0_f32; 3]; 4]).unwrap_err().kind(), ErrorKind::InvalidArgument);
    assert_eq!(scene.destroy_grid(GridId::OF_SCENE).unwrap_err().kind(), ErrorKind::Busy);
    Ok(())
}

#[test]
fn counts_that_differ_are_refused_by_name() -> Result<()> {
    let scene = Scene::new()?;
    let ball = Shape::sphere(1.0)?;
    let ids = scene.insert_many(&ball, &[[0.0; 3]; 3])?;
    let rays = [Ray::new([0.0; 3], ALONG_Z); 2];
    let said = |error: raygrid::Error| {
        assert_eq!(error.kind(), ErrorKind::InvalidArgument);
        error.to_string()
    };
    let error = scene.trace_many(&rays, &mut [Hit::MISS; 3]).unwrap_err();
    assert_eq!(said(error), "hits has 3 records, rays has 2");
    let error = scene.occluded_many(&rays, &mut [false; 1]).unwrap_err();
    assert_eq!(said(error), "occluded has 1 records, rays has 2");
    let error = scene.move_many(&ids, &[[0.0_f32; 3]; 2]).unwrap_err();
    assert_eq!(said(error), "position has 2 records, objects has 3");
    let error = scene.insert_many(&[ball][..], &[[0.0; 3]; 2]).unwrap_err();
    assert_eq!(said(error), "shapes has 1 records, position has 2");
    let (mut t, mut u) = ([0.0; 2], [0.0; 4]);
    let views = HitViews::new().t(&mut t).u(&mut u);
    let error = scene.query().trace_views(RayViews::new([0.0; 3], &[ALONG_Z; 2]), views).unwrap_err();
    assert_eq!(said(error), "u has 4 records, direction has 2");
    Ok(())
}

#[test]
fn ids_are_plain_values() -> Result<()> {
    let scene = Scene::new()?;
    let ball = Shape::sphere(1.0)?;
    let ids = scene.insert_many(&ball, &[[0.0; 3]; 4])?;
    assert_eq!(ids.iter().collect::<HashSet<_>>().len(), 4);
    assert_eq!(size_of::<Option<ObjectId>>(), 8);
    scene.remove(ids[2])?;
    let again = scene.insert(&ball, [0.0; 3])?;
    assert_eq!((again.slot(), again.generation()), (ids[2].slot(), ids[2].generation() + 1));
    assert_eq!(ObjectId::from_bits(again.to_bits()), Some(again));
    assert_eq!(ObjectId::from_bits(0), None);
    assert!(scene.lookup(ids[2]).is_err() && scene.lookup(again).is_ok());
    Ok(())
}

#[test]
fn a_call_on_many_does_all_or_nothing() -> Result<()> {
    let scene = Scene::new()?;
    let ids = scene.insert_many(&Shape::sphere(1.0)?, &[[0.0, 0.0, 5.0], [9.0, 0.0, 5.0]])?;
    assert!(scene.move_many(&ids, &[[0.0, 0.0, 7.0], [f64::NAN, 0.0, 0.0]]).is_err());
    assert_eq!(t_of(&scene, 0.0)?, Some(4.0));
    assert!(scene.remove_many(&[ids[0], ids[0]]).is_err());
    assert_eq!(scene.stats()?.objects, 2);
    scene.remove_many(&ids)?;
    assert_eq!(scene.stats()?.objects, 0);
    Ok(())
}

#[test]
fn poses_by_records_by_views_and_for_all() -> Result<()> {
    let scene = Scene::new()?;
    let brick = Shape::box_between([-1.0; 3], [1.0; 3])?;
    let tall = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 4.0]];
    let records = vec![Pose::at([0.0, 0.0, 5.0]).linear(tall), Pose::at([9.0, 0.0, 5.0]).scale(2.0)];
    let ids = scene.insert_many(&brick, &records)?;
    assert_eq!((t_of(&scene, 0.0)?, t_of(&scene, 9.0)?), (Some(1.0), Some(3.0)));
    assert_eq!(scene.lookup(ids[0])?.pose, records[0]);
    assert_eq!(scene.lookup(ids[1])?.pose, records[1]);

    scene.move_many(&ids, &[[0.0_f32, 0.0, 6.0], [9.0, 0.0, 6.0]])?;
    assert_eq!(scene.lookup(ids[0])?.pose.linear, tall, "kept");
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 1.0]];
    scene.move_many(&ids, Poses::at([0.0, 0.0, 8.0]).columns(columns).scale(1.0))?;
    for id in &ids {
        let pose = scene.lookup(*id)?.pose;
        assert_eq!((pose.position, pose.scale), ([0.0, 0.0, 8.0], 1.0));
        assert_eq!(pose.linear, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]], "by rows");
    }
    scene.move_pose(ids[0], Pose::default())?;
    assert_eq!(scene.lookup(ids[0])?.pose, Pose::at([0.0; 3]));
    Ok(())
}

#[test]
fn masks_and_grids() -> Result<()> {
    let scene = Scene::builder().grid(GridConfig::new(GridKind::Hierarchical)).build()?;
    let ball = Shape::sphere(1.0)?;
    let still = scene.create_grid(&GridConfig::new(GridKind::Uniform).resolution(8))?;
    let what = Insert::new(&ball, &[[0.0, 0.0, 5.0], [0.0, 0.0, 9.0]]).mask(&[1, 2]).grid(still);
    let ids = scene.insert_all(what)?;
    assert_eq!(scene.grid_stats(still)?.kind, GridKind::Uniform);
    assert_eq!(scene.grid_stats(GridId::OF_SCENE)?.kind, GridKind::Hierarchical);
    let ray = Ray::new([0.0; 3], ALONG_Z);
    assert_eq!(scene.trace(&ray.mask(2))?.map(|hit| hit.t), Some(8.0));
    assert!(scene.trace(&ray.mask(4))?.is_none());
    scene.set_mask(ids[0], 4)?;
    assert_eq!(scene.trace(&ray.mask(4))?.and_then(|hit| hit.object), Some(ids[0]));
    assert!(!scene.stats()?.left_out.contains(Without::MASKS));
    let report = scene.lookup(ids[0])?;
    assert_eq!((report.grid, report.shape, report.mask), (still, ball.clone().id(), 4));
    assert_ne!(report.shape, Shape::sphere(1.0)?.id());
    assert_eq!(scene.shape_of(ids[0])?.id(), ball.id());
    for (axis, middle) in [0.0, 0.0, 5.0].into_iter().enumerate() {
        let (below, above) = (middle - 1.0 - report.lo[axis], report.hi[axis] - middle - 1.0);
        assert!((0.0..1e-12).contains(&below) && (0.0..1e-12).contains(&above), "{below} {above}");
    }
    assert_eq!(scene.destroy_grid(still).unwrap_err().kind(), ErrorKind::Busy);
    scene.remove_many(&ids)?;
    scene.destroy_grid(still)?;
    assert_eq!(scene.grid_stats(still).unwrap_err().kind(), ErrorKind::InvalidId);
    Ok(())
}

/// What a game has of each of its agents.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Agent {
    position: [f32; 3],
    radius: f32,
    seen_at: [f64; 3],
    id: Option<ObjectId>,
    distance: f64,
}

#[test]
fn fields_of_structs_are_used_where_they_lie() -> Result<()> {
    let scene = Scene::new()?;
    let mut agents = [<Agent as bytemuck::Zeroable>::zeroed(); 5];
    for (i, agent) in agents.iter_mut().enumerate() {
        agent.position = [10.0 * i as f32, 0.0, 5.0];
        agent.radius = 1.0 + i as f32 / 4.0;
    }
    let positions = Vectors::field(&agents, |agent| &agent.position);
    let poses = Poses::at(positions).scale(Floats::field(&agents, |agent| &agent.radius));
    let ids = scene.insert_many(&Shape::sphere(1.0)?, poses)?;
    let origins: Vec<[f64; 3]> = (0..5).map(|i| [10.0 * f64::from(i), 0.0, 0.0]).collect();
    let mut object = [None; 5];
    let (mut seen, mut distance) = (agents, agents);
    let hits = HitViews::new()
        .object(&mut object)
        .position(VectorsMut::field(&mut seen, |agent| &mut agent.seen_at))
        .t(FloatsMut::field(&mut distance, |agent| &mut agent.distance));
    scene.query().trace_views(RayViews::new(&origins, ALONG_Z), hits)?;
    for (i, id) in ids.iter().enumerate() {
        let near = 4.0 - i as f64 / 4.0;
        assert_eq!((object[i], distance[i].distance), (Some(*id), near));
        assert_eq!(seen[i].seen_at, [10.0 * i as f64, 0.0, near]);
        assert_eq!((seen[i].id, seen[i].position, distance[i].seen_at), (None, agents[i].position, [0.0; 3]));
    }
    #[derive(Clone, Copy, bytemuck::NoUninit)]
    #[repr(C)]
    struct Owner {
        place: [f64; 3],
        id: ObjectId,
    }
    let owners: Vec<Owner> = ids.iter().map(|id| Owner { place: [0.0, 0.0, 7.0], id: *id }).collect();
    scene.move_many(Ids::field(&owners, |owner| &owner.id), Vectors::field(&owners, |owner| &owner.place))?;
    assert_eq!(t_of(&scene, 0.0)?, Some(5.0), "the largest of all at one place");
    Ok(())
}

#[test]
#[should_panic(expected = "in the record")]
fn a_field_of_something_else_is_refused() {
    static ELSEWHERE: [f64; 3] = [0.0; 3];
    let records = [[0.0_f64; 3]; 2];
    let _ = Vectors::field(&records, |_| &ELSEWHERE);
}

#[test]
fn invalid_rays_harm_no_other() -> Result<()> {
    let scene = Scene::new()?;
    scene.insert(&Shape::sphere(1.0)?, [0.0, 0.0, 5.0])?;
    let rays = [Ray::new([0.0; 3], ALONG_Z), Ray::new([0.0; 3], [0.0; 3]), Ray::new([f64::NAN; 3], ALONG_Z)];
    let mut hits = [Hit::MISS; 3];
    assert_eq!(scene.query().trace_many(&rays, &mut hits)?.invalid, 2);
    assert_eq!(hits.map(|hit| (hit.is_hit(), hit.is_invalid())), [(true, false), (false, true), (false, true)]);
    assert_eq!(scene.trace(&rays[1]).unwrap_err().kind(), ErrorKind::InvalidValue);
    assert_eq!(scene.query().trace(&rays[2]).unwrap_err().kind(), ErrorKind::InvalidValue);
    assert!(!scene.occluded(&rays[1])?);
    assert_eq!(scene.stats()?.invalid_rays, 5);
    Ok(())
}

#[test]
fn records_are_bytes() -> Result<()> {
    let ray = Ray::new([1.0, 2.0, 3.0], ALONG_Z).from(-1.0).until(4.0).mask(7);
    let bytes = bytemuck::bytes_of(&ray).to_vec();
    assert_eq!(bytemuck::pod_read_unaligned::<Ray>(&bytes), ray);
    let zero = <Hit as bytemuck::Zeroable>::zeroed();
    assert_eq!(zero.object, None);
    assert_eq!(ray.at(2.0), [1.0, 2.0, 5.0]);
    Ok(())
}

#[test]
fn empty_calls_are_fine() -> Result<()> {
    let scene = Scene::new()?;
    assert_eq!(scene.insert_many(&Shape::sphere(1.0)?, &[] as &[[f64; 3]])?, []);
    scene.trace_many(&[], &mut [])?;
    scene.occluded_many(&[], &mut [])?;
    scene.remove_many(&[] as &[ObjectId])?;
    scene.query().trace_many(&[], &mut [])?;
    let none: [[f64; 3]; 0] = [];
    scene.query().trace_views(RayViews::new(&none, ALONG_Z).rev(), HitViews::new())?;
    Ok(())
}

#[test]
fn culling_and_shapes() -> Result<()> {
    let scene = Scene::new()?;
    scene.insert(&Shape::capsule([0.0; 3], [0.0, 4.0, 0.0], 1.0)?, [0.0, -2.0, 5.0])?;
    let ray = Ray::new([0.0; 3], ALONG_Z);
    assert_eq!(scene.query().cull(Cull::Back).trace(&ray)?.map(|hit| hit.t), Some(4.0));
    assert_eq!(scene.query().cull(Cull::Front).trace(&ray)?.map(|hit| hit.t), Some(6.0));
    assert!(scene.query().cull(Cull::Front).occluded(&ray)?);
    let triangle = Shape::triangles(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]])?;
    let report = triangle.stats()?;
    assert_eq!((report.kind, report.triangle_count), (raygrid::ShapeKind::Mesh, 1));
    assert_eq!((report.lo, report.hi), ([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]));
    assert!(format!("{triangle:?} {scene:?}").contains("triangle_count: 1"));
    Ok(())
}

#[test]
fn a_mesh_that_changes_its_form() -> Result<()> {
    let corners: Vec<[f64; 3]> = (0..300).map(|i| [0.1, 0.7, 1.3].map(|f| (f * f64::from(i)).sin())).collect();
    let rays: Vec<Ray> =
        corners.iter().map(|c| Ray::new([3.0, c[0], 2.0 * c[1]], [c[1] - 3.0, c[2], c[0]])).collect();
    let hits = |scene: &Scene| -> Result<Vec<f64>> {
        let mut hits = vec![Hit::MISS; rays.len()];
        scene.trace_many(&rays, &mut hits)?;
        Ok(hits.iter().map(|hit| hit.t).collect())
    };
    for quality in [MeshQuality::Best, MeshQuality::Fast] {
        let making = Shape::mesh_builder().quality(quality).workers(2);
        let (scene, other) = (Scene::new()?, Scene::new()?);
        let mesh = making.triangles(&corners)?;
        let ids = scene.insert_many(&mesh, &[[0.0; 3], [0.5, 0.0, 0.0]])?;
        let larger: Vec<[f64; 3]> = corners.iter().map(|c| c.map(|x| 1.25 * x)).collect();
        let bent = making.deformed(&mesh, &larger)?;
        scene.replace_shape(&mesh, &bent)?;
        assert!(ids.iter().all(|&id| scene.lookup(id).is_ok_and(|report| report.shape == bent.id())));
        other.insert_many(&Shape::triangles(&larger)?, &[[0.0; 3], [0.5, 0.0, 0.0]])?;
        assert_eq!(hits(&scene)?, hits(&other)?);
        assert!(hits(&scene)?.iter().filter(|t| t.is_finite()).count() > 20);
        assert_eq!(mesh.deformed(&larger[1..]).unwrap_err().kind(), ErrorKind::InvalidValue);
        assert_eq!(Shape::sphere(1.0)?.deformed(&larger).unwrap_err().kind(), ErrorKind::InvalidArgument);
    }
    Ok(())
}

#[test]
fn frames_outlive_their_scene() -> Result<()> {
    let scene = Scene::new()?;
    let ids = scene.insert_many(&Shape::sphere(1.0)?, &[[0.0, 0.0, 5.0], [9.0, 0.0, 5.0]])?;
    let (frame, other) = (scene.frame_by(Scene::builder().workers(1))?, scene.frame()?);
    scene.move_to(ids[0], [0.0, 0.0, 7.0])?;
    scene.remove(ids[1])?;
    assert_eq!((t_of(&frame, 0.0)?, t_of(&frame, 9.0)?), (Some(4.0), Some(4.0)));
    assert_eq!(frame.move_to(ids[0], [0.0; 3]).unwrap_err().kind(), ErrorKind::Busy);
    frame.update()?;
    let of_frame = frame.frame()?;
    drop(scene);
    assert_eq!((t_of(&frame, 0.0)?, t_of(&frame, 9.0)?), (Some(6.0), None));
    frame.update()?;
    assert_eq!(other.stats()?.objects, 2);
    drop(frame);
    of_frame.update()?;
    assert_eq!(of_frame.stats()?.objects, 1);
    Ok(())
}

#[test]
fn memory_has_a_limit() -> Result<()> {
    let scene = Scene::builder().memory_limit(1 << 20).build()?;
    let ball = Shape::sphere(1.0)?;
    let id = scene.insert(&ball, [0.0, 0.0, 5.0])?;
    let error = scene.insert_many(&ball, &vec![[0.0; 3]; 100_000]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::OutOfMemory);
    assert_eq!((scene.stats()?.objects, t_of(&scene, 0.0)?), (1, Some(4.0)));
    scene.remove(id)
}

#[test]
fn memory_from_the_global_allocator() -> Result<()> {
    let scene = Scene::builder().global_allocator().workers(2).build()?;
    let before = scene.stats()?.bytes;
    let places: Vec<[f64; 3]> = (0..20_000).map(|i| [f64::from(i % 100), f64::from(i / 100), 5.0]).collect();
    let ids = scene.insert_many(&Shape::sphere(0.4)?, &places)?;
    assert!(scene.stats()?.bytes > before + 200_000);
    assert_eq!(t_of(&scene, 50.0)?, Some(4.6));
    scene.remove_many(&ids)
}
