// SPDX-License-Identifier: MIT
//! The steps of a script that are calls.

use raygrid::views::{Element, Indices, Kind, PoseViews, Poses, Triples, Vectors};
use raygrid::{Insert, MeshBuilder, MeshQuality, Pose, Shape, Shapes};
use serde_json::Value;

use crate::script::{
    Named, Outcome, Play, Step, field, known, list, malformed, mask, matrix, number, numbers, record, text, vectors,
    whole,
};
use crate::trace::Batch;

/// Makes the call of a step, and says if there is none of that name.
pub fn call(play: &mut Play, step: &Step) -> Outcome {
    let name = text(field(step, "do")?)?;
    let fields = match name {
        "sphere" => "shape radius",
        "box" => "shape lo hi",
        "capsule" => "shape a b radius",
        "mesh" => "shape vertices vertex_type indices index_type apart quality",
        "deform" => "shape from vertices vertex_type apart quality",
        "replace_shape" => "from to",
        "release" => "shape",
        "insert" => "object shape position linear mask grid",
        "insert_many" => "objects shape shapes positions linears masks grid",
        "insert_line" => "objects shape start step count grid",
        "move" => "object position linear",
        "move_to" => "object position",
        "move_many" => "objects positions linears",
        "set_mask" => "object mask",
        "remove" | "lookup" => "object",
        "remove_many" => "objects",
        "create_grid" | "configure_grid" => "grid config",
        "rebuild_grid" | "destroy_grid" | "grid_stats" => "grid",
        "trace" => "rays cull respawn",
        _ => malformed!("unknown step {name}"),
    };
    known(step, &format!("do {fields}"))?;
    match name {
        "sphere" | "box" | "capsule" | "mesh" | "deform" | "release" => shapes(play, step, name),
        "insert" | "insert_many" | "insert_line" => insert(play, step, name),
        "create_grid" | "configure_grid" | "rebuild_grid" | "destroy_grid" | "grid_stats" => grids(play, step, name),
        "trace" => Batch::new(step)?.trace_once(play).map(drop),
        _ => change(play, step, name),
    }
}

fn shapes(play: &mut Play, step: &Step, name: &str) -> Outcome {
    let shape = match name {
        "sphere" => Shape::sphere(number(field(step, "radius")?)?)?,
        "box" => Shape::box_between(numbers(field(step, "lo")?)?, numbers(field(step, "hi")?)?)?,
        "capsule" => {
            let (a, b) = (numbers(field(step, "a")?)?, numbers(field(step, "b")?)?);
            Shape::capsule(a, b, number(field(step, "radius")?)?)?
        }
        "mesh" => mesh(step)?,
        "deform" => deform(play, step)?,
        _ => {
            play.shape(field(step, "shape")?)?;
            play.shapes.remove(text(field(step, "shape")?)?);
            return Ok(());
        }
    };
    play.shapes.insert(text(field(step, "shape")?)?.into(), shape);
    Ok(())
}

/// Three numbers a record: one after another, or each in an array of its own.
struct Laid<T> {
    packed: Vec<[T; 3]>,
    columns: [Vec<T>; 3],
}

impl<T: Copy> Laid<T> {
    fn new(packed: Vec<[T; 3]>) -> Self {
        let columns = [0, 1, 2].map(|i| packed.iter().map(|record| record[i]).collect());
        Self { packed, columns }
    }

    fn view<'a, K: Kind>(&'a self, step: &Step) -> Triples<'a, K>
    where
        T: Element<K>,
        &'a Vec<[T; 3]>: Into<Triples<'a, K>>,
    {
        let [x, y, z] = &self.columns;
        let apart = step.get("apart").and_then(Value::as_bool).unwrap_or(false);
        if apart { Triples::components(x, y, z) } else { (&self.packed).into() }
    }
}

