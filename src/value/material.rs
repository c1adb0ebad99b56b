//! Materials, and the request to write one as maps.

use super::Domain;
use crate::field::Field;
use std::collections::BTreeMap;

/// A bundle of fields, by channel name.
///
/// Standard channels are `base_color` (colour), `height` (mm), `roughness`, `metalness`,
/// `occlusion` and `opacity` (ratios); any other name is an extra of the author's own. An extra `fibre` with three
/// columns is the direction of the fibres.
#[derive(Clone, Debug)]
pub struct Material {
    /// Where the fields are defined.
    pub domain: Domain,
    /// The channels by name.
    pub channels: BTreeMap<String, Field>,
    /// Width and height of the piece in mm, once it has been cut.
    pub size: Option<[f64; 2]>,
}

/// Channels that hold directions in the material: they turn with it, and a mean of them has length 1.
const DIRECTION_CHANNELS: [&str; 1] = ["fibre"];

impl Material {
    /// Whether a channel holds directions: three columns under a name that stands for one.
    pub fn is_direction(channel: &str, field: &Field) -> bool {
        field.width() == 3 && DIRECTION_CHANNELS.contains(&channel)
    }
}

/// How the samples of a map are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MapFormat {
    /// PNG with 8 bits a sample.
    Png8,
    /// PNG with 16 bits a sample.
    Png16,
    /// OpenEXR with 16-bit floats.
    ExrHalf,
    /// OpenEXR with 32-bit floats.
    ExrFloat,
}

impl MapFormat {
    /// The names a recipe uses, in the order of the variants.
    pub const NAMES: [&'static str; 4] = ["png8", "png16", "exr_half", "exr_float"];

    /// The format called `name`.
    pub fn from_name(name: &str) -> Option<MapFormat> {
        let formats = [
            MapFormat::Png8,
            MapFormat::Png16,
            MapFormat::ExrHalf,
            MapFormat::ExrFloat,
        ];
        let index = MapFormat::NAMES.iter().position(|known| *known == name)?;
        formats.get(index).copied()
    }

    /// The name a recipe uses.
    pub fn name(self) -> &'static str {
        MapFormat::NAMES[self as usize]
    }

    /// The file name's extension.
    pub fn extension(self) -> &'static str {
        match self {
            MapFormat::Png8 | MapFormat::Png16 => "png",
            MapFormat::ExrHalf | MapFormat::ExrFloat => "exr",
        }
    }
}

/// A request to write channels of a flat material as image files.
#[derive(Clone, Debug)]
pub struct Maps {
    /// The cut material.
    pub material: Material,
    /// Width and height of the pictures in pixels.
    pub pixels: [u32; 2],
    /// Width and height of the piece in mm.
    pub size: [f64; 2],
    /// The channels to write, in the order of the recipe.
    pub channels: Vec<String>,
    /// How samples are written.
    pub format: MapFormat,
    /// Values that a PNG writes as black and as white, for channels that are not ratios.
    pub ranges: BTreeMap<String, [f64; 2]>,
}
