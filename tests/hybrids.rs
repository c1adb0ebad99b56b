//! Hybrids: a material for each cell, what it finds out about the cell, and materials let into others.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]
#![allow(
    clippy::needless_range_loop,
    reason = "the same sample of several fields is looked at"
)]

#[path = "support/workshop.rs"]
#[allow(dead_code, reason = "hybrids need no log of events")]
mod workshop;

use workshop::Workshop;
use yosegi::engine::{Event, Options};

/// Fields of a recipe at points on the plane: for each name its columns, for each column its values.
fn sampled(nodes: &str, names: &[&str], points: &[[f64; 2]]) -> Vec<Vec<Vec<f32>>> {
    let workshop = Workshop::new("/hybrids", Options::default());
    let graph = workshop.graph(&format!("(nodes: {{ {nodes} }})"));
    let points: Vec<[f64; 3]> = points.iter().map(|[u, v]| [*u, *v, 0.0]).collect();
    let sample = |name: &&str| {
        let fields = workshop
            .engine
            .fields(&graph, name, &|_: Event| {})
            .unwrap();
        workshop.engine.sample(&fields, &points).remove(0)
    };
    names.iter().map(sample).collect()
}

/// What is wrong with a recipe whose node `it` cannot be built.
fn refused(nodes: &str) -> String {
    let workshop = Workshop::new("/hybrids", Options::default());
    let graph = workshop.graph(&format!("(nodes: {{ {nodes} }})"));
    let wrong = workshop
        .engine
        .fields(&graph, "it", &|_: Event| {})
        .unwrap_err();
    format!("{wrong:?}")
}

fn grid(count: usize, scale: f64) -> Vec<[f64; 2]> {
    let at = |index: usize| (index as f64 + 0.37) / count as f64 * scale;
    (0..count * count)
        .map(|index| [at(index % count), at(index / count)])
        .collect()
}

/// A material that says where it is, and bricks to lay it into.
const LAID: &str = r##"
    "at": position(),
    "where": material(base_color: "#808080", extras: {"x": "= at.x / 1 mm", "y": "= at.y / 1 mm", "z": "= at.z / 1 mm"}),
    "bricks": split_cells(size: (400, 300), pattern: herringbone, length: 80, width: 20, angle: 30),
    "cell": cell_fields(cells: "bricks", attribute: "row"),
"##;

#[test]
fn a_cell_shows_the_solid_along_its_own_axes() {
    let nodes = format!(
        r#"{LAID} "it": per_cell(cells: "bricks", of: "where", origin: (7, 40, 900), across: (0, 0, 1), along: (1, 0, 0)),"#
    );
    let names = ["it.x", "it.y", "it.z", "cell.place"];
    let found = sampled(&nodes, &names, &grid(40, 300.0));
    for index in 0..1600 {
        let [x, y, z] = [0, 1, 2].map(|name| found[name][0][index]);
        let [across, along] = [0, 1].map(|part| found[3][part][index]);
        assert!((x - 7.0 - along).abs() < 1e-3, "{x} {along}");
        assert_eq!(y, 40.0);
        assert!((z - 900.0 - across).abs() < 1e-3, "{z} {across}");
    }
}

#[test]
fn cells_lie_at_places_of_their_own_within_the_scatter() {
    let nodes = format!(
        r#"{LAID} "it": per_cell(cells: "bricks", of: "where", origin: (0, 0, 1000), scatter: (5, 50, 500)),
        "other": per_cell(cells: "bricks", of: "where", origin: (0, 0, 1000), scatter: (5, 50, 500), seed: 1),"#
    );
    let names = ["it.x", "it.y", "it.z", "cell.place", "cell.id", "other.z"];
    let found = sampled(&nodes, &names, &grid(60, 300.0));
    let mut of_cell = std::collections::BTreeMap::new();
    let mut differ = 0;
    for index in 0..3600 {
        let offset = [
            found[0][0][index] - found[3][0][index],
            found[1][0][index],
            found[2][0][index] - 1000.0 - found[3][1][index],
        ];
        for (part, most) in offset.iter().zip([5.0, 50.0, 500.0]) {
            assert!(part.abs() <= most * 1.001, "{offset:?}");
        }
        let known = *of_cell.entry(found[4][0][index] as u32).or_insert(offset);
        for (part, known) in offset.iter().zip(known) {
            assert!((part - known).abs() < 1e-2, "{offset:?}");
        }
        differ += usize::from((found[5][0][index] - found[2][0][index]).abs() > 1.0);
    }
    let mut heights: Vec<f32> = of_cell.values().map(|offset| offset[2]).collect();
    heights.sort_by(f32::total_cmp);
    heights.dedup();
    assert_eq!(heights.len(), of_cell.len());
    assert!(heights[0] < -400.0 && heights[heights.len() - 1] > 400.0);
    assert!(differ > 3500);
}

