// SPDX-License-Identifier: MIT
//! What a case's script says: numbers, names, poses, grids. All that the schema does not know is malformed.

use std::collections::HashMap;

use raygrid::{Error, ErrorKind, GridConfig, GridId, GridKind, ObjectId, Scene, Shape};
use serde_json::{Map, Value};

use crate::trace::Batch;

/// Why a case does not pass.
#[derive(Debug)]
pub enum Fail {
    /// The script is not what the schema says.
    Malformed(String),
    /// The library's answer is not what the script expects.
    Wrong(String),
    /// The library, or the type that an argument has here, refused a call.
    Refused(Error),
}

impl From<Error> for Fail {
    fn from(error: Error) -> Self {
        Self::Refused(error)
    }
}

pub type Outcome<T = ()> = Result<T, Fail>;
pub type Step = Map<String, Value>;

/// Ends with `Fail::Malformed`.
macro_rules! malformed {
    ($($what:tt)*) => { return Err($crate::script::Fail::Malformed(format!($($what)*))) };
}

/// Ends with `Fail::Wrong` unless the condition holds.
macro_rules! ensure {
    ($condition:expr, $($what:tt)*) => {{
        let holds: bool = $condition;
        if !holds {
            return Err($crate::script::Fail::Wrong(format!($($what)*)));
        }
    }};
}
pub(crate) use {ensure, malformed};

pub fn record(value: &Value) -> Outcome<&Step> {
    match value.as_object() {
        Some(record) => Ok(record),
        None => malformed!("{value} is no object"),
    }
}

pub fn known(record: &Step, words: &str) -> Outcome {
    for key in record.keys() {
        if !words.split_whitespace().any(|word| word == key) {
            malformed!("unknown field {key}; known are {words}");
        }
    }
    Ok(())
}

pub fn field<'a>(record: &'a Step, key: &str) -> Outcome<&'a Value> {
    match record.get(key) {
        Some(value) => Ok(value),
        None => malformed!("no {key} in {record:?}"),
    }
}

pub fn text(value: &Value) -> Outcome<&str> {
    match value.as_str() {
        Some(text) => Ok(text),
        None => malformed!("{value} is no text"),
    }
}

pub fn list(value: &Value) -> Outcome<&[Value]> {
    match value.as_array() {
        Some(values) => Ok(values),
        None => malformed!("{value} is no array"),
    }
}

pub fn number(value: &Value) -> Outcome<f64> {
    if let Some(number) = value.as_f64() {
        return Ok(number);
    }
    let text = text(value)?;
    match (text, text.strip_prefix('x'), text.len()) {
        ("inf", ..) => return Ok(f64::INFINITY),
        ("-inf", ..) => return Ok(f64::NEG_INFINITY),
        ("nan", ..) => return Ok(f64::NAN),
        (_, Some(digits), 17) => {
            if let Ok(bits) = u64::from_str_radix(digits, 16) {
                return Ok(f64::from_bits(bits));
            }
        }
        (_, Some(digits), 9) => {
            if let Ok(bits) = u32::from_str_radix(digits, 16) {
                return Ok(f32::from_bits(bits).into());
            }
        }
        _ => {}
    }
    malformed!("{text} is no number")
}

pub fn numbers<const N: usize>(value: &Value) -> Outcome<[f64; N]> {
    let all = list(value)?.iter().map(number).collect::<Outcome<Vec<f64>>>()?;
    all.try_into().or_else(|_| malformed!("{value} has not {N} numbers"))
}

pub fn vectors(value: &Value) -> Outcome<Vec<[f64; 3]>> {
    list(value)?.iter().map(numbers).collect()
}

pub fn whole(value: &Value, most: u64) -> Outcome<u64> {
    match value.as_u64() {
        Some(number) if number <= most => Ok(number),
        _ => malformed!("{value} is no whole number up to {most}"),
    }
}

pub fn mask(value: &Value) -> Outcome<u32> {
    Ok(whole(value, u32::MAX.into())? as u32)
}

/// A linear part, by rows, rounded to floats.
pub fn matrix(value: &Value) -> Outcome<[[f32; 3]; 3]> {
    let all: [f64; 9] = numbers(value)?;
    Ok(std::array::from_fn(|row| std::array::from_fn(|column| all[3 * row + column] as f32)))
}

/// One way to set up the scene's own grid; see tests/conformance/README.md.
pub struct Setup {
    pub name: String,
    pub kind: GridKind,
    tiled: bool,
    pub rebuilt: bool,
}

impl Setup {
    pub fn new(name: &str) -> Outcome<Self> {
        let (kind_name, end) = name.split_once('-').unwrap_or((name, ""));
        let kind = kind_of(kind_name)?;
        let (tiled, rebuilt) = (end == "tiled", end == "rebuilt");
        if kind == GridKind::Default || !(tiled || rebuilt || name == kind_name) || (tiled && kind == GridKind::Loose)
        {
            malformed!("unknown set-up {name}");
        }
        Ok(Self { name: name.into(), kind, tiled, rebuilt })
    }

