//! Where seeds are: anywhere, on lattices, or as given.

use super::super::division::Plot;
use super::density::Density;
use crate::node::{Failure, Inputs};
use crate::nodes::random::Random;
use crate::value::Value;
use glam::DVec2;

/// The ways in which seeds lie.
pub(super) const NAMES: [&str; 5] = ["random", "jittered", "hexagonal", "square", "given"];

/// Most seeds of one plot.
const MOST: f64 = 4e6;

/// How seeds are laid.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    name: &'static str,
    points: Vec<DVec2>,
    size: Size,
    jitter: Option<f64>,
    weights: Option<[f64; 2]>,
    radii: Vec<f64>,
    areas: Option<[f64; 2]>,
    pub(super) relax: i64,
}

#[derive(Clone, Copy, Debug)]
enum Size {
    /// The side of a square as large as a mean cell.
    Side(f64),
    Count(f64),
    /// Seeds are given.
    Given,
}

/// Seeds of one plot.
#[derive(Clone, Debug)]
pub(super) struct Seeds {
    pub(super) places: Vec<DVec2>,
    /// The squares of the circles' radii; empty if there are no circles.
    pub(super) weights: Vec<f64>,
    /// What the areas of their cells are in the ratio of; empty if that is free.
    pub(super) shares: Vec<f64>,
    /// How much wider and higher than asked for the lattice is.
    pub(super) stretch: DVec2,
}

impl Layout {
    /// What the inputs state.
    ///
    /// # Errors
    /// If they contradict each other.
    pub(super) fn read(inputs: &Inputs<'_>) -> Result<Layout, Failure> {
        let name = inputs.choice("seeds");
        let points = points(inputs, name)?;
        let layout = Layout {
            name,
            size: size(inputs, name)?,
            jitter: inputs.get("jitter").map(|_| inputs.number("jitter")),
            weights: inputs.get("weights").map(|_| inputs.pair("weights")),
            radii: radii(inputs, points.len())?,
            areas: inputs.get("areas").map(|_| inputs.pair("areas")),
            relax: inputs.whole("relax"),
            points,
        };
        layout.checked(inputs)
    }

    /// The layout, unless ranges are none or inputs contradict each other.
    fn checked(self, inputs: &Inputs<'_>) -> Result<Layout, Failure> {
        for (name, range) in [("weights", self.weights), ("areas", self.areas)] {
            if let Some([low, high]) = range.filter(|[low, high]| low > high) {
                let message =
                    format!("expected a range from low to high, found from {low} to {high}");
                return Err(Failure::of_input(name, message));
            }
        }
        let stated = ["weights", "radii", "areas"];
        let mut stated = stated.into_iter().filter(|name| inputs.get(name).is_some());
        if let (Some(first), Some(second)) = (stated.next(), stated.next()) {
            let message = format!("`{first}` and `{second}` both say how heavy the seeds are");
            return Err(Failure::of_input(second, message).with_hint("keep one of them"));
        }
        if inputs.get("density").is_some() && self.name != "random" && self.relax == 0 {
            let message =
                "the density says where random seeds are, and where relaxation moves others";
            return Err(Failure::of_input("density", message)
                .with_hint("write `seeds: \"random\"`, or `relax` the seeds"));
        }
        Ok(self)
    }

    /// Refuses more cells than one partition may have, over all plots.
    ///
    /// # Errors
    /// If there would be too many.
    pub(super) fn check_count(&self, plots: &[Plot]) -> Result<(), Failure> {
        let (input, each) = match self.size {
            Size::Count(count) => ("count", count * plots.len() as f64),
            Size::Given => ("points", (self.points.len() * plots.len()) as f64),
            Size::Side(side) => {
                let area: f64 = plots.iter().map(Plot::area).sum();
                ("cell_size", area / (side * side))
            }
        };
        if each <= MOST {
            return Ok(());
        }
        let message = format!("expected at most {MOST} cells, found about {each:.0}");
        let hint = match plots.len() {
            1 => "choose larger cells".to_owned(),
            parts => {
                format!("choose larger cells: each of the {parts} cells of `within` is divided")
            }
        };
        Err(Failure::of_input(input, message).with_hint(hint))
    }

    /// The seeds of a plot.
    ///
    /// # Errors
    /// If there would be too many, or the density is 0 everywhere.
    pub(super) fn seeds(
        &self,
        plot: &Plot,
        density: &Density<'_>,
        mut random: Random,
    ) -> Result<Seeds, Failure> {
        let area = plot.area();
        let side = match self.size {
            Size::Side(side) => side,
            Size::Count(count) => (area / count).sqrt(),
            Size::Given => (area / self.points.len() as f64).sqrt(),
        };
        let [low, high] = plot.bounds();
        if self.name != "given" && (high - low).x * (high - low).y / (side * side) > MOST {
            let message = format!("expected at most {MOST} cells, found more");
            return Err(Failure::of_input("cell_size", message).with_hint("choose larger cells"));
        }
        let mut stretch = DVec2::ONE;
        let places = match self.name {
            "given" => self.points.clone(),
            "random" => {
                let count = (area / (side * side)).round().max(1.0) as usize;
                density.seeds(plot, count, &mut random)?
            }
            name => {
                let lattice = Lattice::new(plot, side, name == "hexagonal");
                stretch = lattice.stretch;
                lattice.places(self.jitter, name == "jittered", &mut random)
            }
        };
        let mut drawn = |range: Option<[f64; 2]>| -> Vec<f64> {
            let range = range.into_iter().cycle().take(places.len());
            range.map(|range| random.between(range)).collect()
        };
        let radii = drawn(self.weights);
        let radii = radii.iter().map(|radius| 0.5 * side * radius);
        Ok(Seeds {
            shares: drawn(self.areas),
            weights: self
                .radii
                .iter()
                .copied()
                .chain(radii)
                .map(|radius| radius * radius)
                .collect(),
            places,
            stretch,
        })
    }
}

