//! `region_from_file`: a part of the plane from a GeoJSON or an SVG file.
//!
//! Of GeoJSON (RFC 7946) are read polygons and multipolygons, alone, in features and in collections. Longitude and latitude of
//! WGS 84 become mm by a transverse Mercator projection whose centre is the middle of what is read, with scale 1 there: lengths are right to
//! a billionth over some hundred metres. North is up.
//!
//! Of SVG (2, W3C 2018) are read paths, polygons, polylines, rectangles, circles and ellipses with their transforms, in groups and by `use`;
//! what is filled counts, by the fill rule of each, whatever its colour. The page's size gives mm; without one, 96 units are an inch. Up is up.
//!
//! Curves become straight edges that are nowhere farther off than `tolerance`. Outlines are mended as those of `region`.

mod geojson;
mod path;
mod pen;
mod projection;
mod svg;

use super::mended::mended;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Polygon, Region, Type, Unit, Value};
use glam::DVec2;
use std::sync::Arc;

/// A part of the plane from a file.
pub static KIND: Kind = Kind {
    name: "region_from_file",
    version: 3,
    about: "A part of the plane from a GeoJSON file (longitude and latitude become mm) or from the filled shapes of an SVG \
            file.",
    source: "RFC 7946; SVG 2 (W3C 2018); transverse Mercator after Snyder 1987, eqs. (3-21), (8-9), (8-10)",
    inputs: &[
        Input::new("file", Type::File, "A GeoJSON or an SVG file."),
        Input::new(
            "parts",
            Type::List(&Type::Text),
            "Ids or names of features, or ids of elements and groups, to take; none takes all.",
        )
        .default("[]"),
        Input::number("turn", Unit::Degree, "Turns it, counterclockwise.").default("0").range(-360.0, 360.0),
        Input::number("scale", Unit::One, "Makes it larger or smaller.").default("1").range(1e-9, 1e9),
        Input::new(
            "origin",
            Type::Choice(&["corner", "centre", "file"]),
            "What comes to lie `at` the stated point: the lower left corner of the box around it, the box's middle, or the file's own \
             origin, which is the page's lower left corner, or the centre of the projection.",
        )
        .default("corner"),
        Input::new("at", Type::Pair(Unit::Millimetre), "Where the origin comes to lie.")
            .default("(0, 0)")
            .range(-1e9, 1e9),
        Input::number("tolerance", Unit::Millimetre, "How far straight edges may be off a curve.")
            .default("0.01")
            .range(1e-6, 1e4),
    ],
    outputs: &[Output::new("region", Type::Region, "The part of the plane.")],
    example: "(nodes: {
        \"example\": region_from_file(file: \"outlines/fischmarktplatz.geojson\"),
    })",
    build,
};

/// A polygon of a file, and what to call it.
struct Drawn {
    polygon: Polygon,
    name: String,
}

/// What is wrong with the file.
fn refuse(message: impl Into<String>) -> Failure {
    Failure::of_input("file", message)
}

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let parts = parts(inputs);
    let bytes = &inputs.file("file").bytes;
    let Ok(text) = std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)) else {
        return Err(refuse("the file is no text in UTF-8"));
    };
    let mut drawn = match text.trim_start().chars().next() {
        None => return Err(refuse("the file is empty")),
        Some('<') => svg::read(text, &parts, inputs, build)?,
        Some(_) => geojson::read(text, &parts, inputs)?,
    };
    if drawn.is_empty() {
        let hint = "polygons of GeoJSON and filled shapes of SVG are read";
        return Err(refuse("the file has no areas").with_hint(hint));
    }
    place(inputs, &mut drawn);
    let polygons: Vec<Polygon> = drawn.iter().map(|it| it.polygon.clone()).collect();
    let name = |number: usize, hole: Option<usize>| match hole {
        None => drawn[number].name.clone(),
        Some(hole) => format!("hole {} of {}", hole + 1, drawn[number].name),
    };
    let region = mended(inputs, "file", &polygons, &name).map_err(|failure| Failure {
        item: None,
        ..failure
    })?;
    Ok(vec![Value::Region(Arc::new(moved(inputs, region)))])
}

fn parts(inputs: &Inputs<'_>) -> Vec<String> {
    let text = |item: &Value| match item {
        Value::Text(text) => Some(text.clone()),
        _ => None,
    };
    inputs.list("parts").iter().filter_map(text).collect()
}

/// Checks that all `parts` were found among the names.
fn check_parts(
    parts: &[String],
    has: impl Fn(&str) -> bool,
    names: Vec<String>,
) -> Result<(), Failure> {
    let Some(index) = parts.iter().position(|part| !has(part)) else {
        return Ok(());
    };
    let shown: Vec<String> = names
        .iter()
        .take(8)
        .map(|name| format!("`{name}`"))
        .collect();
    let more = if names.len() > 8 { ", ..." } else { "" };
    let failure = Failure::of_input(
        "parts",
        format!("the file has no area called `{}`", parts[index]),
    );
    let hint = match shown.is_empty() {
        true => "no area of the file has a name".to_owned(),
        false => format!("there are {}{more}", shown.join(", ")),
    };
    Err(failure.at_item(index).with_hint(hint))
}

/// Turns and scales what was read.
fn place(inputs: &Inputs<'_>, drawn: &mut [Drawn]) {
    let (sine, cosine) = libm::sincos(inputs.number("turn").to_radians());
    let turn = DVec2::new(cosine, sine) * inputs.number("scale");
    for it in drawn {
        let holes = it.polygon.holes.iter_mut().flatten();
        let corners = it.polygon.outline.iter_mut().chain(holes);
        corners.for_each(|corner| *corner = turn.rotate(*corner));
    }
}

/// The region with its origin where it is wanted.
fn moved(inputs: &Inputs<'_>, mut region: Region) -> Region {
    let [low, high] = super::combine_regions::bounds([&region]);
    let origin = match inputs.choice("origin") {
        "corner" => low,
        "centre" => 0.5 * (low + high),
        _ => DVec2::ZERO,
    };
    let by = DVec2::from_array(inputs.pair("at")) - origin;
    for polygon in &mut region.polygons {
        let holes = polygon.holes.iter_mut().flatten();
        let corners = polygon.outline.iter_mut().chain(holes);
        corners.for_each(|corner| *corner += by);
    }
    region
}
