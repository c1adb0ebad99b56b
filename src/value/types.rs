//! What an input accepts and an output gives: types, units, and where a value may vary.

use crate::node::Input;
use std::fmt;

/// The unit of a number. Links between different units are errors before anything runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unit {
    /// A plain ratio.
    One,
    /// Length.
    Millimetre,
    /// Time.
    Year,
    /// Speed of growth.
    MillimetrePerYear,
    /// Angle in degrees.
    Degree,
    /// Size of a picture.
    Pixel,
    /// Resolution of a picture.
    PixelPerMillimetre,
}

impl Unit {
    /// Every unit, in the order of the manual.
    pub const ALL: [Unit; 7] = [
        Unit::One,
        Unit::Millimetre,
        Unit::Year,
        Unit::MillimetrePerYear,
        Unit::Degree,
        Unit::Pixel,
        Unit::PixelPerMillimetre,
    ];

    /// The unit as a recipe writes it, for example `mm/year`.
    pub fn symbol(self) -> &'static str {
        match self {
            Unit::One => "1",
            Unit::Millimetre => "mm",
            Unit::Year => "year",
            Unit::MillimetrePerYear => "mm/year",
            Unit::Degree => "degree",
            Unit::Pixel => "px",
            Unit::PixelPerMillimetre => "px/mm",
        }
    }

    /// The unit that a recipe calls `symbol`.
    pub fn from_symbol(symbol: &str) -> Option<Unit> {
        Unit::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }
}

/// The type of an input or of an output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Type {
    /// A number with its unit.
    Number(Unit),
    /// A whole number.
    Whole,
    /// `true` or `false`.
    Toggle,
    /// One of the listed names, written bare (`plain_sawn`).
    Choice(&'static [&'static str]),
    /// Text in quotes.
    Text,
    /// A path, relative to the recipe's folder; the contents are part of the key.
    File,
    /// Linear Rec. 709 colour; a recipe writes `(r, g, b)` or `"#rrggbb"` (sRGB).
    Colour,
    /// Three numbers of one unit.
    Vector(Unit),
    /// Two numbers of one unit.
    Pair(Unit),
    /// A list in brackets, every item of the inner type.
    List(&'static Type),
    /// A list that may not be empty of named parts: `(at: 1200, direction: (1, 0, 0))`.
    Record(&'static [Input]),
    /// Names of channels, written bare (`base_color`).
    Names,
    /// A map from names to numbers or colours, each a literal or a link.
    Channels,
    /// Trunk and branches as curves.
    Skeleton,
    /// Colour as a function of growth time.
    ColourPattern,
    /// Weather, month by month.
    Climate,
    /// How a tree grew, year by year.
    RingSeries,
    /// Triangles in space.
    Mesh,
    /// Curved surfaces in space, each over a square.
    Patches,
    /// Polygons with holes, in mm.
    Region,
    /// A plane divided into cells.
    Partition,
    /// A bundle of fields.
    Material,
    /// A map from names to materials, each a link; a single link stands for a map of one.
    Materials,
    /// Files to be written, maps or a table: what an output of a recipe is.
    Maps,
}

impl Type {
    /// Whether a recipe can write a value of this type as a literal.
    pub fn has_literals(self) -> bool {
        !self.is_structure() && !matches!(self, Type::Material | Type::Materials | Type::Maps)
    }

    /// Whether values of this type are built once and cached, as opposed to wired or computed per point.
    pub fn is_structure(self) -> bool {
        matches!(
            self,
            Type::Skeleton
                | Type::ColourPattern
                | Type::Climate
                | Type::RingSeries
                | Type::Mesh
                | Type::Patches
                | Type::Region
                | Type::Partition
        )
    }
}

impl fmt::Display for Type {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Type::Number(Unit::One) => write!(formatter, "number"),
            Type::Number(unit) => write!(formatter, "number in {}", unit.symbol()),
            Type::Whole => write!(formatter, "whole number"),
            Type::Toggle => write!(formatter, "toggle (true or false)"),
            Type::Choice(names) => write!(formatter, "one of {}", names.join(", ")),
            Type::Text => write!(formatter, "text"),
            Type::File => write!(formatter, "file name"),
            Type::Colour => write!(formatter, "colour"),
            Type::Vector(Unit::One) => write!(formatter, "vector (x, y, z)"),
            Type::Vector(unit) => write!(formatter, "vector (x, y, z) in {}", unit.symbol()),
            Type::Pair(Unit::One) => write!(formatter, "pair (x, y)"),
            Type::Pair(unit) => write!(formatter, "pair (x, y) in {}", unit.symbol()),
            Type::List(item) => write!(formatter, "list of {item}"),
            Type::Record(parts) => {
                let names: Vec<_> = parts.iter().map(|part| part.name).collect();
                write!(formatter, "record ({})", names.join(", "))
            }
            Type::Names => write!(formatter, "list of names"),
            Type::Channels => write!(formatter, "map from names to values"),
            Type::Skeleton => write!(formatter, "skeleton"),
            Type::ColourPattern => write!(formatter, "colour pattern"),
            Type::Climate => write!(formatter, "climate"),
            Type::RingSeries => write!(formatter, "ring series"),
            Type::Mesh => write!(formatter, "mesh"),
            Type::Patches => write!(formatter, "patches"),
            Type::Region => write!(formatter, "region"),
            Type::Partition => write!(formatter, "partition"),
            Type::Material => write!(formatter, "material"),
            Type::Materials => write!(formatter, "map from names to materials"),
            Type::Maps => write!(formatter, "maps"),
        }
    }
}

/// Where a value is defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Domain {
    /// The same everywhere, so it fits into a solid and onto a plane.
    Everywhere,
    /// At every 3-D point of the uncut material.
    Solid,
    /// At every 2-D point of a flat piece.
    Plane,
}

impl fmt::Display for Domain {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Domain::Everywhere => "constant",
            Domain::Solid => "solid",
            Domain::Plane => "plane",
        })
    }
}
