//! A kind `quads`: rows of cells made by hand, with jittered corners or shifted like bricks.

use glam::DVec2;
use std::sync::Arc;
use yosegi::node::{Build, Failure, Input, Inputs, Kind, Output};
use yosegi::value::{Partition, Type, Unit, Value};

/// Rows of quads from the origin on.
pub(crate) static QUADS: Kind = Kind {
    name: "quads",
    version: 1,
    about: "Rows of quads.",
    source: "own construction",
    inputs: &[
        Input::new("columns", Type::Whole, "Quads in a row.")
            .default("10")
            .range(1.0, 2000.0),
        Input::new("rows", Type::Whole, "Rows.")
            .default("10")
            .range(1.0, 2000.0),
        Input::new(
            "size",
            Type::Pair(Unit::Millimetre),
            "Width and height of a quad.",
        )
        .default("(100, 100)"),
        Input::number(
            "jitter",
            Unit::One,
            "How far corners move, as a share of the size.",
        )
        .default("0.1"),
        Input::new("repeats", Type::Toggle, "Whether the rows repeat.").default("false"),
        Input::new(
            "bricks",
            Type::Toggle,
            "Whether every other row is shifted by half a brick; then nothing is jittered.",
        )
        .default("false"),
    ],
    outputs: &[Output::new("partition", Type::Partition, "The quads.")],
    example: r#"(nodes: { "example": quads() })"#,
    build,
};

/// A number from -1 to 1 for a corner of the lattice.
fn chance(x: i64, y: i64, axis: i64) -> f64 {
    let mut mixed = ((x * 73_856_093) ^ (y * 19_349_663) ^ (axis * 83_492_791)) as u64;
    for _ in 0..3 {
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    }
    (mixed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn build(inputs: &Inputs<'_>, _: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let [columns, rows] = ["columns", "rows"].map(|name| inputs.whole(name));
    let size = DVec2::from_array(inputs.pair("size"));
    let (jitter, repeats, bricks) = (
        inputs.number("jitter"),
        inputs.toggle("repeats"),
        inputs.toggle("bricks"),
    );
    let corner = |x: i64, y: i64| {
        let wrapped = if repeats {
            (x.rem_euclid(columns), y.rem_euclid(rows))
        } else {
            (x, y)
        };
        let by = [0, 1].map(|axis| chance(wrapped.0, wrapped.1, axis));
        DVec2::new(x as f64, y as f64) * size + jitter * DVec2::from_array(by) * size
    };
    let brick = |x: i64, y: i64, along: [f64; 2]| {
        let shift = if y % 2 == 1 { 0.5 } else { 0.0 };
        DVec2::new(x as f64 + along[0] + shift, y as f64 + along[1]) * size
    };
    let mut partition = Partition {
        rings: vec![0],
        cells: vec![0],
        period: repeats.then(|| DVec2::new(columns as f64, rows as f64) * size),
        ..Partition::default()
    };
    for (y, x) in (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x))) {
        let corners: Vec<DVec2> = match bricks {
            // The corners of other rows lie in the middle of long edges.
            true => [
                [0.0, 0.0],
                [0.5, 0.0],
                [1.0, 0.0],
                [1.0, 1.0],
                [0.5, 1.0],
                [0.0, 1.0],
            ]
            .map(|along| brick(x, y, along))
            .to_vec(),
            false => [(0, 0), (1, 0), (1, 1), (0, 1)]
                .map(|(right, up)| corner(x + right, y + up))
                .to_vec(),
        };
        add(&mut partition, &corners);
    }
    Ok(vec![Value::Partition(Arc::new(partition))])
}

fn add(partition: &mut Partition, corners: &[DVec2]) {
    partition.ids.push(partition.ids.len() as u32);
    partition
        .centres
        .push(corners.iter().sum::<DVec2>() / corners.len() as f64);
    partition.frames.push(DVec2::X);
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    partition
        .areas
        .push(0.5 * pairs.map(|(from, to)| from.perp_dot(*to)).sum::<f64>());
    partition
        .neighbours
        .extend(corners.iter().map(|_| Partition::NONE));
    partition.corners.extend_from_slice(corners);
    partition.rings.push(partition.corners.len() as u32);
    partition.cells.push(partition.rings.len() as u32 - 1);
}
