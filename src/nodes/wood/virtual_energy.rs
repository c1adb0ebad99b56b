//! `virtual_energy`: when the wood at each point of a tree grew, by surfaces of equal energy around charges.
//!
//! Shibasaki & Aoyama: the centre lines of trunk and branches carry line charge, burls carry point charge, and
//! rings and bark are surfaces of equal energy. With the charge 1 along the trunk, lambda along a branch from a
//! to b of length L, and q in a burl at c,
//!
//! ```text
//! line without ends  U = -2 ln r                               r the distance from it in mm
//! rod                U = lambda (asinh((L - s) / r) + asinh(s / r))    s along it from a, r from its line
//! burl               U = q / |P - c|
//! E = sum of all U
//! ```
//!
//! The paper does not say which radius an energy stands for. `reference` chooses:
//!
//! ```text
//! endless  r_eq = e^(-E / 2), the trunk being a line without ends: on a bare trunk r_eq = r           (V1)
//! middle   r_eq = (L / 2) / sinh(E / 2), the trunk being a rod: on a bare trunk r_eq = r at its middle (V2)
//! local    r_eq = (L / 2) / sinh(E / 2) sqrt(1 - ((s - L / 2) / a)^2), a = (L / 2) coth(E / 2)        (V3)
//! ```
//!
//! The growth time is that of the ring whose radius at this height is r_eq - w, with the waves
//! `w = sum a sin(2 pi z / l + m phi + psi)` over height z and angle phi about the axis. Ring n of the series
//! reaches to `sqrt((S_n - S_m) / pi)` where the tree was as tall as z at the time m. Within twice the sum of
//! all amplitudes from the pith the waves fade, so that time rises strictly outwards (own construction).
//!
//! What charges branches have follows from their thickness: where its energy is 2 ln 2 a branch halves the
//! radius, and there is its border. Burls take a charge, or the distance that they swell the bark to.

use super::energy::{
    Axis, Burl, BurlSettings, EnergyKernel, EnergyModel, Reference, Wave, bark_radius, branch_rods,
    random_burls, swelling_charge,
};
use super::ring_time::RingTime;
use crate::field::Field;
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::nodes::field::combine::Join;
use crate::nodes::field::threshold::below;
use crate::nodes::random::Random;
use crate::value::{Domain, RingSeries, Type, Unit, Value};

