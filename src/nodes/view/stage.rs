//! Sets the stage of a view: what is shown, from where, and in which light.

use super::camera::Camera;
use super::light::{Disc, Light, Sky};
use super::rays::Stage;
use super::record::Record;
use super::relief::{Guide, Layout, Relief};
use super::scene::{Cut, MOST_CUTS, Scene, Thing};
use super::size_of;
use crate::geometry::mesh::{Open, check_closed};
use crate::node::{Build, Failure, Inputs};
use crate::value::{Domain, Value};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Most lights.
const MOST_LIGHTS: usize = 8;

/// Everything but the materials.
pub(super) fn stage(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    size: [f64; 2],
) -> Result<Stage, Failure> {
    let show = match inputs.get("on") {
        Some(_) => of_mesh(inputs)?,
        None => of_relief(inputs, build, size)?,
    };
    let points = &show.points;
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let reach = (high - low).length();
    let camera = Camera::new(&Record::of(inputs.get("camera")), size, points, show.side)?;
    let lights = inputs.list("lights");
    if lights.len() > MOST_LIGHTS {
        let message = format!(
            "expected at most {MOST_LIGHTS} lights, found {}",
            lights.len()
        );
        return Err(Failure::of_input("lights", message));
    }
    let lights = lights.iter().enumerate();
    let lights = lights.map(|(index, item)| Light::read(item, index, (low + high) * 0.5));
    let mut lights = lights.collect::<Result<Vec<_>, _>>()?;
    if lights.is_empty() {
        lights.push(match show.relief {
            Some(_) => low_sun(&camera),
            None => studio(&camera),
        });
    }
    Ok(Stage {
        guide: show.relief.as_ref().map(|_| Guide::new(size)),
        sky: Sky::read(&Record::of(inputs.get("sky")), directions(inputs), reach),
        scene: Scene {
            things: show.thing.into_iter().collect(),
            relief: show.relief,
            ground: inputs.toggle("ground").then_some(low.z),
            margin: 1e-6 * reach.max(high.abs().max(low.abs()).max_element()),
        },
        camera,
        lights,
        disc: Disc::new(),
    })
}

/// In how many directions above the horizon the sky is looked at.
fn directions(inputs: &Inputs<'_>) -> usize {
    usize::try_from(inputs.whole("samples")).unwrap_or(1)
}

/// What is shown.
struct Show {
    thing: Option<Thing>,
    relief: Option<Relief>,
    /// Points that the picture has to show.
    points: Vec<DVec3>,
    /// From where it is seen best.
    side: DVec3,
}

/// A mesh, cut open.
fn of_mesh(inputs: &Inputs<'_>) -> Result<Show, Failure> {
    for name in ["relief", "thickness"] {
        if inputs.get(name).is_some() {
            let message = format!("`{name}` is set, but `on` gives a shape of its own");
            return Err(Failure::of_input(name, message).with_hint(
                "remove `on` to see a flat piece with its relief on the ground, or remove this",
            ));
        }
    }
    let cuts = inputs.list("cuts").iter().enumerate();
    let cuts = cuts
        .map(|(index, item)| cut(index, item))
        .collect::<Result<Vec<_>, _>>()?;
    if cuts.len() > MOST_CUTS {
        let message = format!("expected at most {MOST_CUTS} cuts, found {}", cuts.len());
        return Err(Failure::of_input("cuts", message));
    }
    if !cuts.is_empty() {
        check_closed(inputs.mesh("on")).map_err(not_closed)?;
    }
    let side = side(&cuts);
    let is_notch = inputs.choice("remove") == "common";
    let thing = Thing::new(Arc::clone(inputs.mesh("on")), cuts, is_notch);
    let points = thing.outline();
    if points.is_empty() {
        return Err(Failure::of_input("cuts", "the cuts leave nothing to see")
            .with_hint("a `normal` points towards what is removed: turn one round"));
    }
    Ok(Show {
        thing: Some(thing),
        relief: None,
        points,
        side,
    })
}

