//! Inputs that would do nothing are refused, instead of being passed over.

use std::path::Path;
use std::sync::Arc;
use yosegi::diagnostics::render_all;
use yosegi::engine::{Engine, Options};
use yosegi::graph::{Settings, load};
use yosegi::world::Memory;

/// What is said about a node that cannot be built.
fn told(node: &str) -> String {
    let world = Memory::default();
    let path = Path::new("recipe.ron");
    world.insert("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid");
    let text =
        format!(r##"(nodes: {{ "wood": material(base_color: "#c8a06e"), "node": {node} }})"##);
    world.insert(path, text);
    let graph = load(&world, path, &Settings::default()).unwrap().graph;
    let engine = Engine::new(Arc::new(world), Options::default()).unwrap();
    let fields = engine.fields(&graph, "node", &|_: yosegi::engine::Event| {});
    render_all(fields.unwrap_err().diagnostics())
}

#[test]
fn inputs_that_would_do_nothing_are_refused() {
    let cases = [
        (
            "slice_cut(of: \"wood\", cut: quarter_sawn, origin: (0, 0, 0), offset: 30, size: (1, 1))",
            "`offset` is set",
        ),
        (
            "slice_cut(of: \"wood\", cut: end_grain, origin: (0, 0, 0), offset: 30, size: (1, 1))",
            "`offset` is set",
        ),
        (
            "slice_cut(of: \"wood\", origin: (0, 0, 0), across: (1, 0, 0), along: (0, 0, 1), turn: 30, size: (1, 1))",
            "`turn` is set",
        ),
        (
            "mesh_from_file(file: \"a.stl\", parts: [\"horn\"])",
            "an STL file has no parts",
        ),
    ];
    for (node, expected) in cases {
        let found = told(node);
        assert!(found.contains(expected), "{node}: {found}");
    }
}
