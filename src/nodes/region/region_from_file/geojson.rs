//! Polygons of a GeoJSON file (RFC 7946).

use super::projection::Projection;
use super::{Drawn, check_parts, refuse};
use crate::node::{Failure, Inputs, counted};
use crate::value::Polygon;
use glam::DVec2;
use serde_json::Value;

/// How far from the centre the projection reaches, in degrees of longitude.
const FARTHEST: f64 = 3.0;

/// A polygon in degrees, with what it belongs to.
struct Found {
    names: Vec<String>,
    rings: Vec<Vec<DVec2>>,
}

/// What a file has.
#[derive(Default)]
struct Contents {
    found: Vec<Found>,
    /// Points and lines, which enclose nothing.
    others: usize,
    unclosed: usize,
}

/// The polygons that belong to `parts`, in mm around their middle.
pub(super) fn read(
    text: &str,
    parts: &[String],
    inputs: &Inputs<'_>,
) -> Result<Vec<Drawn>, Failure> {
    let file: Value = serde_json::from_str(text)
        .map_err(|error| refuse(format!("the file is no JSON: {error}")))?;
    let mut contents = Contents::default();
    contents.add(&file, &[], "")?;
    let is_called = |found: &Found, part: &str| found.names.iter().any(|name| name == part);
    let names = contents
        .found
        .iter()
        .filter_map(|found| found.names.last().cloned());
    let has = |part: &str| contents.found.iter().any(|found| is_called(found, part));
    check_parts(parts, has, names.collect())?;
    contents
        .found
        .retain(|found| parts.is_empty() || parts.iter().any(|part| is_called(found, part)));
    if contents.unclosed > 0 {
        let rings = counted(
            contents.unclosed,
            "ring does not end where it began; it is",
            "rings do not end where they began; they are",
        );
        inputs.warn(format!("{rings} closed"));
    }
    if contents.found.is_empty() && contents.others > 0 {
        let message = format!(
            "the file has {} points and lines, but no areas",
            contents.others
        );
        return Err(refuse(message));
    }
    project(contents.found)
}