/// Growth time by virtual energy.
pub static KIND: Kind = Kind {
    name: "virtual_energy",
    version: 2,
    about: "When the wood at each point grew, by equal energy around a trunk, its branches and burls, with waves in \
            the rings.",
    source: "Shibasaki & Aoyama, section 2.3; references, charges and the fading of waves are our own construction",
    inputs: &[
        Input::new("skeleton", Type::Skeleton, "Trunk and branches."),
        Input::new("rings", Type::RingSeries, "How the trunk grew, year by year."),
        Input::new(
            "axis",
            Type::Choice(&["curved", "straight"]),
            "Whether the trunk runs curved through its nodes or straight from node to node.",
        )
        .default("curved"),
        Input::new(
            "reference",
            Type::Choice(&["endless", "middle", "local"]),
            "To which trunk energies are compared: V1, V2, V3.",
        )
        .default("endless"),
        Input::new(
            "branch_charges",
            Type::List(&Type::Number(Unit::One)),
            "The charge of each branch, the trunk having 1; without them they follow from thickness and length.",
        )
        .optional()
        .range(0.0, 100.0),
        Input::new("burls", Type::List(&Type::Record(BURL)), "Burls at places of your own.").default("[]"),
        Input::new("random_burls", Type::Whole, "Number of burls at random.")
            .default("0")
            .range(0.0, 100_000.0),
        Input::new(
            "burl_charges",
            Type::Pair(Unit::Millimetre),
            "Smallest and largest charge of burls at random.",
        )
        .default("(1, 5)")
        .range(0.0, 1e5),
        Input::new(
            "burl_heights",
            Type::Pair(Unit::Millimetre),
            "Between which heights they are; without it along the trunk, up to the tree's top.",
        )
        .optional()
        .range(-1e6, 1e6),
        Input::new(
            "burl_depths",
            Type::Pair(Unit::One),
            "Between which distances from the axis they are, the bark's being 1.",
        )
        .default("(0.3, 1)")
        .range(0.0, 10.0),
        Input::new("waves", Type::List(&Type::Record(WAVE)), "Waves in the rings.").default("[]"),
        Input::new("seed", Type::Whole, "Chooses among the random burls.").default("0"),
    ],
    outputs: &[
        Output::field("time", Type::Number(Unit::Year), "Growth time.").on(Domain::Solid),
        Output::field("branch", Type::Number(Unit::One), "0 far from branches, 0.5 at a branch's border, near 1 in it.")
            .on(Domain::Solid),
        Output::field("burl", Type::Number(Unit::One), "0 far from burls, near 1 in one.").on(Domain::Solid),
        Output::field("inside", Type::Number(Unit::One), "1 inside the bark, 0 outside.").on(Domain::Solid),
        Output::field("radius", Type::Number(Unit::Millimetre), "The radius r_eq, without waves.").on(Domain::Solid),
        Output::field("energy", Type::Number(Unit::One), "The energy E.").on(Domain::Solid),
        Output::field(
            "place",
            Type::Vector(Unit::Millimetre),
            "Where the point would be without branches, burls, waves and bends: noise there follows the grain.",
        )
        .on(Domain::Solid),
    ],
    example: "(nodes: {
        \"tree\": skeleton(
            trunk: [(0, 0, 0), (12, 4, 900), (-6, 9, 2100)],
            branches: [(at: 1200, direction: (1, 0.2, 0.5), half_width: 14, at_distance: 150, length: 400)],
        ),
        \"rings\": ring_series(widths: [3, 3.4, 3, 2.6, 2.8, 2.2, 2.4, 2, 2.3, 1.9, 2, 1.8], height: 9000),
        \"example\": virtual_energy(
            skeleton: \"tree\", rings: \"rings\", random_burls: 5,
            waves: [(amplitude: 0.8, length: 30, turns: 3)],
        ),
    })",
    build,
};

const BURL: &[Input] = &[
    Input::new("at", Type::Vector(Unit::Millimetre), "Its centre."),
    Input::number(
        "charge",
        Unit::Millimetre,
        "Its charge; alone it has the energy 1 at that distance.",
    )
    .optional()
    .range(0.0, 1e5),
    Input::number(
        "radius",
        Unit::Millimetre,
        "Instead: how far beyond its centre it swells the bark, with the endless reference.",
    )
    .optional()
    .range(1e-3, 1e5),
];

const WAVE: &[Input] = &[
    Input::number(
        "amplitude",
        Unit::Millimetre,
        "How far rings swing to each side.",
    )
    .range(0.0, 1e4),
    Input::number(
        "length",
        Unit::Millimetre,
        "Height of one wave; without it, it does not change with height.",
    )
    .optional()
    .range(1e-3, 1e6),
    Input::new("turns", Type::Whole, "Waves in one turn about the axis.")
        .default("0")
        .range(-1000.0, 1000.0),
    Input::number("phase", Unit::Degree, "Where it starts.")
        .default("0")
        .range(-360.0, 360.0),
];

fn build(inputs: &Inputs<'_>, context: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let (skeleton, rings) = (inputs.skeleton("skeleton"), inputs.ring_series("rings"));
    let axis = Axis::new(skeleton, inputs.choice("axis") == "straight")
        .map_err(|error| Failure::of_input("skeleton", format!("trunk: {error}")))?;
    let reference = match inputs.choice("reference") {
        "middle" => Reference::Middle,
        "local" => Reference::Local,
        _ => Reference::Endless,
    };
    let mut model = EnergyModel::bare(axis, reference);
    let charges = charges(inputs, skeleton.branches.len())?;
    model.branches = branch_rods(&skeleton.branches, charges.as_deref(), &model.axis, rings)
        .map_err(|(index, reason)| {
            let message = format!("branch {}: {reason}", index + 1);
            Failure::of_input("skeleton", message)
                .with_hint("state its `length` and the charges with `branch_charges`, or let the tree grow taller")
        })?;
    model.burls = burls(inputs, &model.axis, rings)?;
    if inputs.whole("random_burls") > 0 {
        let settings = burl_settings(inputs, &model.axis, rings)?;
        let random = Random::new(context.seed, KIND.name, inputs.whole("seed"));
        model
            .burls
            .extend(random_burls(&settings, random, &model.axis, rings));
    }
    model.waves = inputs.list("waves").iter().filter_map(wave).collect();
    let position = Field::position(Domain::Solid);
    let energy = context.kernel(EnergyKernel::new(model), vec![position.clone()]);
    let [radius, whole, branch, burl, wave] = [0, 1, 2, 3, 4].map(|column| energy.part(column, 1));
    let time = context.kernel(
        RingTime::new(rings),
        vec![radius.clone(), wave, position.clone()],
    );
    let age = rings.years() as f64;
    let inside = below(context, time.clone(), age);
    let place = context.kernel(Join, vec![energy.part(5, 2), position.part(2, 1)]);
    let fields = [time, branch, burl, inside, radius, whole, place];
    Ok(fields.map(Value::Field).to_vec())
}