fn points(inputs: &Inputs<'_>, name: &str) -> Result<Vec<DVec2>, Failure> {
    match (name, inputs.get("points").is_some()) {
        ("given", false) => Err(Failure::of_input(
            "seeds",
            "the seeds are given, but there are no `points`",
        )),
        ("given", true) => {
            let points = inputs.list("points").iter().filter_map(|item| match item {
                Value::Pair(pair) => Some(DVec2::from_array(*pair)),
                _ => None,
            });
            let points: Vec<DVec2> = points.collect();
            if points.is_empty() {
                return Err(Failure::of_input(
                    "points",
                    "expected at least one seed, found none",
                ));
            }
            Ok(points)
        }
        (_, true) => Err(Failure::of_input(
            "points",
            "there are `points`, but the seeds are not given",
        )
        .with_hint("write `seeds: \"given\"`")),
        (_, false) => Ok(vec![]),
    }
}

fn radii(inputs: &Inputs<'_>, points: usize) -> Result<Vec<f64>, Failure> {
    if inputs.get("radii").is_none() {
        return Ok(vec![]);
    }
    let radii: Vec<f64> = inputs
        .list("radii")
        .iter()
        .filter_map(Value::as_number)
        .collect();
    if radii.len() != points {
        let message = format!(
            "expected {points} radii, one for each of the `points`, found {}",
            radii.len()
        );
        return Err(Failure::of_input("radii", message));
    }
    Ok(radii)
}

fn size(inputs: &Inputs<'_>, name: &str) -> Result<Size, Failure> {
    match (
        name,
        inputs.get("cell_size").is_some(),
        inputs.get("count").is_some(),
    ) {
        ("given", false, false) => Ok(Size::Given),
        (_, true, false) => Ok(Size::Side(inputs.number("cell_size"))),
        (_, false, true) => Ok(Size::Count(inputs.whole("count") as f64)),
        (_, true, true) => Err(Failure::of_input(
            "count",
            "`cell_size` and `count` both say how large cells are",
        )
        .with_hint("keep one of them")),
        _ => Err(Failure::new("nothing says how large cells are")
            .with_hint("state a `cell_size` or a `count`")),
    }
}

/// Rows of places over the rectangle around a plot.
struct Lattice {
    low: DVec2,
    /// From place to place along a row, and from row to row.
    step: DVec2,
    columns: i64,
    rows: i64,
    hexagonal: bool,
    /// Whether there are no places beyond the rectangle.
    closed: bool,
    /// The side of a cell.
    side: f64,
    stretch: DVec2,
}

impl Lattice {
    /// A lattice of cells as large as a square with this side; it fits a rectangle, and closes where that repeats.
    fn new(plot: &Plot, side: f64, hexagonal: bool) -> Lattice {
        let [low, high] = plot.bounds();
        let width = if hexagonal {
            side * (4.0_f64 / 3.0).sqrt().sqrt()
        } else {
            side
        };
        let wanted = DVec2::new(width, side * side / width);
        let mut count = ((high - low) / wanted).round().max(DVec2::ONE);
        let closed = plot.period.is_some();
        if hexagonal && closed {
            count.y = 2.0 * (0.5 * count.y).round().max(1.0);
        }
        let step = match plot.is_rectangle() {
            true => (high - low) / count,
            false => wanted,
        };
        if !plot.is_rectangle() {
            count = ((high - low) / wanted).ceil();
        }
        Lattice {
            low,
            step,
            columns: count.x as i64,
            rows: count.y as i64,
            hexagonal,
            closed,
            side: if hexagonal {
                width / 3.0_f64.sqrt()
            } else {
                side
            },
            stretch: step / wanted,
        }
    }

    /// The places, each moved at random.
    fn places(&self, jitter: Option<f64>, in_square: bool, random: &mut Random) -> Vec<DVec2> {
        let mut moved = |at: DVec2| match (in_square, jitter) {
            (true, jitter) => {
                let mut share = || jitter.unwrap_or(1.0) * (f64::from(random.share()) - 0.5);
                at + self.step * DVec2::new(share(), share())
            }
            (false, Some(jitter)) if jitter > 0.0 => {
                at + jitter * self.side * DVec2::new(random.normal(), random.normal())
            }
            _ => at,
        };
        let more = if self.closed { 0 } else { 1 };
        let mut places = vec![];
        for row in -more..self.rows + more {
            let aside = if self.hexagonal && row.rem_euclid(2) == 1 {
                0.5
            } else {
                0.0
            };
            for column in -more..self.columns + more {
                let at = DVec2::new(column as f64 + aside, row as f64)
                    + DVec2::new(0.25 + 0.25 * f64::from(!self.hexagonal), 0.5);
                places.push(moved(self.low + at * self.step));
            }
        }
        places
    }
}
