// SPDX-License-Identifier: MIT
//! Other crates' types: those of glam and mint in, and everything through serde.

#[cfg(feature = "glam")]
mod with_glam {
    use glam::{Affine3A, DAffine3, DQuat, DVec3, Quat, Vec3, Vec3A};
    use raygrid::views::{HitViews, RayViews};
    use raygrid::{Pose, Ray, Result, Scene, Shape};

    #[test]
    fn vectors_and_transforms() -> Result<()> {
        let scene = Scene::new()?;
        let brick = Shape::box_between(DVec3::NEG_ONE, DVec3::splat(1.0))?;
        let turned = DAffine3::from_scale_rotation_translation(
            DVec3::new(1.0, 1.0, 2.0),
            DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2),
            DVec3::new(0.0, 0.0, 5.0),
        );
        let id = scene.insert(&brick, turned)?;
        let pose = scene.lookup(id)?.pose;
        assert_eq!(pose.linear, Pose::from(turned).linear);
        let image = turned.transform_vector3(DVec3::new(1.0, 2.0, 3.0)).to_array();
        let of_rows = pose.linear.map(|[x, y, z]| f64::from(x) + 2.0 * f64::from(y) + 3.0 * f64::from(z));
        assert!((0..3).all(|axis| (image[axis] - of_rows[axis]).abs() < 1e-6), "{image:?} {of_rows:?}");
        let flat = Affine3A::from_rotation_translation(Quat::from_rotation_z(1.0), Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(Pose::from(flat).position, [1.0, 2.0, 3.0]);
        assert_eq!(Pose::from(flat).linear[0][1], flat.matrix3.y_axis.x);

        let far = scene.insert(&brick, DVec3::new(100.0, 0.0, 0.0))?;
        scene.move_many(&vec![id, far], &vec![DVec3::ZERO, DVec3::new(0.0, 0.0, 50.0)])?;
        let hit = scene.trace(&Ray::new(DVec3::new(0.0, 0.0, 9.0), DVec3::Z))?.unwrap();
        assert_eq!((hit.object, DVec3::from(hit.position).z.round()), (Some(far), 49.0));
        scene.move_many(&[id], &[Vec3A::new(0.0, 0.0, 30.0)])?;
        assert_eq!(scene.lookup(id)?.pose.position, [0.0, 0.0, 30.0]);
        let mut normals = [Vec3A::NAN; 2];
        let rays = RayViews::new(DVec3::ZERO, &[Vec3::Z, Vec3::Y]);
        scene.query().trace_views(rays, HitViews::new().normal(&mut normals))?;
        assert_eq!(normals.map(Vec3A::round), [Vec3A::NEG_Z, Vec3A::ZERO]);
        scene.move_many(&[id], &vec![Vec3::new(0.0, 0.0, 20.0)])?;
        assert_eq!(scene.lookup(id)?.pose.position, [0.0, 0.0, 20.0]);
        Ok(())
    }
}

#[cfg(feature = "mint")]
mod with_mint {
    use mint::{ColumnMatrix3x4, Point3, RowMatrix3x4, Vector3};
    use raygrid::{Pose, Ray, Result, Scene, Shape};

    #[test]
    fn points_and_matrices() -> Result<()> {
        let scene = Scene::new()?;
        let ball = Shape::sphere(1.0)?;
        let rows = RowMatrix3x4::from([[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 8.0, 9.0], [7.0, 1.0, 2.0, 3.0]]);
        let wanted = Pose::at([4.0, 9.0, 3.0]).linear([[1.0, 2.0, 3.0], [5.0, 6.0, 8.0], [7.0, 1.0, 2.0]]);
        assert_eq!(Pose::from(rows), wanted);
        assert_eq!(Pose::from(ColumnMatrix3x4::from(rows)), wanted);
        let place = Point3 { x: 0.0, y: 0.0, z: 5.0 };
        let ids = vec![scene.insert(&ball, place)?, scene.insert(&ball, Vector3 { x: 9.0, y: 0.0, z: 5.0 })?];
        let ray = Ray::new(Point3 { x: 0.0, y: 0.0, z: 0.0 }, Vector3 { x: 0.0, y: 0.0, z: 1.0 });
        assert_eq!(scene.trace(&ray)?.unwrap().t, 4.0);
        scene.move_many(&ids, &vec![Point3 { x: 1.0_f32, y: 2.0, z: 3.0 }, Point3 { x: 4.0, y: 5.0, z: 6.0 }])?;
        assert_eq!(scene.lookup(ids[1])?.pose.position, [4.0, 5.0, 6.0]);
        Ok(())
    }
}

#[cfg(feature = "serde")]
mod with_serde {
    use std::fmt::Debug;

    use raygrid::{Cull, GridConfig, GridId, GridKind, Hit, ObjectId, Pose, Ray};
    use serde::{Serialize, de::DeserializeOwned};

    fn there_and_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: T) -> String {
        let text = serde_json::to_string(&value).expect("it can be written");
        assert_eq!(serde_json::from_str::<T>(&text).expect("it can be read"), value);
        text
    }

    #[test]
    fn values_go_there_and_back() {
        there_and_back(Ray::new([0.1, 0.2, 0.3], [0.0, 0.0, 1.0]).until(5.0).mask(3));
        there_and_back(Hit { t: 1.5, object: ObjectId::from_bits(0x1_0000_0007), ..Hit::MISS });
        there_and_back(Pose::at([1.0, 2.0, 3.0]).scale(0.1));
        there_and_back(GridConfig::new(GridKind::Uniform).resolution(8).bounds([0.0; 3], [1.0; 3]).rebuild_never());
        assert_eq!(there_and_back(GridId::OF_SCENE), "0");
        assert_eq!(there_and_back(ObjectId::from_bits(0x1_0000_0007)), "4294967303");
        assert_eq!(there_and_back(Cull::Back), "\"Back\"");
        assert_eq!(serde_json::from_str::<GridConfig>("{}").expect("all defaults"), GridConfig::default());
        assert!(serde_json::from_str::<ObjectId>("0").is_err());
    }
}