#[test]
fn pieces_are_spun_about_the_upright_axis_and_lie_in_several_ways() {
    let nodes = format!(
        r#"{LAID} "it": per_cell(cells: "bricks", of: "where", origin: (0, 60, 0), spin: 360, across: (0, 0, 1), along: (1, 0, 0)),
        "turned": per_cell(cells: "bricks", of: "where", turns: 2, across: (0, 0, 1), along: (1, 0, 0)),"#
    );
    let names = ["it.x", "it.y", "cell.place", "turned.z"];
    let found = sampled(&nodes, &names, &grid(40, 300.0));
    let mut ways = [0, 0];
    for index in 0..1600 {
        let [x, y, across, along] =
            [&found[0][0], &found[1][0], &found[2][0], &found[2][1]].map(|column| column[index]);
        // As far from the axis as the plain-sawn piece was.
        assert!((x.hypot(y) - along.hypot(60.0)).abs() < 1e-3);
        let z = found[3][0][index];
        assert!((z.abs() - across.abs()).abs() < 1e-3);
        ways[usize::from(z * across < 0.0)] += 1;
    }
    assert!(ways.iter().all(|count| *count > 300), "{ways:?}");
}

#[test]
fn materials_are_chosen_by_a_number_or_drawn_by_weight() {
    let nodes = r##"
        "rows": split_cells(size: (400, 300), pattern: rows, length: 80, width: 20),
        "cell": cell_fields(cells: "rows", attribute: "row"),
        "a": material(base_color: (1, 0, 0)), "b": material(base_color: (0, 1, 0)), "c": material(base_color: (0, 0, 1)),
        "chosen": per_cell(cells: "rows", of: {"a": "a", "b": "b", "c": "c"}, choose: "= cell.attribute - 3"),
        "drawn": per_cell(cells: "rows", of: {"a": "a", "b": "b", "c": "c"}, weights: {"a": 3, "b": 0}),
    "##;
    let found = sampled(
        nodes,
        &["chosen.base_color", "cell.attribute", "drawn.choice"],
        &grid(50, 300.0),
    );
    let mut drawn = [0; 3];
    for index in 0..2500 {
        let row = found[1][0][index] as i32;
        let colour = [0, 1, 2].map(|part| found[0][part][index]);
        let mut expected = [0.0; 3];
        expected[(row - 3).clamp(0, 2) as usize] = 1.0;
        assert_eq!(colour, expected, "row {row}");
        drawn[found[2][0][index] as usize] += 1;
    }
    assert_eq!(drawn[1], 0);
    let share = f64::from(drawn[0]) / 2500.0;
    assert!((share - 0.75).abs() < 0.15, "{share}");
}

#[test]
fn a_material_finds_out_about_its_cell() {
    let nodes = format!(
        r##"{LAID}
        "random": cell_value(name: "random"), "row": cell_value(name: "row"), "tone": cell_value(name: "tone", value: 5),
        "far": cell_value(name: "far", value: 7), "place": position(),
        "told": material(base_color: "#808080", extras: {{"random": "random", "row": "row", "tone": "= 2 * tone", "far": "far"}}),
        "it": per_cell(cells: "bricks", of: "told", values: {{"tone": "= place.u / 1 mm"}}),
        "slice": slice_cut(of: "told", cut: plain_sawn, origin: (0, 0, 0), offset: 3, size: (10, 10)),"##
    );
    let names = [
        "it.random",
        "cell.random",
        "it.row",
        "cell.attribute",
        "it.tone",
        "it.far",
        "slice.tone",
    ];
    let points = grid(30, 300.0);
    let found = sampled(&nodes, &names, &points);
    for index in 0..900 {
        let value = |name: usize| found[name][0][index];
        assert_eq!(value(0), value(1));
        assert_eq!(value(2), value(3));
        assert!((f64::from(value(4)) - 2.0 * points[index][0]).abs() < 1e-3);
        // Nobody gives it, and around the slice there is no cell.
        assert_eq!((value(5), value(6)), (7.0, 10.0));
    }
}

/// A white plate let into a black ground: heights 1 and 2 mm, roughness 0.2 and 0.6.
const INLAID: &str = r##"
    "dark": material(base_color: "#000000", height: "= 0 * at.z + 1 mm", roughness: 0.2, extras: {"grain": 4}),
    "pale": material(base_color: "#ffffff", height: "= 0 * at.z + 2 mm", roughness: 0.6, occlusion: 0.5),
    "at": position(),
    "ground": slice_cut(of: "dark", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), size: (100, 100)),
    "plate": slice_cut(of: "pale", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), size: (100, 100)),
    "square": region(outlines: [(outline: [(20, 20), (80, 20), (80, 80), (20, 80)])]),
    "cells": region_cells(of: "square"),
"##;