/// The charges that the recipe states, one for each branch.
fn charges(inputs: &Inputs<'_>, branches: usize) -> Result<Option<Vec<f64>>, Failure> {
    if inputs.get("branch_charges").is_none() {
        return Ok(None);
    }
    let numbers = inputs
        .list("branch_charges")
        .iter()
        .filter_map(Value::as_number);
    let charges: Vec<f64> = numbers.collect();
    if charges.len() == branches {
        return Ok(Some(charges));
    }
    let message = format!(
        "expected {branches} charges, one for each branch, found {}",
        charges.len()
    );
    Err(Failure::of_input("branch_charges", message))
}

/// The burls that the recipe places.
fn burls(inputs: &Inputs<'_>, axis: &Axis, rings: &RingSeries) -> Result<Vec<Burl>, Failure> {
    let burl = |(index, item): (usize, &Value)| {
        burl(item, axis, rings).map_err(|reason| {
            let message = format!("burl {}: {reason}", index + 1);
            Failure::of_input("burls", message).at_item(index)
        })
    };
    inputs.list("burls").iter().enumerate().map(burl).collect()
}

fn burl(item: &Value, axis: &Axis, rings: &RingSeries) -> Result<Burl, String> {
    let centre = item
        .part("at")
        .and_then(Value::as_vector)
        .ok_or("`at` is missing")?;
    let [charge, radius] =
        ["charge", "radius"].map(|name| item.part(name).and_then(Value::as_number));
    let charge = match (charge, radius) {
        (Some(charge), None) => charge,
        (None, Some(radius)) => {
            let depth = axis.offset(centre).length();
            swelling_charge(depth, radius, bark_radius(rings, centre.z))?
        }
        _ => return Err("expected either `charge` or `radius`".into()),
    };
    Ok(Burl { centre, charge })
}

fn burl_settings(
    inputs: &Inputs<'_>,
    axis: &Axis,
    rings: &RingSeries,
) -> Result<BurlSettings, Failure> {
    let [low, high] = axis.heights();
    let top = rings.heights[rings.years() - 1];
    let heights = match inputs.get("burl_heights") {
        Some(_) => inputs.pair("burl_heights"),
        None => [low, high.min(top).max(low)],
    };
    let settings = BurlSettings {
        count: inputs.whole("random_burls") as usize,
        charges: inputs.pair("burl_charges"),
        heights,
        depths: inputs.pair("burl_depths"),
    };
    let pairs = [
        ("burl_charges", settings.charges),
        ("burl_heights", settings.heights),
        ("burl_depths", settings.depths),
    ];
    match pairs.into_iter().find(|(_, [low, high])| low > high) {
        None => Ok(settings),
        Some((input, [low, high])) => {
            let message = format!("expected the smaller number first, found ({low}, {high})");
            Err(Failure::of_input(input, message))
        }
    }
}

fn wave(item: &Value) -> Option<Wave> {
    let part = |name| item.part(name).and_then(Value::as_number);
    Some(Wave {
        amplitude: part("amplitude")?,
        per_millimetre: part("length").map_or(0.0, |length| 1.0 / length),
        turns: part("turns")? as i64,
        phase: part("phase")? / 360.0,
    })
}
