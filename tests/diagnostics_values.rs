//! What a valid recipe means: the values, links and domains of its graph.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use petgraph::graph::NodeIndex;
use yosegi::diagnostics::{SourceFile, render_all};
use yosegi::graph::{Arithmetic, Function, Graph, Link, Operator, Settings, Source, load_text};
use yosegi::nodes::KINDS;
use yosegi::value::{Domain, Value};

const RECIPE: &str = r##"(
    about: "A spruce board",
    seed: 7,
    parameters: {
        "ring_width": number(default: 2.4, range: (0.5, 8.0), unit: "mm/year", about: "Mean growth"),
        "tint": colour(default: "#ff0000"),
        "from": vector(default: (0, 38, 900), unit: "mm"),
        "height": number(default: 1200, unit: "mm"),
        "saw": text(default: "end_grain"),
        "texels": whole(default: 64),
        "smooth": toggle(default: false),
    },
    nodes: {
        "tree": skeleton(
            trunk: [(0, 0, 0), (12, 4, 900)],
            branches: [(at: "$height", direction: (1, 0.2, 0.5), thickening: 0.4)],
        ),
        "time": growth_field(skeleton: "tree", elongation: 420, thickening: "$ring_width"),
        "bar": colour_pattern(
            stops: [(at: 0, colour: "#ffffff"), (at: 1, colour: "$tint")],
            texels: "$texels", smooth: "$smooth",
        ),
        "look": pattern_lookup(time: "time", pattern: "bar"),
        "wood": material(
            base_color: "look.colour", height: "= 0.03 * look.position", roughness: "= 1 - 0.4",
            extras: { "time": "time", "wear": 0.25, "tint": "$tint", "dark": (0.1, 0.2, 0.3) },
        ),
        "board": slice_cut(of: "wood", cut: "$saw", origin: "$from", size: (140, 900)),
    },
    outputs: { "board": maps(of: "board", pixels_per_mm: 4, channels: [base_color, "height"]) },
)"##;

fn settings(set: &[(&str, &str)]) -> Settings {
    let owned = |(name, value): &(&str, &str)| ((*name).to_owned(), (*value).to_owned());
    Settings {
        set: set.iter().map(owned).collect(),
        ..Settings::default()
    }
}

fn graph(text: &str, set: &[(&str, &str)]) -> Graph {
    match load_text("a.ron", text, &settings(set)) {
        Ok(loaded) => loaded.graph,
        Err(diagnostics) => panic!("{}", render_all(&diagnostics)),
    }
}

fn input<'g>(graph: &'g Graph, node: &str, input: &str) -> &'g Source {
    let node = graph.node(node).expect("the recipe has the node");
    let (index, _) = node.kind.input(input).expect("the kind has the input");
    &node.inputs[index].source
}

fn literal(graph: &Graph, node: &str, name: &str) -> String {
    match input(graph, node, name) {
        Source::Literal(value) => format!("{value:?}"),
        other => panic!("{other:?} is no literal"),
    }
}

/// Everything a graph means, without places and names of nodes.
fn meaning(graph: &Graph) -> String {
    let nodes = graph.nodes.node_weights().map(|node| {
        let sources: Vec<_> = node.inputs.iter().map(|binding| &binding.source).collect();
        format!("{} {:?} {sources:?}\n", node.kind.name, node.domain)
    });
    let parameters = graph
        .parameters
        .iter()
        .map(|p| format!("{} {:?}\n", p.name, p.value));
    let rest = format!("{} {} {:?}", graph.about, graph.seed, graph.outputs);
    nodes.chain(parameters).chain([rest]).collect()
}

/// The height of `wood`, which may vary, as arithmetic.
fn arithmetic(text: &str) -> Source {
    let recipe = RECIPE.replace("= 0.03 * look.position", text);
    input(&graph(&recipe, &[]), "wood", "height").clone()
}

fn folded(text: &str) -> f64 {
    match arithmetic(text) {
        Source::Literal(Value::Number(number)) => number,
        other => panic!("{other:?} is not folded"),
    }
}