fn making(step: &Step) -> Outcome<MeshBuilder> {
    let quality = match step.get("quality") {
        None => MeshQuality::Best,
        Some(Value::String(name)) if name == "best" => MeshQuality::Best,
        Some(Value::String(name)) if name == "fast" => MeshQuality::Fast,
        Some(value) => match value.as_i64().map(i32::try_from) {
            Some(Ok(number)) => MeshQuality::try_from(number)?,
            _ => malformed!("{value} is no quality"),
        },
    };
    Ok(Shape::mesh_builder().quality(quality))
}

/// Calls `make` with the vertices of a step, as its types say.
fn with_vertices(step: &Step, make: impl FnOnce(Vectors) -> Outcome<Shape>) -> Outcome<Shape> {
    let doubles = vectors(field(step, "vertices")?)?;
    let floats = Laid::new(doubles.iter().map(|vertex| vertex.map(|x| x as f32)).collect());
    match step.get("vertex_type").map(text).transpose()? {
        Some("f32") => make(floats.view(step)),
        None | Some("f64") => make(Laid::new(doubles).view(step)),
        Some(other) => malformed!("unknown vertex_type {other}"),
    }
}

fn mesh(step: &Step) -> Outcome<Shape> {
    let making = making(step)?;
    let Some(given) = step.get("indices") else {
        return with_vertices(step, |vertices| Ok(making.triangles(vertices)?));
    };
    let mut wide = Vec::new();
    for triangle in list(given)? {
        let corners = list(triangle)?.iter().map(|index| whole(index, u64::MAX)).collect::<Outcome<Vec<u64>>>()?;
        wide.push(<[u64; 3]>::try_from(corners).or_else(|_| malformed!("{triangle} are not three corners"))?);
    }
    let middle = Laid::new(wide.iter().map(|corners| corners.map(|index| index as u32)).collect());
    let narrow = Laid::new(wide.iter().map(|corners| corners.map(|index| index as u16)).collect());
    let wide = Laid::new(wide);
    let indices: Indices = match step.get("index_type").map(text).transpose()? {
        Some("u16") => narrow.view(step),
        None | Some("u32") => middle.view(step),
        Some("u64") => wide.view(step),
        Some(other) => malformed!("unknown index_type {other}"),
    };
    with_vertices(step, |vertices| Ok(making.mesh(vertices, indices)?))
}

fn deform(play: &Play, step: &Step) -> Outcome<Shape> {
    let (making, old) = (making(step)?, play.shape(field(step, "from")?)?);
    with_vertices(step, |vertices| Ok(making.deformed(old, vertices)?))
}

/// Linear parts as the views of their columns: each component of each in an array of its own.
struct Columns([[Vec<f32>; 3]; 3]);

impl Columns {
    fn new(value: &Value) -> Outcome<Self> {
        let all = list(value)?.iter().map(matrix).collect::<Outcome<Vec<_>>>()?;
        Ok(Self(std::array::from_fn(|column| {
            std::array::from_fn(|row| all.iter().map(|linear| linear[row][column]).collect())
        })))
    }

    fn of<'a>(&'a self, poses: PoseViews<'a>) -> PoseViews<'a> {
        poses.columns([0, 1, 2].map(|column| {
            let [x, y, z] = &self.0[column];
            Vectors::components(x, y, z)
        }))
    }
}

