//! `virtual_energy` and `rings` in recipes.

use std::path::Path;
use std::sync::Arc;
use yosegi::engine::{Engine, Options};
use yosegi::graph::{Settings, load};
use yosegi::world::Memory;

/// The columns of a node's output at points, or the messages.
fn sample(nodes: &str, output: &str, points: &[[f64; 3]]) -> Result<Vec<f32>, String> {
    let world = Memory::default();
    let path = Path::new("recipe.ron");
    world.insert(path, format!("(nodes: {{ {nodes} }})"));
    let told = |wrong: &[_]| yosegi::diagnostics::render_all(wrong);
    let graph = load(&world, path, &Settings::default())
        .map_err(|wrong| told(&wrong))?
        .graph;
    let engine = Engine::new(Arc::new(world), Options::default()).unwrap();
    let fields = engine.fields(&graph, output, &|_: yosegi::engine::Event| {});
    let fields = fields.map_err(|error| told(error.diagnostics()))?;
    Ok(engine.sample(&fields, points)[0][0].clone())
}

const TREE: &str = r#"
    "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 2000)]),
    "rings": ring_series(widths: [4, 3, 2, 1], height: 4000),
    "tall": skeleton(
        trunk: [(0, 0, 0), (0, 0, 9000)], branches: [(at: 5000, direction: (1, 0, 0), thickening: 1)],
    ),
"#;

#[test]
fn time_is_that_of_the_ring_at_the_height() {
    let nodes = format!(r#"{TREE} "energy": virtual_energy(skeleton: "tree", rings: "rings"),"#);
    let at_ground = [
        [0.0; 3],
        [4.0, 0.0, 0.0],
        [0.0, 7.0, 0.0],
        [0.0, -9.0, 0.0],
        [10.0, 0.0, 0.0],
    ];
    let times = sample(&nodes, "energy.time", &at_ground).unwrap();
    for (time, expected) in times.iter().zip([0.0, 1.0, 2.0, 3.0, 4.0]) {
        assert!((time - expected).abs() < 1e-5, "{times:?}");
    }
    let inside = sample(
        &nodes,
        "energy.inside",
        &[[9.9, 0.0, 0.0], [10.1, 0.0, 0.0]],
    )
    .unwrap();
    assert_eq!(inside, [1.0, 0.0]);
    // Where the tree's tip was at the end of a year, that ring begins at the pith.
    let above = sample(
        &nodes,
        "energy.time",
        &[[0.0, 0.0, 3999.0], [0.0, 0.0, 4500.0]],
    )
    .unwrap();
    assert!(
        above[0] > 3.9 && above[0] < 4.0 && above[1] > 4.0,
        "{above:?}"
    );
}

#[test]
fn a_branch_has_its_border_where_it_was_said_to_be() {
    let nodes = r#"
        "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 2000)], branches: [
            (at: 500, direction: (1, 0, 0), half_width: 12, at_distance: 150, length: 400)]),
        "rings": ring_series(years: 40, radius: 100),
        "energy": virtual_energy(skeleton: "tree", rings: "rings"),
    "#;
    let points = [
        [150.0, 12.0, 500.0],
        [150.0, 0.0, 512.0],
        [150.0, 0.0, 500.0],
        [-150.0, 0.0, 500.0],
    ];
    let shares = sample(nodes, "energy.branch", &points).unwrap();
    assert!(
        (shares[0] - 0.5).abs() < 1e-5 && (shares[1] - 0.5).abs() < 1e-5,
        "{shares:?}"
    );
    assert!(shares[2] > 0.95 && shares[3] < 0.2, "{shares:?}");
}

#[test]
fn a_burl_swells_the_bark_as_far_as_it_was_said() {
    let nodes = format!(
        r#"{TREE} "energy": virtual_energy(skeleton: "tree", rings: "rings", burls: [
            (at: (8, 0, 0), radius: 6)]),"#
    );
    let times = sample(&nodes, "energy.time", &[[14.0, 0.0, 0.0]]).unwrap();
    assert!((times[0] - 4.0).abs() < 1e-4, "{times:?}");
}

#[test]
fn random_burls_follow_the_seed_and_stay_where_they_may() {
    let nodes = |seed: &str| {
        format!(
            r#"{TREE} "energy": virtual_energy(skeleton: "tree", rings: "rings", random_burls: 50, seed: {seed},
                burl_heights: (500, 600), burl_depths: (0.5, 0.6)),"#
        )
    };
    let points = [[6.0, 1.0, 550.0], [5.0, -3.0, 520.0], [0.5, 0.0, 1900.0]];
    let first = sample(&nodes("1"), "energy.burl", &points).unwrap();
    assert_eq!(first, sample(&nodes("1"), "energy.burl", &points).unwrap());
    assert_ne!(first, sample(&nodes("2"), "energy.burl", &points).unwrap());
    assert!(first[2] < first[0].min(first[1]));
}

#[test]
fn mistakes_are_told() {
    let cases = [
        (
            r#"virtual_energy(skeleton: "tree", rings: "rings", branch_charges: [1])"#,
            "expected 0 charges",
        ),
        (
            r#"virtual_energy(skeleton: "tree", rings: "rings", burls: [(at: (1, 0, 0))])"#,
            "either `charge` or `radius`",
        ),
        (
            r#"virtual_energy(skeleton: "tree", rings: "rings", burls: [(at: (1, 0, 0), radius: 2)])"#,
            "inside the bark",
        ),
        (
            r#"virtual_energy(skeleton: "tree", rings: "rings", random_burls: 3, burl_depths: (1, 0.5))"#,
            "the smaller number first",
        ),
        (
            r#"virtual_energy(skeleton: "tree", rings: "rings", burls: [(at: (1, 0, 4000), radius: 2)])"#,
            "above the top of the tree, where there is no bark",
        ),
        (
            r#"virtual_energy(skeleton: "tall", rings: "rings", branch_charges: [0.3])"#,
            "branch 1: it starts above the top of the tree",
        ),
        (
            r#"ring_series(years: 3)"#,
            "either `widths`, or `years` with `radius`",
        ),
        (r#"ring_series(widths: [])"#, "at least one ring"),
    ];
    for (node, expected) in cases {
        let nodes = format!(
            r#"{TREE} "wrong": {node}, "used": virtual_energy(skeleton: "tree", rings: "rings"),"#
        );
        let found = sample(&nodes, "wrong", &[[0.0; 3]]).unwrap_err();
        assert!(found.contains(expected), "{found}");
    }
}