#[test]
fn literals_have_the_type_of_their_input() {
    let graph = graph(RECIPE, &[]);
    assert_eq!(
        literal(&graph, "tree", "trunk"),
        "List([Vector(DVec3(0.0, 0.0, 0.0)), Vector(DVec3(12.0, 4.0, 900.0))])"
    );
    assert_eq!(
        literal(&graph, "tree", "branches"),
        "List([Record([(\"at\", Number(1200.0)), (\"direction\", Vector(DVec3(1.0, 0.2, 0.5))), \
         (\"thickening\", Number(0.4))])])"
    );
    assert_eq!(literal(&graph, "tree", "tangents"), "Choice(\"natural\")");
    assert_eq!(literal(&graph, "bar", "texels"), "Whole(64)");
    assert_eq!(literal(&graph, "bar", "smooth"), "Toggle(false)");
    assert_eq!(literal(&graph, "board", "cut"), "Choice(\"end_grain\")");
    assert_eq!(literal(&graph, "board", "size"), "Pair([140.0, 900.0])");
    assert!(matches!(input(&graph, "board", "across"), Source::Absent));
    let maps = &graph.nodes[graph.outputs[0]];
    let (channels, _) = maps.kind.input("channels").unwrap();
    let names = format!("{:?}", maps.inputs[channels].source);
    assert_eq!(names, "Literal(Names([\"base_color\", \"height\"]))");
}

#[test]
fn colours_in_quotes_are_srgb_and_others_are_linear() {
    let graph = graph(RECIPE, &[("tint", "#bc0080")]);
    let tint = literal(&graph, "bar", "stops");
    let Some(Source::Literal(Value::Colour([r, g, b]))) = channel(&graph, "tint") else {
        panic!("{tint}")
    };
    // sRGB 188 and 128 are 0.5029 and 0.2159 linear.
    assert!((r - 0.502_886).abs() < 1e-5 && g == 0.0 && (b - 0.215_861).abs() < 1e-5);
    assert!(tint.contains("Colour([1.0, 1.0, 1.0])"), "{tint}");
    let dark = channel(&graph, "dark");
    assert!(matches!(
        dark,
        Some(Source::Literal(Value::Colour([0.1, 0.2, 0.3])))
    ));
}

fn channel(graph: &Graph, name: &str) -> Option<Source> {
    let Source::Channels(channels) = input(graph, "wood", "extras") else {
        return None;
    };
    channels
        .iter()
        .find(|(channel, _)| channel == name)
        .map(|(_, source)| source.clone())
}

#[test]
fn channels_are_literals_parameters_and_links() {
    let graph = graph(RECIPE, &[]);
    assert!(matches!(
        channel(&graph, "wear"),
        Some(Source::Literal(Value::Number(0.25)))
    ));
    let Some(Source::Link(link)) = channel(&graph, "time") else {
        panic!()
    };
    assert_eq!((link.node, link.output), (graph.by_name["time"], 0));
}

#[test]
fn links_lead_to_the_first_output_or_to_a_named_one() {
    let graph = graph(RECIPE, &[]);
    let links = |node, name| input(&graph, node, name).links();
    assert_eq!(links("look", "time")[0].output, 0);
    assert_eq!(links("wood", "height")[0].output, 1);
    assert_eq!(links("wood", "height")[0].node, graph.by_name["look"]);
    let reads = |a: &str, b: &str| {
        graph
            .nodes
            .find_edge(graph.by_name[a], graph.by_name[b])
            .is_some()
    };
    assert!(reads("tree", "time") && reads("time", "look") && reads("time", "wood"));
    assert!(!reads("time", "tree") && !reads("tree", "look"));
}

#[test]
fn domains_follow_the_links() {
    let graph = graph(RECIPE, &[]);
    let domain = |name| graph.node(name).unwrap().domain;
    assert_eq!(domain("tree"), Domain::Everywhere);
    assert_eq!(domain("look"), Domain::Solid);
    assert_eq!(domain("wood"), Domain::Solid);
}

