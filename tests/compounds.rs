//! Compounds: what they expand to, what they are given, and the limits on how they nest.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::path::Path;
use std::sync::Arc;
use yosegi::diagnostics::{Code, Diagnostic};
use yosegi::engine::{Cancel, Engine, Options, Render};
use yosegi::graph::{Loaded, Settings, compounds, load};
use yosegi::value::{Type, Unit};
use yosegi::world::{Memory, World};

const TAIL: &str = r#"
        "wood": material(base_color: "look"),
        "board": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 500), size: (80, 120)),
    },
    outputs: { "board": maps(of: "board", pixels: (40, 60), channels: [base_color]) },
)"#;

/// A recipe that ends in a board of the colour `look`.
fn recipe(nodes: &str) -> String {
    format!("(seed: 5, nodes: {{ {nodes} {TAIL}")
}

/// A world with a recipe and compounds beside it.
fn world(recipe: &str, compounds: &[(&str, &str)]) -> Memory {
    let world = Memory::default();
    world.insert("r/recipe.ron", recipe);
    for (name, text) in compounds {
        world.insert(format!("r/nodes/{name}.ron"), *text);
    }
    world
}

fn loaded(world: &Memory) -> Result<Loaded, Vec<Diagnostic>> {
    load(world, Path::new("r/recipe.ron"), &Settings::default())
}

fn codes(world: &Memory) -> Vec<Code> {
    let wrong = loaded(world).expect_err("the recipe is wrong");
    wrong.into_iter().map(|one| one.code).collect()
}

/// The one map, with the key in it.
fn rendered(world: &Memory) -> Vec<u8> {
    let graph = loaded(world)
        .unwrap_or_else(|wrong| panic!("{}", yosegi::diagnostics::render_all(&wrong)))
        .graph;
    let engine = Engine::new(Arc::new(world.clone()), Options::default()).unwrap();
    let render = Render {
        graph: &graph,
        folder: "maps".into(),
        only: vec![],
        pixels: None,
        listener: &|_| {},
        cancel: Cancel::default(),
    };
    engine.render(&render).unwrap();
    world.read(Path::new("maps/board_base_color.png")).unwrap()
}

const STREAKED: &str = r##"(
    version: 1,
    inputs: {
        "tint": colour(default: "#c08040"),
        "amount": number(per_point: true, default: 0.5),
        "size": vector(default: (9, 9, 60), unit: "mm"),
        "octaves": whole(optional: true),
    },
    nodes: {
        "fibre": solid_noise(size: "$size", octaves: "$octaves"),
        "mixed": mix(a: "$tint", b: "#402010", amount: "= $amount + 0.5 * fibre.value"),
    },
    outputs: { "look": "mixed", "fibre": "fibre.value" },
)"##;