/// A flat piece on the ground.
fn of_relief(inputs: &Inputs<'_>, build: &Build<'_>, pixels: [f64; 2]) -> Result<Show, Failure> {
    let material = inputs.material("of");
    if material.domain == Domain::Solid {
        let message = "an uncut material has no shape, and `on` gives none";
        return Err(Failure::of_input("of", message)
            .with_hint("link `on` to a mesh, or cut a flat piece of the material"));
    }
    let size = DVec2::from_array(size_of(inputs, material)?);
    if !inputs.list("cuts").is_empty() {
        let message = "a flat piece has no inside that cuts could show";
        return Err(Failure::of_input("cuts", message).with_hint("link `on` to a mesh"));
    }
    if inputs.get("bark").is_some() {
        let message = "`bark` is set, but a flat piece is of one material";
        return Err(Failure::of_input("bark", message).with_hint("link `on` to a mesh"));
    }
    let side = DVec3::new(0.4, -1.0, 0.62).normalize();
    let stated = Record::of(inputs.get("camera"));
    // How finely it is seen decides how finely it is sampled, and that how high it is.
    let flat = Camera::new(
        &stated,
        pixels,
        &corners([DVec3::ZERO, size.extend(0.0)]),
        side,
    )?;
    let number = |name: &str| inputs.get(name).map(|_| inputs.number(name));
    let layout = Layout {
        size,
        factor: number("relief").unwrap_or(1.0),
        thickness: number("thickness"),
        finest: flat.finest(size),
        directions: directions(inputs),
    };
    let relief = Relief::new(material, &layout, build)?;
    Ok(Show {
        thing: None,
        points: corners(relief.bounds()),
        relief: Some(relief),
        side,
    })
}

/// The corners of a box.
fn corners([low, high]: [DVec3; 2]) -> Vec<DVec3> {
    let corner = |index: usize| {
        let part = |axis: usize| {
            if index >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        };
        DVec3::new(part(0), part(1), part(2))
    };
    (0..8).map(corner).collect()
}

/// Why a mesh cannot be cut.
fn not_closed(open: Open) -> Failure {
    match open {
        Open::Edges { count, place } => {
            let [x, y, z] = place.to_array();
            let message = format!(
                "the mesh is not closed, so it has no inside that cuts could show: {count} of its edges lie open, \
                 one at ({x:.3}, {y:.3}, {z:.3})"
            );
            Failure::of_input("on", message)
                .with_hint("close the mesh where it is made, or remove the `cuts`")
        }
        Open::InsideOut => Failure::of_input(
            "on",
            "the mesh is inside out: its triangles run clockwise seen from outside",
        )
        .with_hint("turn its triangles round where it is made"),
    }
}

/// One wide light from the left, above and behind the camera.
fn studio(camera: &Camera) -> Light {
    let level = DVec3::new(camera.back().x, camera.back().y, 0.0);
    let direction = level.normalize_or_zero() * 0.7 - camera.right() * 0.75 + DVec3::Z * 0.95;
    let direction = direction.try_normalize().unwrap_or(DVec3::Z);
    Light::distant(direction, 14.0, [0.78, 0.76, 0.73])
}

/// A low sun from the left, a little behind what is seen, so that shadows fall towards the camera.
fn low_sun(camera: &Camera) -> Light {
    let behind = DVec3::new(-camera.back().x, -camera.back().y, 0.0).normalize_or_zero();
    let direction = behind * 0.45 - camera.right() + DVec3::Z * 0.5;
    let direction = direction.try_normalize().unwrap_or(DVec3::Z);
    Light::distant(direction, 1.5, [1.3, 1.2, 1.05])
}

fn cut(index: usize, item: &Value) -> Result<Cut, Failure> {
    let stated = Record::of(Some(item));
    let vector = |name: &str| stated.vector(name).unwrap_or_default();
    let Some(normal) = vector("normal").try_normalize() else {
        let message = format!("the `normal` of cut {} has no length", index + 1);
        return Err(Failure::of_input("cuts", message).at_item(index));
    };
    Ok(Cut {
        point: vector("point"),
        normal,
    })
}

/// The side from which most is seen of the cut faces; from the front where there are none.
fn side(cuts: &[Cut]) -> DVec3 {
    let before: DVec3 = cuts.iter().map(|cut| cut.normal).sum();
    let level = DVec3::new(before.x, before.y, 0.0);
    let front = match level.try_normalize() {
        Some(front) if level.length() > 0.2 * before.length() => front,
        _ => DVec3::NEG_Y,
    };
    // A little from the right, and from above.
    let right = DVec3::Z.cross(front);
    (front + right * 0.45 + DVec3::Z * (0.45 + 0.5 * before.normalize_or_zero().z.max(0.0)))
        .normalize()
}
