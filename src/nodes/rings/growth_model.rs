//! `growth_model`: how weather makes a tree grow, year by year.
//!
//! The growth of a month follows VS-Lite, see `vs_lite`; that of a year is the sum over a window of months. Reserves
//! keep a share k of the year before, `w = (1 - k) w_now + k w_before`. A random factor for each year makes a single
//! tree of the mean of a stand, see `variation`; without a species there is none.
//!
//! Growth adds area to the section. Year n adds `(n^p - (n - 1)^p) w_n / mean` with `p = 2 - slowdown`: equal growth
//! gives rings of one width with slowdown 0 and of one area with 1, Shibasaki & Aoyama, eq. (1). All is scaled so that
//! the mean width of the rings is `ring_width`. Heights follow from diameters by the extended allometry, eq. (2).
//!
//! Trees of a species slow down by 0.4: the last ten of a hundred rings are then half as wide as the first ten, as in
//! measured oaks (4.04 and 1.93 mm), teaks and firs.

pub mod series;
pub mod species;
pub mod statistics;
mod variation;
pub mod vs_lite;

pub use variation::{Band, Variation};

use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::random::Random;
use crate::value::{Climate, Type, Unit, Value};
use series::{Thickening, series, with_reserves};
use species::{Allometry, CONIFER, Species, species_of};
use std::sync::Arc;
use variation::Draw;
use vs_lite::{Thresholds, Window};

/// Makes rings of weather.
pub static KIND: Kind = Kind {
    name: "growth_model",
    version: 1,
    about: "How a tree grew in the weather of a place, year by year: VS-Lite, with sunshine, reserves and the variation \
            of single trees. Without a species it is the mean of a stand.",
    source: "Tolwinski-Ward et al. 2011 (VS-Lite); Thornthwaite 1948; Huang et al. 1996; Shibasaki & Aoyama, eqs. (1), \
             (2); slowdown and variation are our own construction",
    inputs: &[
        Input::new("climate", Type::Climate, "The weather."),
        Input::new(
            "species",
            Type::Choice(&species::NAMES),
            "Gives a single tree its allometry, ring width, slowdown and variation.",
        )
        .optional(),
        Input::new("from", Type::Whole, "The year of the first ring; else the weather's first.")
            .optional()
            .range(1.0, 9999.0),
        Input::new("to", Type::Whole, "The year of the last ring; else the weather's last.")
            .optional()
            .range(1.0, 9999.0),
        Input::new(
            "temperature",
            Type::Pair(Unit::One),
            "T1 and T2 in degrees Celsius: months colder than the first do not grow, warmer than the second are not \
             held back.",
        )
        .default("(4, 14)")
        .range(-50.0, 50.0),
        Input::new(
            "moisture",
            Type::Pair(Unit::One),
            "M1 and M2, the same for the water in the soil as a share of its volume.",
        )
        .default("(0.02, 0.3)")
        .range(0.0, 1.0),
        Input::new(
            "window",
            Type::Pair(Unit::One),
            "First and last month that a ring counts: 1 is January, or July south of the equator; -1 is the month \
             before it, -4 the previous September.",
        )
        .default("(1, 12)")
        .range(-12.0, 12.0),
        Input::new(
            "sunshine",
            Type::Toggle,
            "Whether hours of sunshine count, where the weather has them.",
        )
        .default("true"),
        Input::number(
            "reserve",
            Unit::One,
            "What a year keeps of the growth of the year before.",
        )
        .default("0.3")
        .range(0.0, 0.95),
        Input::number(
            "ring_width",
            Unit::MillimetrePerYear,
            "Mean ring width; else the species' one, or 2.",
        )
        .optional()
        .range(1e-3, 100.0),
        Input::number(
            "slowdown",
            Unit::One,
            "How rings narrow with age: 0 equal widths, 1 equal areas; else 0.4 for a species, or 0.",
        )
        .optional()
        .range(0.0, 1.0),
        Input::number(
            "variation",
            Unit::One,
            "Standard deviation of a single tree's yearly factor, as a logarithm; else what the weather leaves open of \
             the species' mean sensitivity, or 0.",
        )
        .optional()
        .range(0.0, 2.0),
        ALLOMETRY,
        Input::new("seed", Type::Whole, "Another seed is another tree.").default("0"),
    ],
    outputs: &[Output::new("rings", Type::RingSeries, "The tree's years.")],
    example: "(nodes: {
        \"oxford\": weather(file: \"weather/oxforddata.txt\", to: 2020),
        \"example\": growth_model(climate: \"oxford\", species: oak),
    })",
    build,
};

/// The input `allometry`; `ring_series` has the same.
pub(super) const ALLOMETRY: Input = Input::new(
    "allometry",
    Type::Vector(Unit::One),
    "A in m/cm^h, h and H* in m: height by diameter; else the species' one, or (1.2, 1, 35).",
)
.optional()
.range(1e-3, 1e3);

/// How much a species slows down with age.
const SLOWDOWN: f64 = 0.4;

/// Mean ring width in mm without a species.
const RING_WIDTH: f64 = 2.0;