/// Moves what lies west of the meridian of 180 degrees to the east, if the areas then are nearer together.
fn join_at_antimeridian(found: &mut [Found]) {
    let span = |found: &[Found], west: f64| {
        let corners = found.iter().flat_map(|found| found.rings.iter().flatten());
        let longitudes = corners.map(|at| at.x + if at.x < 0.0 { west } else { 0.0 });
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = longitudes.fold(ends, |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    if span(found, 360.0) < span(found, 0.0) {
        let corners = found
            .iter_mut()
            .flat_map(|found| found.rings.iter_mut().flatten());
        corners.filter(|at| at.x < 0.0).for_each(|at| at.x += 360.0);
    }
}

/// Degrees to mm.
fn project(mut found: Vec<Found>) -> Result<Vec<Drawn>, Failure> {
    join_at_antimeridian(&mut found);
    let corners = || {
        found
            .iter()
            .flat_map(|found| found.rings.iter().flatten().copied())
    };
    let Some(first) = corners().next() else {
        return Ok(vec![]);
    };
    let (low, high) = corners().fold((first, first), |(low, high), at| {
        (low.min(at), high.max(at))
    });
    let centre = 0.5 * (low + high);
    if high.x - centre.x > FARTHEST {
        let message = format!(
            "the areas span {:.1} degrees of longitude; at most {} are projected",
            high.x - low.x,
            2.0 * FARTHEST
        );
        return Err(refuse(message).with_hint("choose some of them by `parts`"));
    }
    let projection = Projection::around(centre);
    let drawn = found.into_iter().enumerate().map(|(number, found)| {
        let ring = |ring: Vec<DVec2>| ring.into_iter().map(|at| projection.place(at)).collect();
        let mut rings = found.rings.into_iter().map(ring);
        Drawn {
            polygon: Polygon {
                outline: rings.next().unwrap_or_default(),
                holes: rings.collect(),
            },
            name: match found.names.last() {
                Some(name) => format!("`{name}`"),
                None => format!("polygon {}", number + 1),
            },
        }
    });
    Ok(drawn.collect())
}

impl Contents {
    /// Adds all that is in an object; `names` are those of what it is in, and `at` says where it is in the file.
    fn add(&mut self, object: &Value, names: &[String], at: &str) -> Result<(), Failure> {
        let Some(kind) = object.get("type").and_then(Value::as_str) else {
            let message = format!("the file is no GeoJSON: {} has no `type`", place(at));
            return Err(refuse(message).with_hint("GeoJSON (RFC 7946) and SVG are read"));
        };
        let list = |name: &str| {
            object
                .get(name)
                .and_then(Value::as_array)
                .cloned()
                .unwrap_or_default()
        };
        match kind {
            "FeatureCollection" => self.add_all(&list("features"), names, &inner(at, "features")),
            "GeometryCollection" => {
                self.add_all(&list("geometries"), names, &inner(at, "geometries"))
            }
            "Feature" => match object.get("geometry") {
                None | Some(Value::Null) => Ok(()),
                Some(geometry) => self.add(geometry, &names_of(object), &inner(at, "geometry")),
            },
            "Polygon" => self.add_polygon(&list("coordinates"), names, &inner(at, "coordinates")),
            "MultiPolygon" => {
                let polygons = list("coordinates");
                let at = inner(at, "coordinates");
                polygons
                    .iter()
                    .enumerate()
                    .try_for_each(|(index, polygon)| {
                        let rings = polygon.as_array().cloned().unwrap_or_default();
                        self.add_polygon(&rings, names, &format!("{at}[{index}]"))
                    })
            }
            "Point" | "MultiPoint" | "LineString" | "MultiLineString" => {
                self.others += 1;
                Ok(())
            }
            other => {
                let message = format!(
                    "{} has the type `{other}`, which is none of GeoJSON",
                    place(at)
                );
                Err(refuse(message))
            }
        }
    }

    fn add_all(&mut self, items: &[Value], names: &[String], at: &str) -> Result<(), Failure> {
        let mut items = items.iter().enumerate();
        items.try_for_each(|(index, it)| self.add(it, names, &format!("{at}[{index}]")))
    }

    fn add_polygon(&mut self, rings: &[Value], names: &[String], at: &str) -> Result<(), Failure> {
        let mut read = vec![];
        for (number, ring) in rings.iter().enumerate() {
            let ring = ring.as_array().map(Vec::as_slice).unwrap_or_default();
            let corners = ring.iter().enumerate();
            let ring: Vec<DVec2> = corners
                .map(|(index, corner)| position(corner, || format!("{at}[{number}][{index}]")))
                .collect::<Result<_, _>>()?;
            self.unclosed += usize::from(ring.first() != ring.last());
            read.push(ring);
        }
        self.found.push(Found {
            names: names.to_vec(),
            rings: read,
        });
        Ok(())
    }
}

/// The path of a part of an object: `features[2].geometry`, indices from 0.
fn inner(at: &str, part: &str) -> String {
    match at {
        "" => part.to_owned(),
        _ => format!("{at}.{part}"),
    }
}

/// An object in a message.
fn place(at: &str) -> String {
    match at {
        "" => "its object".to_owned(),
        _ => format!("`{at}`"),
    }
}

/// The id of a feature and its name, which comes last.
fn names_of(feature: &Value) -> Vec<String> {
    let name = feature
        .get("properties")
        .and_then(|properties| properties.get("name"));
    let text = |value: &Value| match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    };
    let both = [feature.get("id"), name].into_iter().flatten();
    both.filter_map(text).collect()
}

/// Longitude and latitude in degrees; `at` says where they are in the file.
fn position(value: &Value, at: impl Fn() -> String) -> Result<DVec2, Failure> {
    let part = |index: usize| value.get(index).and_then(Value::as_f64);
    match (part(0), part(1)) {
        (Some(x), Some(y)) if x.abs() <= 360.0 && y.abs() < 90.0 => Ok(DVec2::new(x, y)),
        _ => {
            let mut found = value.to_string();
            found.truncate(found.char_indices().nth(40).map_or(found.len(), |it| it.0));
            let message = format!(
                "expected longitude and latitude in degrees at `{}`, found `{found}`",
                at()
            );
            Err(refuse(message)
                .with_hint("GeoJSON has coordinates of WGS 84; export the file anew in them"))
        }
    }
}
