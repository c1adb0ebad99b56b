//! Materials, and the request to write one as maps.

use super::Domain;
use crate::field::Field;
use crate::key::KeyHasher;
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
    /// Where the piece lies in space, if it was cut for a curved surface.
    pub surface: Option<Surface>,
}

/// How a piece lies on a surface in space.
#[derive(Clone, Debug)]
pub struct Surface {
    /// How the surface runs at each point of the piece: the change of its place along u and along v, in mm for each mm of
    /// the piece, six columns. `None` if it is not known.
    pub tangents: Option<Field>,
    /// Fields that are the same only within a chart: points with different values are no neighbours, however near they lie
    /// on the piece. The whole part says which chart it is; a fraction marks parts of one chart, over which differences
    /// do not reach either, but a pixel may be the mean of both.
    pub charts: Vec<Field>,
}

impl Surface {
    /// The surface of a piece that was moved: each of its points shows what was at `position`. Nothing lies any more
    /// where the surface has it.
    pub(crate) fn at(&self, position: &Field) -> Surface {
        Surface {
            tangents: None,
            charts: self.charts.iter().map(|chart| chart.at(position)).collect(),
        }
    }

    /// The surface of a piece that is made of two: the shape of the first, with the charts of both.
    pub(crate) fn of_both(one: Option<&Surface>, other: Option<&Surface>) -> Option<Surface> {
        let (Some(one), Some(other)) = (one, other) else {
            return one.or(other).cloned();
        };
        let mut both = one.clone();
        let is_new = |chart: &&Field| one.charts.iter().all(|known| known.key() != chart.key());
        both.charts
            .extend(other.charts.iter().filter(is_new).cloned());
        Some(both)
    }

    /// Adds what the surface is to a key.
    pub(crate) fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("surface").whole(self.charts.len() as i64);
        self.charts.iter().chain(&self.tangents).for_each(|chart| {
            key.key(chart.key());
        });
    }
}

/// Channels that hold directions in the material: they turn with it, and a mean of them has length 1.
const DIRECTION_CHANNELS: [&str; 1] = ["fibre"];

impl Material {
    /// The charts of the piece; none if it is flat.
    pub fn charts(&self) -> &[Field] {
        self.surface.as_ref().map_or(&[], |surface| &surface.charts)
    }

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
    /// TIFF with 8 bits a sample.
    Tiff8,
    /// TIFF with 16 bits a sample.
    Tiff16,
    /// TIFF with 16-bit floats.
    TiffHalf,
    /// TIFF with 32-bit floats.
    TiffFloat,
    /// BMP with 8 bits a sample.
    Bmp,
}

/// The kind of file that a map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileType {
    /// Portable Network Graphics.
    Png,
    /// OpenEXR.
    Exr,
    /// Tagged Image File Format.
    Tiff,
    /// Windows bitmap.
    Bmp,
}

/// What one sample of a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleType {
    /// A whole number from 0 to 255.
    Whole8,
    /// A whole number from 0 to 65535.
    Whole16,
    /// A 16-bit float.
    Half,
    /// A 32-bit float.
    Float,
}

impl SampleType {
    /// The bytes of a sample.
    pub fn bytes(self) -> usize {
        match self {
            SampleType::Whole8 => 1,
            SampleType::Whole16 | SampleType::Half => 2,
            SampleType::Float => 4,
        }
    }

    /// Whether samples are floats, which hold values as they are.
    pub fn is_float(self) -> bool {
        matches!(self, SampleType::Half | SampleType::Float)
    }
}

impl MapFormat {
    /// All formats in the order of the variants.
    pub const ALL: [MapFormat; 9] = [
        MapFormat::Png8,
        MapFormat::Png16,
        MapFormat::ExrHalf,
        MapFormat::ExrFloat,
        MapFormat::Tiff8,
        MapFormat::Tiff16,
        MapFormat::TiffHalf,
        MapFormat::TiffFloat,
        MapFormat::Bmp,
    ];

    /// The names a recipe uses, in the order of the variants.
    pub const NAMES: [&'static str; 9] = [
        "png8",
        "png16",
        "exr_half",
        "exr_float",
        "tiff8",
        "tiff16",
        "tiff_half",
        "tiff_float",
        "bmp",
    ];

    /// The format called `name`.
    pub fn from_name(name: &str) -> Option<MapFormat> {
        let index = MapFormat::NAMES.iter().position(|known| *known == name)?;
        MapFormat::ALL.get(index).copied()
    }

    /// The name a recipe uses.
    pub fn name(self) -> &'static str {
        MapFormat::NAMES[self as usize]
    }

    /// The kind of file.
    pub fn file_type(self) -> FileType {
        match self {
            MapFormat::Png8 | MapFormat::Png16 => FileType::Png,
            MapFormat::ExrHalf | MapFormat::ExrFloat => FileType::Exr,
            MapFormat::Bmp => FileType::Bmp,
            _ => FileType::Tiff,
        }
    }

    /// What the samples are.
    pub fn sample_type(self) -> SampleType {
        match self {
            MapFormat::Png8 | MapFormat::Tiff8 | MapFormat::Bmp => SampleType::Whole8,
            MapFormat::Png16 | MapFormat::Tiff16 => SampleType::Whole16,
            MapFormat::ExrHalf | MapFormat::TiffHalf => SampleType::Half,
            MapFormat::ExrFloat | MapFormat::TiffFloat => SampleType::Float,
        }
    }

    /// The file name's extension.
    pub fn extension(self) -> &'static str {
        match self.file_type() {
            FileType::Png => "png",
            FileType::Exr => "exr",
            FileType::Tiff => "tif",
            FileType::Bmp => "bmp",
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
    /// Values that whole samples write as black and as white, for channels that are not ratios.
    pub ranges: BTreeMap<String, [f64; 2]>,
}
