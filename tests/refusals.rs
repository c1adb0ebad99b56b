//! What kinds refuse when they are built, each with the words that the author of the recipe reads.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "support/workshop.rs"]
#[allow(dead_code, reason = "refusals need no log of events")]
mod workshop;

use std::sync::{Arc, Mutex};
use workshop::Workshop;
use yosegi::engine::{Event, Options};

const NODES: &str = r##"
    "oak": material(base_color: "#b98d5a"),
    "cells": split_cells(size: (100, 80), pattern: rows, length: 20, width: 10),
    "at": position(),
"##;

/// The errors and the warnings of a recipe whose node `it` is built.
fn said(node: &str) -> (String, Vec<String>) {
    let workshop = Workshop::new("/refusals", Options::default());
    let graph = workshop.graph(&format!("(nodes: {{ {NODES} {node} }})"));
    let warnings = Arc::new(Mutex::new(vec![]));
    let heard = Arc::clone(&warnings);
    let listener = move |event: Event| {
        if let Event::Warning { message, .. } = event {
            heard.lock().unwrap().push(message.to_string());
        }
    };
    let built = workshop.engine.fields(&graph, "it", &listener);
    let wrong = built
        .err()
        .map(|wrong| format!("{wrong:?}"))
        .unwrap_or_default();
    let warnings = warnings.lock().unwrap().clone();
    (wrong, warnings)
}

/// Nodes that are refused, and words of what is said about them.
const REFUSED: &[(&str, &str)] = &[
    (
        r#""it": per_cell(cells: "cells", of: {})"#,
        "expected one material or more, found none",
    ),
    (
        r#""it": per_cell(cells: "cells", of: {"a": "oak"}, choose: "= 1 mm / (0 * at.u)")"#,
        "expected finite numbers, found inf at",
    ),
    (
        r#""odd": cell_attribute(of: "cells", name: "tone", value: "= 0 mm / (0 * at.u)"), "it": per_cell(cells: "odd", of: "oak")"#,
        "expected finite numbers, found",
    ),
    (
        r#""odd": cell_attribute(of: "cells", name: "id", value: 1), "it": per_cell(cells: "odd", of: "oak")"#,
        "cells have a `id` already",
    ),
    (
        r#""odd": inset_cells(of: "cells", joint: "= 1 mm * 1 mm / (0 * at.u)"), "it": cell_fields(cells: "odd")"#,
        "expected finite numbers, found inf at",
    ),
    (
        r#""it": stones(cells: "cells", settle: "= 1 mm * 1 mm / (0 * at.u)")"#,
        "expected finite numbers, found inf at",
    ),
    (
        r#""it": direction_field(guides: [(points: [(3, 3), (3, 3)])])"#,
        "nothing says where the direction comes from",
    ),
    (
        r#""it": split_cells(size: (100, 100), pattern: fan, length: 10, width: 1e8)"#,
        "courses are 100000000.000 mm wide, which is more than the arcs of lanes",
    ),
    (
        r#""it": split_cells(within: "cells", pattern: rows, length: 0.02, width: 0.02)"#,
        "expected at most 4000000 cells, found about 20000000",
    ),
    (
        r#""it": voronoi_split(within: "cells", count: 4000000)"#,
        "expected at most 4000000 cells, found about 176000000",
    ),
    (
        r#""it": voronoi_split(size: (100, 100), cell_size: 20, density: "= 0 mm / (0 * at.u)")"#,
        "expected finite numbers, found NaN at",
    ),
    (
        r#""it": square_packing(size: (100, 100), stone: 10, scale: "= -1 * at.u / 1 mm")"#,
        "the factor is nowhere above 0",
    ),
    (
        r#""it": square_packing(size: (100, 100), stone: 10, scale: "= 0 mm / (0 * at.u)")"#,
        "expected finite numbers, found NaN at",
    ),
    (
        r#""it": square_packing(size: (100, 100), stone: 10, direction: (0, 0, 5))"#,
        "the direction has no length in the plane anywhere",
    ),
    (
        r#""it": region(outlines: [(outline: [(0, 0), (9, 0), (0, 9)], holes: [[(-1, -1), (60, -1), (60, 60), (-1, 60)]])])"#,
        "the holes of outline 1 leave nothing of it",
    ),
];

#[test]
fn what_cannot_be_built_is_refused_with_reasons() {
    for (node, expected) in REFUSED {
        let (wrong, _) = said(node);
        assert!(wrong.contains(expected), "{node}: {wrong}");
    }
}

/// Nodes that are built, and words of what is warned of.
const WARNED: &[(&str, &str)] = &[
    (
        r#""it": per_cell(cells: "cells", of: {"a": "oak", "b": "oak"}, choose: 7)"#,
        "`choose` gives 44 cells a number that is not from 0 to 1",
    ),
    (
        r#""board": slice_cut(of: "oak", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), size: (100, 100)),
        "far": region_shape(size: (10, 10), at: (300, 0)), "it": inlay(ground: "board", of: "board", region: "far")"#,
        "nothing is let in: the outline lies beside the ground",
    ),
    (
        r#""shape": region_shape(size: (70, 30), at: (15, 15)), "it": inlay(ground: "oak", of: "oak", region: "shape", gap: 32)"#,
        "nothing of the inlay is left: the gap of 32 mm takes 16 mm off every side; it has room for a `gap` below 30 mm",
    ),
    (
        r#""squares": split_cells(size: (100, 100), pattern: grid, length: 40, width: 20), "it": inlay(ground: "oak", of: "oak", cells: "squares", gap: 20.5)"#,
        "nothing of the inlay is left: the gap of 20.5 mm takes 10.25 mm off every side; every cell has room for a `gap` below 20 mm",
    ),
    (
        r#""it": inlay(ground: "oak", of: "oak", cells: "cells", gap: 0.1, chamfer: 9)"#,
        "the chamfer of 9 mm leaves nothing of the face of what is let in",
    ),
    (
        r#""cut": inset_cells(of: "cells", joint: "= 1 mm - 0.5 * at.u"), "it": cell_fields(cells: "cut")"#,
        "the joint is below 0 at 231 of 239 sides of cells, down to -49 mm: cells do not move there",
    ),
    (
        r#""rows": split_cells(period: (100, 100), pattern: rows, length: 21, width: 9.8), "it": cell_fields(cells: "rows")"#,
        "the pattern was made 4.76 % shorter and 2.04 % wider, so that it closes",
    ),
    (
        r#""board": slice_cut(of: "oak", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), size: (40, 40)),
        "shape": region_shape(size: (70, 30), at: (15, 5)), "it": inlay(ground: "oak", of: "board", region: "shape")"#,
        "the piece that is let in ends 45 mm before its outline does: it is 40 x 40 mm, and the outline reaches (85.0, 35.0) mm",
    ),
];

#[test]
fn an_inlay_with_room_is_not_warned_of() {
    let inlay = r#""board": slice_cut(of: "oak", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), size: (100, 80)),
        "it": inlay(ground: "board", of: "board", cells: "cells", gap: 7)"#;
    assert_eq!(said(inlay), (String::new(), vec![]));
}

#[test]
fn what_is_likely_a_mistake_is_warned_of() {
    for (node, expected) in WARNED {
        let (wrong, warnings) = said(node);
        assert_eq!(wrong, "", "{node}");
        assert!(warnings.concat().contains(expected), "{node}: {warnings:?}");
    }
}