#[test]
fn an_inlay_is_ground_glue_and_what_is_let_in_in_all_channels() {
    let how = r##"gap: 2, depth: 1.5, step: 0.5, chamfer: 3, ground_chamfer: 1, glue: (0.25, 0.25, 0.25), glue_roughness: 0.9"##;
    // Distances from the outline along a line to the right: 0 is at u = 20.
    let points = [-10.0, -1.5, 0.0, 0.5, 2.0, 3.5, 6.0].map(|d| [20.0 + d, 50.0]);
    for shape in [r#"region: "square""#, r#"cells: "cells""#] {
        let nodes =
            format!(r#"{INLAID} "it": inlay(ground: "ground", of: "plate", {shape}, {how}),"#);
        let names = [
            "it.base_color",
            "it.height",
            "it.roughness",
            "it.occlusion",
            "it.grain",
            "it.share",
            "it.gap",
        ];
        let found = sampled(&nodes, &names, &points);
        let row = |name: usize| found[name][0].clone();
        assert_eq!(row(0), [0.0, 0.0, 0.25, 0.25, 1.0, 1.0, 1.0]);
        // Chamfers fall at 45 degrees towards the gap; the plate stands half a millimetre above its own height.
        for (found, expected) in
            row(1)
                .iter()
                .zip([1.0, 0.5, -1.5, -1.5, 2.5 - 2.0, 2.5 - 0.5, 2.5])
        {
            assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
        }
        assert_eq!(row(2), [0.2, 0.2, 0.9, 0.9, 0.6, 0.6, 0.6]);
        // The glue sees the sky through a groove of 2 x 1.5 mm.
        let openness = 1.0 / (1.0_f32 + 1.5 * 1.5).sqrt();
        for (found, expected) in row(3)
            .iter()
            .zip([1.0, 1.0, openness, openness, 0.5, 0.5, 0.5])
        {
            assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
        }
        // What one of them lacks is 0 there.
        assert_eq!(row(4), [4.0, 4.0, 4.0, 4.0, 0.0, 0.0, 0.0]);
        assert_eq!(row(5), [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        assert_eq!(row(6), [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    }
}

#[test]
fn without_gap_and_chamfers_nothing_lies_between() {
    let nodes = format!(
        r#"{INLAID} "it": inlay(ground: "ground", of: "plate", region: "square", gap: 0, depth: 0, chamfer: 0, ground_chamfer: 0),"#
    );
    let points = [[19.999, 50.0], [20.001, 50.0]];
    let found = sampled(&nodes, &["it.height", "it.gap"], &points);
    assert_eq!(found[0][0], [1.0, 2.0]);
    assert_eq!(found[1][0], [0.0, 0.0]);
}

#[test]
fn mistakes_are_named() {
    let laid = |how: &str| {
        refused(&format!(
            r#"{LAID} "it": per_cell(cells: "bricks", {how}),"#
        ))
    };
    let inlay = |how: &str| {
        refused(&format!(
            r#"{INLAID} "it": inlay(ground: "ground", of: "plate"{how}),"#
        ))
    };
    for (wrong, said) in [
        (
            laid(r#"of: {"here": "where"}, weights: {"there": 2}"#),
            "no material is called `there`",
        ),
        (
            laid(r#"of: {"here": "where"}, weights: {"here": 0}"#),
            "no material has a weight above 0",
        ),
        (
            laid(r#"of: {"here": "where"}, weights: {"here": 1}, choose: 0"#),
            "`weights` are stated, but `choose` says",
        ),
        (
            laid(r#"of: "where", along: (2, 0, 0)"#),
            "`along` points the same way as `across`",
        ),
        (inlay(""), "nothing says where it is let in"),
        (
            inlay(r#", region: "square", cells: "cells""#),
            "both a `region` and `cells` are stated",
        ),
    ] {
        assert!(wrong.contains(said), "{said}: {wrong}");
    }
}

#[test]
fn angles_are_in_degrees() {
    let nodes = format!(
        r#"{LAID} "it": direction_field(angle: 30), "turned": direction_field(angle: "cell.angle", symmetry: 1),"#
    );
    let names = ["it.direction", "cell.angle", "turned.direction"];
    let found = sampled(&nodes, &names, &grid(30, 300.0));
    let mut seen = std::collections::BTreeSet::new();
    for index in 0..900 {
        let [x, y] = [0, 1].map(|part| found[0][part][index]);
        assert!((x - 0.75f32.sqrt()).abs() < 1e-5 && (y - 0.5).abs() < 1e-5);
        let angle = found[1][0][index];
        seen.insert(angle.round() as i32);
        let (sine, cosine) = libm::sincosf(angle.to_radians());
        let [x, y] = [0, 1].map(|part| found[2][part][index]);
        assert!((x - cosine).abs() < 1e-5 && (y - sine).abs() < 1e-5);
    }
    // Bricks of a herringbone that is turned by 30 degrees lie along it and across.
    assert!(
        seen.iter().all(|angle| angle.rem_euclid(90) == 30),
        "{seen:?}"
    );
    assert!(seen.len() > 1);
}

#[test]
fn what_is_let_into_stones_lies_at_their_level() {
    let nodes = r##""ground": material(base_color: "#808080", height: 70), "of": material(base_color: "#404040"),
        "disc": region_shape(shape: ellipse, size: (40, 40), at: (30, 30)),
        "it": inlay(ground: "ground", of: "of", region: "disc", gap: 4, depth: 2, step: 1, level: 70, chamfer: 0, ground_chamfer: 0),"##;
    let points = [[10.0, 50.0], [30.0, 50.0], [50.0, 50.0]];
    let found = sampled(nodes, &["it.height"], &points);
    assert_eq!(found[0][0], [70.0, 68.0, 71.0]);
}
