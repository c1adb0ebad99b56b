//! How large charges are: of branches by their thickness, of burls by how far they swell, or drawn at random.

use super::{Axis, Burl, Rod};
use crate::nodes::random::Random;
use crate::value::{Branch, RingSeries, Thickness};
use glam::DVec3;
use std::f64::consts::{LN_2, PI};

/// The branches as rods.
///
/// A branch has its border where its energy is 2 ln 2: there it halves the radius. So one that is w thick to
/// each side at the distance d along it has the charge `2 ln 2 / (asinh((L - d) / w) + asinh(d / w))`. One that
/// thickens at a speed v has half of its age at the middle of its length: w = v age / 2 at d = L / 2. A branch
/// of unknown length has grown long as fast as the tree on the average, or is half as long again as the
/// distance at which its thickness is known (own construction; the paper states no charges).
///
/// # Errors
/// What is wrong with a branch, and which, counted from 0.
pub fn branch_rods(
    branches: &[Branch],
    charges: Option<&[f64]>,
    axis: &Axis,
    rings: &RingSeries,
) -> Result<Vec<Rod>, (usize, String)> {
    let years = rings.years() as f64;
    let speed = rings.heights[rings.years() - 1] / years;
    let rod = |(index, branch): (usize, &Branch)| {
        let age = years - rings.time_of_height(branch.height);
        let (known, distance, half_width) = match branch.thickness {
            Thickness::Speed(thickening) => {
                let length = branch.length.unwrap_or(speed * age);
                (length, 0.5 * length, 0.5 * thickening * age)
            }
            Thickness::HalfWidth {
                distance,
                half_width,
            } => (1.5 * distance, distance, half_width),
        };
        let mut rod = Rod {
            start: axis.at(branch.height),
            direction: branch.direction,
            length: branch.length.unwrap_or(known),
            charge: 1.0,
        };
        let given = charges.and_then(|charges| charges.get(index));
        if age <= 0.0 && (given.is_none() || rod.length <= 0.0) {
            let message = "it starts above the top of the tree, where it has no age".to_owned();
            return Err((index, message));
        }
        let at_border = || {
            let ahead = libm::asinh((rod.length - distance) / half_width);
            2.0 * LN_2 / (ahead + libm::asinh(distance / half_width))
        };
        rod.charge = given.copied().unwrap_or_else(at_border);
        Ok(rod)
    };
    branches.iter().enumerate().map(rod).collect()
}

/// The charge in mm of a burl that swells the bark, `bark` mm from the axis, to `radius` mm beyond its own
/// centre, which is `depth` mm from the axis: `q = 2 d ln((c + d) / R)`, from V1.
///
/// # Errors
/// If the bark is there already, or if there is none.
pub fn swelling_charge(depth: f64, radius: f64, bark: f64) -> Result<f64, String> {
    if bark <= 0.0 {
        return Err("it is above the top of the tree, where there is no bark to swell".into());
    }
    let charge = 2.0 * radius * libm::log((depth + radius) / bark);
    if charge > 0.0 {
        return Ok(charge);
    }
    Err(format!(
        "it ends {:.1} mm from the axis, inside the bark, which is {bark:.1} mm away",
        depth + radius
    ))
}

/// Where burls are drawn, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BurlSettings {
    /// How many.
    pub count: usize,
    /// Smallest and largest charge in mm.
    pub charges: [f64; 2],
    /// Lowest and highest height in mm.
    pub heights: [f64; 2],
    /// Smallest and largest distance from the axis, as a share of the bark's.
    pub depths: [f64; 2],
}

/// Burls at random, evenly in height and angle, and in the section's area between the depths.
pub(in crate::nodes::wood) fn random_burls(
    settings: &BurlSettings,
    mut random: Random,
    axis: &Axis,
    rings: &RingSeries,
) -> Vec<Burl> {
    let mut between = |[low, high]: [f64; 2]| low + (high - low) * f64::from(random.share());
    let burl = |_| {
        let height = between(settings.heights);
        let angle = between([0.0, 2.0 * PI]);
        let depth = between(settings.depths.map(|depth| depth * depth)).sqrt();
        let distance = depth * bark_radius(rings, height);
        let across = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0) * distance;
        Burl {
            centre: axis.at(height) + across,
            charge: between(settings.charges),
        }
    };
    (0..settings.count).map(burl).collect()
}

/// Distance of the bark from the axis in mm, at a height in mm; 0 above the tip.
pub fn bark_radius(rings: &RingSeries, height: f64) -> f64 {
    let last = rings.areas[rings.years() - 1];
    let inner = rings.area_at(rings.time_of_height(height));
    ((last - inner) / PI).max(0.0).sqrt()
}