#[test]
fn parameters_can_be_set_in_their_own_type() {
    let set = [
        ("ring_width", "3"),
        ("from", "(1, 2, 3)"),
        ("saw", "plain_sawn"),
        ("smooth", "true"),
    ];
    let graph = graph(RECIPE, &set);
    assert_eq!(literal(&graph, "time", "thickening"), "Number(3.0)");
    assert_eq!(
        literal(&graph, "board", "origin"),
        "Vector(DVec3(1.0, 2.0, 3.0))"
    );
    assert_eq!(literal(&graph, "board", "cut"), "Choice(\"plain_sawn\")");
    assert_eq!(literal(&graph, "bar", "smooth"), "Toggle(true)");
    let ring_width = &graph.parameters[0];
    assert_eq!(
        (ring_width.unit.as_str(), ring_width.range),
        ("mm/year", Some((0.5, 8.0)))
    );
    assert_eq!(graph.seed, 7);
    let other = load_text(
        "a.ron",
        RECIPE,
        &Settings {
            seed: Some(9),
            ..Settings::default()
        },
    )
    .unwrap();
    assert_eq!(other.graph.seed, 9);
}

#[test]
fn constant_arithmetic_is_folded() {
    for (text, number) in [
        ("= 1 + 2 * 3", 7.0),
        ("=(1 + 2) * 3", 9.0),
        ("= 10 - 4 - 3", 3.0),
        ("= 12 / 4 / 3", 1.0),
        ("= -2 * -(3 - 1)", 4.0),
        ("= 2 - -3", 5.0),
        ("= 1.5e2 + .5", 150.5),
        ("= $height / 100", 12.0),
        ("= $texels", 64.0),
        ("= min(3, max(1, 2))", 2.0),
        ("= abs(-4) + sqrt(9) + sqrt(-1)", 7.0),
        ("= clamp(7, 0, 5) + mix(10, 20, 0.25)", 17.5),
    ] {
        assert_eq!(folded(text), number, "{text}");
    }
    // The red of Rec. 709.
    assert!((folded("= luminance($tint)") - 0.2126).abs() < 1e-6);
}

#[test]
fn arithmetic_over_links_keeps_its_shape() {
    let Source::Arithmetic(Arithmetic::Binary(Operator::Subtract, parts)) =
        arithmetic("= 2 * 3 - luminance(look.colour) / look.inside")
    else {
        panic!("expected a difference")
    };
    assert_eq!(parts[0], Arithmetic::Number(6.0));
    let Arithmetic::Binary(Operator::Divide, parts) = &parts[1] else {
        panic!()
    };
    assert!(matches!(&parts[0], Arithmetic::Call(Function::Luminance, of) if of.len() == 1));
    assert!(matches!(&parts[1], Arithmetic::Link(link) if link.output == 2));
}

#[test]
fn units_multiply_and_divide() {
    for text in [
        // $height is in mm, $ring_width in mm/year, time in years, look.position is plain.
        "= $height / 4",
        "= $ring_width * time",
        "= $ring_width * (time + 2)",
        "= 0.05 * look.position",
        "= $height * look.position - 3",
        "= sqrt($height * $height)",
        "= mix($height, 0, look.position)",
        "= max(1, $height * time / (time + 1))",
        "= $height * luminance(look.colour)",
        "= 0.3",
    ] {
        let _ = arithmetic(text);
    }
}

#[test]
fn constant_arithmetic_stands_in_parts_and_whole_numbers() {
    let recipe = RECIPE
        .replace("at: \"$height\"", "at: \"= $height / 2\"")
        .replace("size: (140, 900)", "size: (140, \"= $height - 300\")")
        .replace("texels: \"$texels\"", "texels: \"= 2 * $texels\"")
        .replace("(0.1, 0.2, 0.3)", "(0.1, \"= 0.1 * 2\", 0.3)");
    let graph = graph(&recipe, &[]);
    assert!(literal(&graph, "tree", "branches").contains("Number(600.0)"));
    assert_eq!(literal(&graph, "board", "size"), "Pair([140.0, 900.0])");
    assert_eq!(literal(&graph, "bar", "texels"), "Whole(128)");
    let dark = channel(&graph, "dark");
    assert!(matches!(
        dark,
        Some(Source::Literal(Value::Colour([0.1, 0.2, 0.3])))
    ));
}

