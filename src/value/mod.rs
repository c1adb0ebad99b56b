//! What flows on links: literals, structures, fields, materials and requests for maps.

mod climate;
mod colour_pattern;
mod material;
mod mesh;
mod partition;
mod patches;
mod region;
mod ring_series;
mod skeleton;
mod table;
mod types;

pub use climate::{Climate, Month};
pub use colour_pattern::{AfterEnd, ColourPattern};
pub use material::{FileType, MapFormat, Maps, Material, SampleType, Surface};
pub use mesh::{Mesh, Triangle};
pub use partition::Partition;
pub(crate) use patches::HIGHEST_DEGREE;
pub use patches::{Patch, Patches};
pub use region::{Polygon, Region};
pub use ring_series::RingSeries;
pub use skeleton::{Branch, Skeleton, Tangents, Thickness};
pub use table::Table;
pub use types::{Domain, Type, Unit};

use crate::field::Field;
use crate::key::KeyHasher;
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// A file that a recipe names, as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct FileContents {
    /// The path as the recipe writes it.
    pub path: PathBuf,
    /// What the file held when it was read.
    pub bytes: Arc<[u8]>,
}

impl FileContents {
    /// Adds the contents, and the ending of the name: nodes warn of one that lies.
    pub(crate) fn add_to_key<'k>(&self, key: &'k mut KeyHasher) -> &'k mut KeyHasher {
        let ending = self.path.extension().unwrap_or_default();
        let ending = ending.to_string_lossy().to_lowercase();
        key.text("file").text(&ending).bytes(&self.bytes)
    }
}

/// A value: what an input receives and an output gives.
#[derive(Clone, Debug)]
pub enum Value {
    /// A number in the unit of its input.
    Number(f64),
    /// A whole number.
    Whole(i64),
    /// True or false.
    Toggle(bool),
    /// The chosen name.
    Choice(&'static str),
    /// Text.
    Text(String),
    /// A file with its contents.
    File(FileContents),
    /// A linear Rec. 709 colour.
    Colour([f64; 3]),
    /// Three numbers.
    Vector(DVec3),
    /// Two numbers.
    Pair([f64; 2]),
    /// Values of one type.
    List(Vec<Value>),
    /// Named parts in the order of the type; absent optional parts are missing.
    Record(Vec<(&'static str, Value)>),
    /// Names of channels.
    Names(Vec<String>),
    /// Named values.
    Channels(Vec<(String, Value)>),
    /// A value for every point: a number, a vector or a colour.
    Field(Field),
    /// Trunk and branches.
    Skeleton(Arc<Skeleton>),
    /// Colour as a function of growth time.
    ColourPattern(Arc<ColourPattern>),
    /// Weather, month by month.
    Climate(Arc<Climate>),
    /// How a tree grew, year by year.
    RingSeries(Arc<RingSeries>),
    /// Triangles in space.
    Mesh(Arc<Mesh>),
    /// Curved surfaces in space.
    Patches(Arc<Patches>),
    /// Polygons with holes.
    Region(Arc<Region>),
    /// A plane divided into cells.
    Partition(Arc<Partition>),
    /// A bundle of fields.
    Material(Arc<Material>),
    /// Maps to be written.
    Maps(Arc<Maps>),
    /// A table to be written, instead of maps.
    Table(Arc<Table>),
}

impl Value {
    /// Adds the literal's canonical bytes to a key; values that have keys of their own add nothing.
    pub fn add_to_key(&self, key: &mut KeyHasher) {
        match self {
            Value::Number(number) => key.text("number").number(*number),
            Value::Whole(number) => key.text("whole").whole(*number),
            Value::Toggle(toggle) => key.text("toggle").whole(i64::from(*toggle)),
            Value::Choice(name) => key.text("choice").text(name),
            Value::Text(text) => key.text("text").text(text),
            Value::File(file) => file.add_to_key(key),
            Value::Colour(colour) => colour
                .iter()
                .fold(key.text("colour"), |key, part| key.number(*part)),
            Value::Vector(vector) => vector
                .to_array()
                .iter()
                .fold(key.text("vector"), |key, part| key.number(*part)),
            Value::Pair(pair) => pair
                .iter()
                .fold(key.text("pair"), |key, part| key.number(*part)),
            Value::Names(names) => {
                key.text("names").whole(names.len() as i64);
                names.iter().fold(key, |key, name| key.text(name))
            }
            Value::List(items) => {
                key.text("list").whole(items.len() as i64);
                items.iter().for_each(|item| item.add_to_key(key));
                key
            }
            Value::Record(parts) => {
                key.text("record").whole(parts.len() as i64);
                for (name, part) in parts {
                    part.add_to_key(key.text(name));
                }
                key
            }
            Value::Channels(parts) => {
                key.text("channels").whole(parts.len() as i64);
                for (name, part) in parts {
                    part.add_to_key(key.text(name));
                }
                key
            }
            Value::Field(field) => key.text("field").key(field.key()),
            Value::Skeleton(_)
            | Value::ColourPattern(_)
            | Value::Climate(_)
            | Value::RingSeries(_)
            | Value::Mesh(_)
            | Value::Patches(_)
            | Value::Region(_)
            | Value::Partition(_)
            | Value::Material(_)
            | Value::Maps(_)
            | Value::Table(_) => key,
        };
    }

    /// The part of a record called `name`, if it is there.
    pub fn part(&self, name: &str) -> Option<&Value> {
        let Value::Record(parts) = self else {
            return None;
        };
        let found = parts.iter().find(|(part, _)| *part == name);
        found.map(|(_, value)| value)
    }

    /// The number, if it is a number or a whole number.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Value::Number(number) => Some(*number),
            Value::Whole(number) => Some(*number as f64),
            _ => None,
        }
    }

    /// The vector, if it is one.
    pub fn as_vector(&self) -> Option<DVec3> {
        match self {
            Value::Vector(vector) => Some(*vector),
            _ => None,
        }
    }

    /// The name of the value's type in messages.
    pub fn type_name(&self) -> &'static str {
        match self {
            Value::Number(_) => "number",
            Value::Whole(_) => "whole number",
            Value::Toggle(_) => "toggle",
            Value::Choice(_) => "choice",
            Value::Text(_) => "text",
            Value::File(_) => "file",
            Value::Colour(_) => "colour",
            Value::Vector(_) => "vector",
            Value::Pair(_) => "pair",
            Value::List(_) => "list",
            Value::Record(_) => "record",
            Value::Names(_) => "names",
            Value::Channels(_) => "map",
            Value::Field(_) => "field",
            Value::Skeleton(_) => "skeleton",
            Value::ColourPattern(_) => "colour pattern",
            Value::Climate(_) => "climate",
            Value::RingSeries(_) => "ring series",
            Value::Mesh(_) => "mesh",
            Value::Patches(_) => "patches",
            Value::Region(_) => "region",
            Value::Partition(_) => "partition",
            Value::Material(_) => "material",
            Value::Maps(_) => "maps",
            Value::Table(_) => "table",
        }
    }
}