    /// How the scene's own grid is made.
    pub fn grid(&self, given: Option<&Value>) -> Outcome<GridConfig> {
        match given {
            Some(_) if self.tiled || self.rebuilt => malformed!("this set-up takes no grid"),
            Some(config) => self.config(record(config)?),
            None if self.tiled => {
                let box_of = GridConfig::new(self.kind).resolution(4).bounds([-1.0; 3], [1.0; 3]);
                Ok(box_of.rebuild_never())
            }
            None => Ok(GridConfig::new(self.kind)),
        }
    }

    pub fn config(&self, config: &Step) -> Outcome<GridConfig> {
        known(config, "kind resolution lo hi rebuild_factor")?;
        let kind = match config.get("kind") {
            None => self.kind,
            Some(Value::String(name)) => kind_of(name)?,
            Some(value) => match value.as_i64().map(i32::try_from) {
                Some(Ok(number)) => GridKind::try_from(number)?,
                _ => malformed!("{value} is no kind"),
            },
        };
        let mut made = GridConfig::new(kind);
        if let Some(resolution) = config.get("resolution") {
            made = made.resolution(mask(resolution)?);
        }
        let corner = |key: &str| config.get(key).map_or(Ok([0.0; 3]), numbers);
        made = made.bounds(corner("lo")?, corner("hi")?);
        match config.get("rebuild_factor") {
            Some(Value::String(never)) if never == "never" => made = made.rebuild_never(),
            Some(factor) => made = made.rebuild_factor(number(factor)?),
            None => {}
        }
        Ok(made)
    }
}

pub fn kind_of(name: &str) -> Outcome<GridKind> {
    match GridKind::ALL.iter().find(|kind| format!("{kind:?}").to_lowercase() == name) {
        Some(kind) => Ok(*kind),
        None => malformed!("unknown kind {name}"),
    }
}

/// What a name of a script stands for.
pub enum Named {
    One(ObjectId),
    Many(Vec<ObjectId>),
}

/// A case while it is played.
pub struct Play {
    pub setup: Setup,
    pub scene: Scene,
    pub workers: u32,
    pub costly: bool,
    pub shapes: HashMap<String, Shape>,
    pub objects: HashMap<String, Named>,
    pub grids: HashMap<String, GridId>,
    /// The batch of the last trace step.
    pub last: Option<Batch>,
}

impl Play {
    pub fn object(&self, value: &Value) -> Outcome<ObjectId> {
        if let Some(record) = value.as_object() {
            known(record, "id")?;
            let digits = text(field(record, "id")?)?;
            let bits = if digits == "none" { Ok(0) } else { u64::from_str_radix(&digits[1..], 16) };
            return match bits.map(ObjectId::from_bits) {
                Ok(Some(id)) => Ok(id),
                // No such thing in Rust: the type refuses what the library does elsewhere.
                Ok(None) => Err(Fail::Malformed(NO_ID.into())),
                Err(_) => malformed!("{digits} is no id"),
            };
        }
        let name = text(value)?;
        let (name, index) = match name.split_once('[') {
            Some((name, index)) => (name, index.trim_end_matches(']').parse::<usize>().ok()),
            None => (name, None),
        };
        match (self.objects.get(name), index) {
            (Some(Named::One(id)), None) => Ok(*id),
            (Some(Named::Many(ids)), Some(index)) if index < ids.len() => Ok(ids[index]),
            _ => malformed!("no object is named {value}"),
        }
    }

    /// How a script calls an object.
    pub fn name_of(&self, wanted: Option<ObjectId>) -> String {
        let Some(wanted) = wanted else { return "nothing".into() };
        for (name, named) in &self.objects {
            match named {
                Named::One(id) if *id == wanted => return name.clone(),
                Named::Many(ids) => {
                    if let Some(index) = ids.iter().position(|id| *id == wanted) {
                        return format!("{name}[{index}]");
                    }
                }
                Named::One(_) => {}
            }
        }
        format!("{wanted:?}")
    }

    pub fn shape(&self, value: &Value) -> Outcome<&Shape> {
        match self.shapes.get(text(value)?) {
            Some(shape) => Ok(shape),
            None => malformed!("no shape is named {value}"),
        }
    }

    pub fn grid(&self, value: &Value) -> Outcome<GridId> {
        match (text(value)?, self.grids.get(text(value)?)) {
            ("scene", _) => Ok(GridId::OF_SCENE),
            (_, Some(grid)) => Ok(*grid),
            _ => malformed!("no grid is named {value}"),
        }
    }
}

/// That a script names the id 0, which `ObjectId` can't hold.
pub const NO_ID: &str = "there is no ObjectId of 0";

/// The words of the results that a script may expect.
pub fn result_of(name: &str) -> Outcome<ErrorKind> {
    Ok(match name {
        "RG_INVALID_ARGUMENT" => ErrorKind::InvalidArgument,
        "RG_INVALID_VALUE" => ErrorKind::InvalidValue,
        "RG_INVALID_ID" => ErrorKind::InvalidId,
        "RG_LIMIT_EXCEEDED" => ErrorKind::LimitExceeded,
        "RG_BUSY" => ErrorKind::Busy,
        _ => malformed!("{name} is no result that a script expects"),
    })
}