/// Persistence of a variation that the recipe states.
const PERSISTENCE: f64 = 0.4;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let climate = inputs.climate("climate");
    let species = species(inputs);
    let (first_year, growths) = growths(inputs, climate)?;
    build.go_on()?;
    let of_species = |name: &str, species: Option<f64>, otherwise: f64| match inputs.get(name) {
        Some(_) => inputs.number(name),
        None => species.unwrap_or(otherwise),
    };
    let thickening = Thickening {
        ring_width: of_species("ring_width", species.map(|it| it.ring_width), RING_WIDTH),
        slowdown: of_species("slowdown", species.map(|_| SLOWDOWN), 0.0),
    };
    let allometry = allometry(inputs);
    let growths = of_one_tree(inputs, build, species, &thickening, growths);
    let series = series(first_year, thickening.areas(&growths), &allometry);
    if !series.is_sound() {
        let message = "the tree does not grow in each year by as much as a number can show";
        return Err(Failure::new(message).with_hint("choose fewer years"));
    }
    Ok(vec![Value::RingSeries(Arc::new(series))])
}

/// The species, if the recipe names one.
fn species(inputs: &Inputs<'_>) -> Option<&'static Species> {
    inputs.get("species")?;
    species_of(inputs.choice("species"))
}

/// The first year, and the growth of each year in this weather.
fn growths(inputs: &Inputs<'_>, climate: &Climate) -> Result<(i32, Vec<f64>), Failure> {
    let thresholds = Thresholds {
        temperature: thresholds(inputs, "temperature")?,
        moisture: thresholds(inputs, "moisture")?,
    };
    let window = window(inputs)?;
    let months = vs_lite::growth(climate, &thresholds, inputs.toggle("sunshine"));
    let sums = window.sums(&months, climate.latitude);
    if sums.is_empty() {
        let message = "the weather is too short: the window of its only year ends in the next";
        return Err(Failure::of_input("climate", message));
    }
    let grown = with_reserves(&sums, inputs.number("reserve"));
    let last = climate.first_year + grown.len() as i32 - 1;
    let year = |name: &'static str, otherwise: i32| -> Result<i32, Failure> {
        let year = inputs
            .get(name)
            .map_or(otherwise, |_| inputs.whole(name) as i32);
        if (climate.first_year..=last).contains(&year) {
            return Ok(year);
        }
        let message = format!("the weather gives no ring of the year {year}");
        let hint = format!("it gives those of {} to {last}", climate.first_year);
        Err(Failure::of_input(name, message).with_hint(hint))
    };
    let (from, to) = (year("from", climate.first_year)?, year("to", last)?);
    if from > to {
        let message = format!("the years end before they begin: {from} to {to}");
        return Err(Failure::of_input("to", message));
    }
    let index = |year: i32| (year - climate.first_year) as usize;
    let chosen = &grown[index(from)..=index(to)];
    if chosen.iter().sum::<f64>() <= 0.0 {
        let message = "in this weather nothing grows: it is too cold or too dry in every month";
        let hint = "lower the first of `temperature` or of `moisture`, or widen the `window`";
        return Err(Failure::of_input("climate", message).with_hint(hint));
    }
    Ok((from, chosen.to_vec()))
}

fn thresholds(inputs: &Inputs<'_>, name: &'static str) -> Result<[f64; 2], Failure> {
    let [low, high] = inputs.pair(name);
    if low < high {
        return Ok([low, high]);
    }
    let message = format!("growth has to begin below where it is not held back: {low}, {high}");
    Err(Failure::of_input(name, message))
}

fn window(inputs: &Inputs<'_>) -> Result<Window, Failure> {
    let [first, last] = inputs.pair("window");
    if let Some(month) = [first, last]
        .into_iter()
        .find(|month| month.fract() != 0.0 || *month == 0.0)
    {
        let message = format!("expected months from -12 to -1 or from 1 to 12, found {month}");
        return Err(Failure::of_input("window", message));
    }
    if first > last {
        let message = format!("the window ends before it begins: {first} to {last}");
        let hint =
            "months of the previous year are negative: (-4, 12) is from September to December";
        return Err(Failure::of_input("window", message).with_hint(hint));
    }
    Ok(Window {
        first: first as i32,
        last: last as i32,
    })
}

/// The allometry that the recipe states, or that of its species.
pub(super) fn allometry(inputs: &Inputs<'_>) -> Allometry {
    if inputs.get("allometry").is_none() {
        return species(inputs).map_or(CONIFER, |species| species.allometry);
    }
    let [factor, exponent, most] = inputs.vector("allometry").to_array();
    Allometry {
        factor,
        exponent,
        most,
    }
}

/// Growth with the variation of a single tree, if there is one.
fn of_one_tree(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    species: Option<&Species>,
    thickening: &Thickening,
    growths: Vec<f64>,
) -> Vec<f64> {
    let mut random = Random::new(build.seed, KIND.name, inputs.whole("seed"));
    let draw = Draw::new(&mut random, growths.len());
    let varied = |factors: &[f64]| -> Vec<f64> {
        let pairs = growths.iter().zip(factors);
        pairs.map(|(growth, factor)| growth * factor).collect()
    };
    let variation = match (inputs.get("variation"), species) {
        (None, None) => return growths,
        (Some(_), _) => Variation {
            amplitude: inputs.number("variation"),
            persistence: PERSISTENCE,
        },
        (None, Some(species)) => {
            let band = species.band.of_one_tree(&mut random);
            draw.fitted(band, |factors| thickening.widths(&varied(factors)))
        }
    };
    varied(&draw.factors(variation))
}