#[test]
fn a_compound_gives_the_bytes_and_the_key_of_its_nodes_in_its_place() {
    let inlined = recipe(
        r##""fibre": solid_noise(size: (9, 9, 60)),
        "look": mix(a: "#c08040", b: "#402010", amount: "= 0.5 + 0.5 * fibre.value"),"##,
    );
    let used = recipe(r#""one": streaked(), "look": mix(a: "one", b: (0, 0, 0), amount: 0),"#);
    let used = used.replace(r#"base_color: "look""#, r#"base_color: "one.look""#);
    let plain = rendered(&world(&inlined, &[]));
    assert_eq!(rendered(&world(&used, &[("streaked", STREAKED)])), plain);
    // Two levels of compounds change nothing either.
    let outer = r#"(
        version: 7,
        inputs: { "amount": number(per_point: true, default: 0.5) },
        nodes: { "inner": streaked(amount: "$amount") },
        outputs: { "look": "inner" },
    )"#;
    let nested = used.replace("streaked()", "outer()");
    let both = [("streaked", STREAKED), ("outer", outer)];
    assert_eq!(rendered(&world(&nested, &both)), plain);
}

#[test]
fn inputs_take_literals_parameters_links_and_arithmetic() {
    let used = |amount: &str| {
        recipe(&format!(
            r#""dots": solid_noise(size: (5, 5, 5)),
            "one": streaked(amount: {amount}),
            "look": mix(a: "one", b: "one.look", amount: 0),"#
        ))
    };
    let inlined = |amount: &str| {
        recipe(&format!(
            r##""dots": solid_noise(size: (5, 5, 5)),
            "fibre": solid_noise(size: (9, 9, 60)),
            "one": mix(a: "#c08040", b: "#402010", amount: "= {amount} + 0.5 * fibre.value"),
            "look": mix(a: "one", b: "one", amount: 0),"##
        ))
    };
    for (given, written) in [
        ("0.25", "0.25"),
        ("\"dots.value\"", "dots.value"),
        ("\"= 0.1 + 2 * dots.value\"", "(0.1 + 2 * dots.value)"),
    ] {
        let used = world(&used(given), &[("streaked", STREAKED)]);
        let plain = world(&inlined(written), &[]);
        assert_eq!(rendered(&used), rendered(&plain), "{given}");
    }
}

#[test]
fn an_optional_input_that_is_left_out_is_as_if_not_written() {
    let used = |inputs: &str| {
        let nodes =
            format!(r#""one": streaked({inputs}), "look": mix(a: "one", b: "one", amount: 0),"#);
        rendered(&world(&recipe(&nodes), &[("streaked", STREAKED)]))
    };
    assert_ne!(used(""), used("octaves: 7"));
    let needed = STREAKED
        .replace("octaves: \"$octaves\"", "octaves: 3")
        .replace(
            "\"look\": \"mixed\"",
            "\"look\": \"mixed\", \"cut\": \"cut\"",
        )
        .replace(
            "\"mixed\":",
            "\"cut\": solid_noise(size: (1, 1, 2), octaves: 2, gain: \"$gain\"), \"mixed\":",
        )
        .replace("\"octaves\": whole", "\"gain\": number");
    let recipe = recipe(r#""one": streaked(), "look": mix(a: "one", b: "one", amount: 0),"#);
    loaded(&world(&recipe, &[("streaked", &needed)])).unwrap();
    let required = needed.replace("gain: \"$gain\"", "lacunarity: \"= $gain * 2\"");
    let wrong = codes(&world(&recipe, &[("streaked", &required)]));
    assert_eq!(wrong, [Code::MissingInput]);
}

#[test]
fn a_seed_changes_everything_inside_and_nothing_outside() {
    let with_seed = |seed: i64| {
        let nodes =
            format!(r#""one": outer(seed: {seed}), "look": mix(a: "one", b: "one", amount: 0),"#);
        let outer = r#"(
            version: 1,
            nodes: { "inner": streaked() },
            outputs: { "look": "inner" },
        )"#;
        let both = [("streaked", STREAKED), ("outer", outer)];
        rendered(&world(&recipe(&nodes), &both))
    };
    assert_eq!(with_seed(0), with_seed(0));
    assert_ne!(with_seed(0), with_seed(1));
    assert_ne!(with_seed(1), with_seed(2));
}

#[test]
fn what_comes_with_yosegi_is_found_without_a_file_and_gives_way_to_a_file() {
    let nodes =
        r#""one": streaked(colour: (1, 0, 0)), "look": mix(a: "one", b: "one", amount: 0),"#;
    loaded(&world(&recipe(nodes), &[])).unwrap();
    assert_eq!(
        codes(&world(&recipe(nodes), &[("streaked", STREAKED)])),
        [Code::UnknownInput]
    );
    // No compound takes the name of a kind that is written in Rust.
    let own = recipe(r#""look": mix(a: (1, 0, 0), b: (0, 1, 0), amount: 0.5),"#);
    loaded(&world(&own, &[("mix", STREAKED)])).unwrap();
}

#[test]
fn every_compound_that_comes_with_yosegi_is_right_and_documented() {
    let mut names = vec![];
    for compound in compounds(&Memory::default(), Path::new("")) {
        let kind = compound.kind;
        names.push(kind.name);
        assert!(
            !kind.about.is_empty() && !kind.source.is_empty(),
            "{}",
            kind.name
        );
        for input in kind.inputs {
            assert!(!input.about.is_empty(), "{}.{}", kind.name, input.name);
        }
        let file = format!("nodes/{}.ron", kind.name);
        let world = Memory::default();
        let text = std::fs::read_to_string(&file).unwrap();
        world.insert(&*file, text);
        let graph = load(&world, Path::new(&file), &Settings::default()).unwrap();
        assert!(
            graph.graph.interface.is_some() && graph.warnings.is_empty(),
            "{file}"
        );
    }
    let files = std::fs::read_dir("nodes").unwrap();
    let files = files.filter(|file| file.as_ref().unwrap().path().extension().unwrap() == "ron");
    assert_eq!(names.len(), files.count(), "{names:?}");
    assert!(names.contains(&"tree_wood"));
}

#[test]
fn an_interface_is_a_kind() {
    let all = compounds(&world("", &[("streaked", STREAKED)]), Path::new("r"));
    let kind = all
        .iter()
        .find(|one| one.kind.name == "streaked")
        .unwrap()
        .kind;
    let inputs: Vec<_> = kind
        .inputs
        .iter()
        .map(|input| (input.name, input.value_type))
        .collect();
    assert_eq!(
        inputs,
        [
            ("tint", Type::Colour),
            ("amount", Type::Number(Unit::One)),
            ("size", Type::Vector(Unit::Millimetre)),
            ("octaves", Type::Whole),
            ("seed", Type::Whole),
        ]
    );
    let outputs: Vec<_> = kind
        .outputs
        .iter()
        .map(|one| (one.name, one.value_type))
        .collect();
    assert_eq!(
        outputs,
        [("look", Type::Colour), ("fibre", Type::Number(Unit::One))]
    );
}

#[test]
fn files_of_defaults_lie_beside_the_compound() {
    let lined = |path: &str| {
        format!(
            r#"(
            version: 1,
            inputs: {{ "photo": file(default: "{path}") }},
            nodes: {{ "bar": sample_pattern(file: "$photo", spans: bar, rings: 40, even_years: false) }},
            outputs: {{ "bar": "bar" }},
        )"#
        )
    };
    let nodes = r#""bar": lined(PHOTO),
        "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 1000)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 2),
        "look": pattern_lookup(time: "time", pattern: "bar"),"#;
    let photo = std::fs::read("assets/spruce_bar/spruce_bar.png").unwrap();
    let render = |given: &str, at: &str| {
        let world = world(
            &recipe(&nodes.replace("PHOTO", given)),
            &[("lined", &lined("a/bar.png"))],
        );
        world.insert(at, photo.clone());
        rendered(&world)
    };
    let beside_compound = render("", "r/nodes/a/bar.png");
    assert_eq!(render("photo: \"b.png\"", "r/b.png"), beside_compound);
}

#[test]
fn nodes_inside_are_found_by_the_path_of_their_uses() {
    let nodes = r#""one": streaked(), "look": mix(a: "one", b: "one", amount: 0),"#;
    let graph = loaded(&world(&recipe(nodes), &[("streaked", STREAKED)]))
        .unwrap()
        .graph;
    assert!(graph.node("one/fibre").is_some() && graph.node("one").is_none());
    let one = &graph.uses["one"];
    assert_eq!(graph.nodes[one.outputs[1].node].name.as_ref(), "one/fibre");
    assert_eq!(graph.files.len(), 2);
}

/// A tower of compounds, each of which uses the next `uses` times.
fn tower(levels: usize, uses: usize) -> Memory {
    let base =
        recipe(r#""top": level0(), "look": mix(a: (1, 0, 0), b: (0, 0, 1), amount: "top.value"),"#);
    let world = world(&base, &[]);
    for level in 0..levels {
        let inside: String = (0..uses)
            .map(|one| match level + 1 == levels {
                true => format!("\"n{one}\": solid_noise(size: (5, 5, 5)),"),
                false => format!("\"n{one}\": level{}(),", level + 1),
            })
            .collect();
        let text =
            format!("(version: 1, nodes: {{ {inside} }}, outputs: {{ \"value\": \"n0.value\" }})");
        world.insert(format!("r/nodes/level{level}.ron"), text);
    }
    world
}

#[test]
fn nesting_is_limited() {
    loaded(&tower(64, 1)).unwrap();
    assert_eq!(codes(&tower(65, 1)), [Code::NestedTooDeep]);
    assert_eq!(codes(&tower(1000, 1)), [Code::NestedTooDeep]);
}

#[test]
fn a_bomb_is_refused_before_it_expands() {
    loaded(&tower(4, 10)).unwrap();
    let wrong = loaded(&tower(10, 10)).unwrap_err();
    let [one] = wrong.as_slice() else {
        panic!("{wrong:?}")
    };
    assert_eq!(one.code, Code::TooMuch);
    assert_eq!(one.expected.as_deref(), Some("at most 200000 nodes"));
    assert_eq!(one.found.as_deref(), Some("10000000004 nodes"));
    assert_eq!(codes(&tower(64, 30)), [Code::TooMuch]);
    let settings = Settings {
        largest_graph: Some(100),
        ..Settings::default()
    };
    load(&tower(2, 10), Path::new("r/recipe.ron"), &settings).unwrap_err();
}

#[test]
fn arithmetic_that_doubles_at_every_level_is_refused() {
    let base = recipe(
        r#""dots": solid_noise(size: (5, 5, 5)),
        "top": level0(x: "= 0.5 * dots.value"),
        "look": mix(a: (1, 0, 0), b: (0, 0, 1), amount: "top.value"),"#,
    );
    let world = world(&base, &[]);
    for level in 0..40 {
        let inside = match level {
            39 => r#"distort_nothing"#.to_owned(),
            level => format!("level{}(x: \"= $x + $x\")", level + 1),
        };
        let inside = inside.replace("distort_nothing", "mix(a: 0.1, b: 0.2, amount: \"$x\")");
        let inside = inside.replace("a: 0.1, b: 0.2", "a: (0, 0, 0), b: (1, 1, 1)");
        let output = if level == 39 { "n" } else { "n.value" };
        let text = format!(
            "(version: 1, inputs: {{ \"x\": number(per_point: true) }}, nodes: {{ \"n\": {inside} }}, \
             outputs: {{ \"value\": \"{output}\" }})"
        );
        world.insert(format!("r/nodes/level{level}.ron"), text);
    }
    let wrong = codes(&world);
    assert!(wrong.contains(&Code::TooLarge), "{wrong:?}");
}

#[test]
fn a_chain_of_uses_is_shown_from_the_inside_out() {
    let outer = r#"(version: 1, nodes: { "inner": streaked(size: (0, 1, 1)) }, outputs: { "look": "inner" })"#;
    let nodes = r#""one": outer(), "look": mix(a: "one", b: "one", amount: 0),"#;
    let files = world(&recipe(nodes), &[("streaked", STREAKED), ("outer", outer)]);
    let wrong = loaded(&files).unwrap_err();
    assert_eq!(wrong.len(), 1);
    let text = yosegi::diagnostics::render_text(&wrong[0]);
    insta::assert_snapshot!(text, @r#"
    error[out-of-range]: `size` must be from 0.0001 to 1000000, found 0
      --> r/nodes/streaked.ron:10:36
       |
    10 |         "fibre": solid_noise(size: "$size", octaves: "$octaves"),
       |                                    ^^^^^^^ must be from 0.0001 to 1000000
       |
       = note: in `one/inner` (`streaked`): r/nodes/outer.ron:1:23
       = note: in `one` (`outer`): r/recipe.ron:1:20
    "#);
    assert_eq!(
        wrong[0].source.as_ref().unwrap().path,
        Path::new("r/nodes/streaked.ron")
    );
}

/// What is made of it has more parts at each use than memory could hold.
#[test]
fn arithmetic_is_not_passed_on_without_end() {
    let nodes: String = (0..600)
        .map(|one| format!("\"n{one}\": mix(a: (0, 0, 0), b: (1, 1, 1), amount: \"$x\"),"))
        .collect();
    let wide = format!(
        "(version: 1, inputs: {{ \"x\": number(per_point: true) }}, nodes: {{ {nodes} }}, \
         outputs: {{ \"look\": \"n0\" }})"
    );
    let leaves = vec!["dots.value"; 2048];
    let balanced = leaves
        .chunks(64)
        .map(|part| format!("({})", part.join(" + ")));
    let sum = balanced.collect::<Vec<_>>().join(" + ");
    let used = recipe(&format!(
        "\"dots\": solid_noise(size: (5, 5, 5)), \"one\": wide(x: \"= {sum}\"), \
         \"look\": mix(a: \"one\", b: \"one\", amount: 0),"
    ));
    let wrong = codes(&world(&used, &[("wide", &wide)]));
    assert!(wrong.contains(&Code::TooLarge), "{wrong:?}");
}

#[test]
fn a_default_lies_beside_the_compound_also_when_an_outer_one_leaves_it_out() {
    let inner = r#"(
        version: 1,
        inputs: { "photo": file(default: "bar.png") },
        nodes: { "bar": sample_pattern(file: "$photo", spans: bar, rings: 40, even_years: false) },
        outputs: { "bar": "bar" },
    )"#;
    let outer = r#"(
        version: 1,
        inputs: { "photo": file(optional: true) },
        nodes: { "lined": lined(photo: "$photo") },
        outputs: { "bar": "lined" },
    )"#;
    let nodes = r#""bar": outer(),
        "tree": skeleton(trunk: [(0, 0, 0), (0, 0, 1000)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 2),
        "look": pattern_lookup(time: "time", pattern: "bar"),"#;
    let world = world(&recipe(nodes), &[("lined", inner), ("outer", outer)]);
    let photo = std::fs::read("assets/spruce_bar/spruce_bar.png").unwrap();
    world.insert("r/nodes/bar.png", photo);
    rendered(&world);
}

#[test]
fn stand_ins_are_no_mistakes() {
    let text = r##"(
        version: 1,
        inputs: {
            "form": text(),
            "texels": whole(),
            "inputs": number(),
        },
        nodes: {
            "inputs": solid_noise(size: (5, 5, 5), form: "$form", gain: "$inputs"),
            "year": colour_pattern(stops: [(at: 0, colour: "#000000"), (at: 1, colour: "#ffffff")], texels: "$texels"),
        },
        outputs: { "value": "inputs.value", "year": "year" },
    )"##;
    let world = world("", &[("free", text)]);
    let path = Path::new("r/nodes/free.ron");
    let loaded = load(&world, path, &Settings::default());
    let loaded =
        loaded.unwrap_or_else(|wrong| panic!("{}", yosegi::diagnostics::render_all(&wrong)));
    assert_eq!(
        loaded.graph.node("inputs").unwrap().kind.name,
        "solid_noise"
    );
}

#[test]
fn names_are_limited() {
    let long = "a".repeat(101);
    let text = recipe(
        "\"look\": mix(a: (1, 0, 0), b: (0, 1, 0), amount: 0.5), \"LONG\": solid_noise(size: (1, 1, 1)),",
    );
    assert_eq!(
        codes(&world(&text.replace("LONG", &long), &[])),
        [Code::InvalidName]
    );
    loaded(&world(&text.replace("LONG", &long[1..]), &[])).unwrap();
}