#[test]
fn arithmetic_of_known_links_is_a_number() {
    let link = Link {
        node: NodeIndex::new(3),
        output: 0,
    };
    let two = || Arithmetic::Number(2.0);
    let sum = Arithmetic::Binary(Operator::Add, Box::new([two(), Arithmetic::Link(link)]));
    let negated = Arithmetic::Negate(Box::new(sum));
    let whole = Arithmetic::Call(Function::Max, vec![negated, Arithmetic::Number(-4.5)]);
    assert_eq!(whole.constant(&|_| Some(1.0)), Some(-3.0));
    assert_eq!(
        whole.constant(&|found| (found.output > 0).then_some(1.0)),
        None
    );
}

#[test]
fn tuples_and_lists_stand_for_each_other() {
    let other = RECIPE
        .replace("[(0, 0, 0), (12, 4, 900)]", "([0, 0, 0], [12, 4, 900,],)")
        .replace("size: (140, 900)", "size: [140.0, 9e2]")
        .replace("[base_color, \"height\"]", "(\"base_color\", height)");
    assert_eq!(meaning(&graph(&other, &[])), meaning(&graph(RECIPE, &[])));
}

#[test]
fn comments_line_endings_and_names_mean_nothing() {
    let expected = meaning(&graph(RECIPE, &[]));
    let commented = RECIPE.replace(",\n", ", // why\n /* \"tree\": /* nested */ */");
    for text in [
        commented,
        RECIPE.replace('\n', "\r\n"),
        RECIPE.replace('\n', "\r"),
        format!("\u{feff}{RECIPE}\n\n"),
        RECIPE
            .replace("\"look", "\"other")
            .replace("look.position", "other.position"),
        RECIPE
            .replace("\"#ff0000\"", "r#\"#ff0000\"#")
            .replace("\"tree\"", "\"tr\\u{65}e\""),
    ] {
        assert_eq!(meaning(&graph(&text, &[])), expected, "{text}");
    }
}

#[test]
fn text_keeps_its_dollar_signs() {
    let text = |written: &str| {
        let text = format!("(nodes: {{ \"a\": skeleton_from_file(pith: \"{written}\") }})");
        format!("{:?}", input(&graph(&text, &[]), "a", "pith"))
    };
    assert_eq!(text("$$pith"), "File(\"$pith\")");
    assert_eq!(text("costs $5"), "File(\"costs $5\")");
    assert_eq!(text("= 1 + 2"), "File(\"= 1 + 2\")");
}

#[test]
fn spans_are_the_bytes_of_the_file() {
    let text = format!("\u{feff}{}", RECIPE.replace('\n', "\r\n"));
    let graph = graph(&text, &[]);
    let SourceFile { text, .. } = &*graph.source;
    let wood = graph.node("wood").unwrap();
    assert_eq!(&text[wood.span.clone()], "\"wood\"");
    let (height, _) = wood.kind.input("height").unwrap();
    assert_eq!(
        &text[wood.inputs[height].span.clone()],
        "\"= 0.03 * look.position\""
    );
    let (metalness, _) = wood.kind.input("metalness").unwrap();
    assert_eq!(
        wood.inputs[metalness].span, wood.span,
        "a default stands at the node"
    );
}

#[test]
fn every_example_loads() {
    for kind in KINDS {
        let graph = graph(kind.example, &[]);
        let is_example = |name: &str| name == "example";
        let found = graph
            .nodes
            .node_weights()
            .find(|node| is_example(&node.name));
        assert_eq!(found.unwrap().kind.name, kind.name);
    }
}