fn insert(play: &mut Play, step: &Step, name: &str) -> Outcome {
    let positions = match name {
        "insert" => vec![numbers(field(step, "position")?)?],
        "insert_many" => vectors(field(step, "positions")?)?,
        _ => {
            let (start, each): ([f64; 3], [f64; 3]) =
                (numbers(field(step, "start")?)?, numbers(field(step, "step")?)?);
            let count = whole(field(step, "count")?, 1 << 30)?;
            (0..count).map(|i| [0, 1, 2].map(|axis| start[axis] + i as f64 * each[axis])).collect()
        }
    };
    let columns = step.get("linears").map(Columns::new).transpose()?;
    let masks =
        step.get("masks").map(|all| list(all)?.iter().map(mask).collect::<Outcome<Vec<u32>>>()).transpose()?;
    let several = match step.get("shapes") {
        Some(names) => list(names)?.iter().map(|name| play.shape(name).cloned()).collect::<Outcome<Vec<_>>>()?,
        None => Vec::new(),
    };
    let shapes: Shapes = match step.get("shape") {
        Some(name) => play.shape(name)?.into(),
        None => (&several).into(),
    };
    // One object by the call for one, if that can say it.
    if name == "insert" && step.get("mask").is_none() && step.get("grid").is_none() {
        let linear = step.get("linear").map(matrix).transpose()?;
        let pose = Pose::at(positions[0]);
        let pose = linear.map_or(pose, |linear| pose.linear(linear));
        let id = play.scene.insert(play.shape(field(step, "shape")?)?, pose)?;
        play.objects.insert(text(field(step, "object")?)?.into(), Named::One(id));
        return Ok(());
    }
    let records: Vec<Pose>;
    let poses = match (step.get("linear"), &columns) {
        (Some(linear), _) => {
            records = vec![Pose::at(positions[0]).linear(matrix(linear)?)];
            Poses::from(&records)
        }
        (None, Some(columns)) => columns.of(Poses::at(&positions)).into(),
        (None, None) => Poses::at(&positions).into(),
    };
    let mut what = Insert::new(shapes, poses);
    if let Some(masks) = &masks {
        what = what.mask(masks);
    } else if let Some(one) = step.get("mask") {
        what = what.mask(mask(one)?);
    }
    if let Some(grid) = step.get("grid") {
        what = what.grid(play.grid(grid)?);
    }
    let ids = play.scene.insert_all(what)?;
    match name {
        "insert" => play.objects.insert(text(field(step, "object")?)?.into(), Named::One(ids[0])),
        _ => play.objects.insert(text(field(step, "objects")?)?.into(), Named::Many(ids)),
    };
    Ok(())
}

fn change(play: &mut Play, step: &Step, name: &str) -> Outcome {
    let one = || play.object(field(step, "object")?);
    let many = || list(field(step, "objects")?)?.iter().map(|name| play.object(name)).collect::<Outcome<Vec<_>>>();
    match name {
        "move" => {
            let pose = Pose::at(numbers(field(step, "position")?)?);
            let linear = step.get("linear").map(matrix).transpose()?;
            play.scene.move_pose(one()?, linear.map_or(pose, |linear| pose.linear(linear)))?;
        }
        "replace_shape" => {
            play.scene.replace_shape(play.shape(field(step, "from")?)?, play.shape(field(step, "to")?)?)?
        }
        "move_to" => play.scene.move_to(one()?, numbers(field(step, "position")?)?)?,
        "move_many" => {
            let positions = vectors(field(step, "positions")?)?;
            let columns = step.get("linears").map(Columns::new).transpose()?;
            let poses = Poses::at(&positions);
            play.scene.move_many(&many()?, columns.as_ref().map_or(poses, |columns| columns.of(poses)))?;
        }
        "set_mask" => play.scene.set_mask(one()?, mask(field(step, "mask")?)?)?,
        "remove" => play.scene.remove(one()?)?,
        "remove_many" => play.scene.remove_many(&many()?)?,
        "lookup" => drop(play.scene.lookup(one()?)?),
        _ => malformed!("unknown step {name}"),
    }
    Ok(())
}

fn grids(play: &mut Play, step: &Step, name: &str) -> Outcome {
    let named = field(step, "grid")?;
    let config = || play.setup.config(record(field(step, "config")?)?);
    match name {
        "create_grid" => {
            let made = play.scene.create_grid(&config()?)?;
            play.grids.insert(text(named)?.into(), made);
        }
        "configure_grid" => play.scene.configure_grid(play.grid(named)?, &config()?)?,
        "rebuild_grid" => play.scene.rebuild_grid(play.grid(named)?)?,
        "destroy_grid" => play.scene.destroy_grid(play.grid(named)?)?,
        _ => drop(play.scene.grid_stats(play.grid(named)?)?),
    }
    Ok(())
}
