//! Edits of a recipe's text: what is asked for changes, and not a byte more.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use petgraph::visit::IntoNodeReferences;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use yosegi::diagnostics::{Code, Diagnostic, SourceFile, render_all};
use yosegi::graph::edit::{Change, Edit, Place, Section, Step, apply, changes, find};
use yosegi::graph::{Graph, Settings, Source, kinds};
use yosegi::node::Kind;
use yosegi::world::{Disk, Memory, World};

const RECIPE: &str = r##"(
    // The tree comes first.
    about: "A board", /* and its seed */ seed: 7,
    parameters: { "depth": number(default: 0.2, unit: "mm"), "tint": colour(default: "#ff0000") },
    nodes: {
        "bar": colour_pattern(
            stops: [(at: 0, colour: "#ffffff"), (at: 1, colour: "$tint")], // two stops
            texels: 64 // enough
        ),
        "look": pattern_lookup(time: 1, pattern: "bar"),
        "wood": material(
            base_color: "look.colour", // of the year
            height: "= $depth * look.position + 0.1 * $depth", roughness: 0.6,
            extras: { "look": "look.inside", "both": "= look.position*look\u{2e}inside" },
        ),
        "board": slice_cut(of: "wood", origin: (0, 38, 900), size: (140, 900)),
    },
    outputs: { "board": maps(of: "board", pixels_per_mm: 4, channels: [base_color, "look"]) },
)
"##;

/// All kinds, the compounds that come with Yosegi among them.
fn all_kinds() -> Vec<&'static Kind> {
    kinds(&Disk, Path::new("graphs"))
}

fn source(text: &str) -> Arc<SourceFile> {
    Arc::new(SourceFile::new("a.ron", text))
}

fn edited(text: &str, edit: &Edit) -> String {
    apply(&all_kinds(), &source(text), edit).unwrap_or_else(|all| panic!("{}", render_all(&all)))
}

fn refused(text: &str, edit: &Edit) -> Diagnostic {
    changes(&all_kinds(), &source(text), edit)
        .unwrap_err()
        .remove(0)
}

/// The recipe in a folder beside the compounds of the gallery.
fn load(text: &str) -> Graph {
    let world = Memory::default();
    for name in ["cherry.ron", "hinoki_trunk.ron"] {
        let compound = Disk.read(&Path::new("graphs/nodes").join(name)).unwrap();
        world.insert(Path::new("nodes").join(name), compound);
    }
    world.insert("a.ron", text);
    match yosegi::graph::load(&world, Path::new("a.ron"), &Settings::default()) {
        Ok(loaded) => loaded.graph,
        Err(all) => panic!("{text}\n{}", render_all(&all)),
    }
}

fn node(name: &str, input: &str, path: &[Step]) -> Place {
    Place::Field {
        section: Section::Nodes,
        name: name.into(),
        field: input.into(),
        path: path.to_vec(),
    }
}

fn set(place: Place, literal: &str) -> Edit {
    Edit::Set {
        place,
        literal: literal.into(),
    }
}

fn rename(section: Section, from: &str, to: &str) -> Edit {
    Edit::Rename {
        section,
        from: from.into(),
        to: to.into(),
    }
}

fn part(name: &str) -> Step {
    Step::Part(name.into())
}

fn entry(name: &str) -> Step {
    Step::Entry(name.into())
}

/// Sets a value and expects this piece of the recipe to become that.
fn sets(place: Place, literal: &str, before: &str, after: &str) {
    assert_eq!(RECIPE.matches(before).count(), 1, "{before}");
    let edited = edited(RECIPE, &set(place, literal));
    assert_eq!(edited, RECIPE.replace(before, after));
}

#[test]
fn a_value_that_is_written_is_replaced() {
    sets(node("wood", "roughness", &[]), "0.35", "0.6", "0.35");
    sets(node("bar", "texels", &[]), " 128 ", "64 //", "128 //");
    sets(node("board", "origin", &[Step::Item(1)]), "40", "38", "40");
    let colour = [Step::Item(0), part("colour")];
    sets(
        node("bar", "stops", &colour),
        "(1, 1, 0)",
        "\"#ffffff\"",
        "(1, 1, 0)",
    );
    let both = [entry("look")];
    sets(
        node("wood", "extras", &both),
        "0.5",
        "\"look.inside\"",
        "0.5",
    );
    sets(
        Place::Recipe("about".into()),
        "\"Two\"",
        "\"A board\"",
        "\"Two\"",
    );
    sets(Place::Recipe("seed".into()), "8", "seed: 7", "seed: 8");
    let default = Place::input(Section::Parameters, "depth", "default");
    sets(default, "0.3", "default: 0.2", "default: 0.3");
    let resolution = Place::input(Section::Outputs, "board", "pixels_per_mm");
    sets(resolution, "8", "pixels_per_mm: 4", "pixels_per_mm: 8");
}

#[test]
fn a_value_that_is_not_written_goes_behind_the_others() {
    sets(
        node("board", "offset", &[]),
        "0.5",
        "size: (140, 900))",
        "size: (140, 900), offset: 0.5)",
    );
    // A comment stays with the line that it is about, and gets its comma.
    sets(
        node("bar", "smooth", &[]),
        "true",
        "texels: 64 // enough\n",
        "texels: 64, // enough\n            smooth: true\n",
    );
    sets(
        node("wood", "metalness", &[]),
        "0.1",
        "look\\u{2e}inside\" },\n",
        "look\\u{2e}inside\" },\n            metalness: 0.1,\n",
    );
    let opacity = [entry("new")];
    sets(
        node("wood", "extras", &opacity),
        "1",
        "inside\" },",
        "inside\", \"new\": 1 },",
    );
    sets(
        node("bar", "stops", &[Step::Item(2)]),
        "(at: 2, colour: \"#000000\")",
        "\"$tint\")]",
        "\"$tint\"), (at: 2, colour: \"#000000\")]",
    );
}

#[test]
fn empty_brackets_take_a_first_item() {
    let add = Edit::Add {
        section: Section::Nodes,
        name: "a".into(),
        instance: "mix()".into(),
    };
    for (text, expected) in [
        ("(nodes: {})", "(nodes: {\"a\": mix()})"),
        ("(nodes: { /* c */ })", "(nodes: { /* c */ \"a\": mix()})"),
        (
            "(\n    nodes: {\n    },\n)",
            "(\n    nodes: {\n        \"a\": mix(),\n    },\n)",
        ),
        (
            "(\r\n    nodes: { // c\r\n    },\r\n)",
            "(\r\n    nodes: { // c\r\n        \"a\": mix(),\r\n    },\r\n)",
        ),
        ("()", "(nodes: { \"a\": mix() })"),
        ("(seed: 1)", "(seed: 1, nodes: { \"a\": mix() })"),
        (
            "(\n\tseed: 1, // c\n)",
            "(\n\tseed: 1, // c\n\tnodes: { \"a\": mix() },\n)",
        ),
    ] {
        assert_eq!(edited(text, &add), expected);
    }
    let amount = set(node("a", "amount", &[]), "1");
    assert_eq!(
        edited("(nodes: {\"a\": mix()})", &amount),
        "(nodes: {\"a\": mix(amount: 1)})"
    );
}

#[test]
fn removing_takes_the_comma_and_an_empty_line() {
    let removes = |place: Place, before: &str, after: &str| {
        assert_eq!(RECIPE.matches(before).count(), 1, "{before}");
        let edited = edited(RECIPE, &Edit::Remove { place });
        assert_eq!(edited, RECIPE.replace(before, after));
    };
    removes(node("wood", "roughness", &[]), " roughness: 0.6,", "");
    removes(
        node("wood", "base_color", &[]),
        "            base_color: \"look.colour\", // of",
        "            // of",
    );
    removes(
        node("wood", "extras", &[]),
        "            extras: { \"look\": \"look.inside\", \"both\": \"= look.position*look\\u{2e}inside\" },\n",
        "",
    );
    removes(
        node("bar", "texels", &[]),
        "texels: 64 // enough",
        "// enough",
    );
    removes(node("look", "pattern", &[]), ", pattern: \"bar\")", ")");
    removes(node("look", "time", &[]), "time: 1, ", "");
    removes(
        node("bar", "stops", &[Step::Item(0)]),
        "(at: 0, colour: \"#ffffff\"), ",
        "",
    );
    removes(Place::Recipe("seed".into()), " seed: 7,", "");
}

#[test]
fn links_follow_a_renamed_node() {
    let text = edited(RECIPE, &rename(Section::Nodes, "look", "year"));
    let expected = RECIPE
        .replace("\"look\": pattern_lookup", "\"year\": pattern_lookup")
        .replace("\"look.colour\"", "\"year.colour\"")
        .replace("* look.position +", "* year.position +")
        .replace("\"look\": \"look.inside\"", "\"look\": \"year.inside\"")
        .replace(
            "= look.position*look\\u{2e}inside",
            "= year.position*year.inside",
        );
    assert_eq!(text, expected);
    assert_eq!(meaning(&load(&text)), meaning(&load(RECIPE)));
}

#[test]
fn references_follow_a_renamed_parameter() {
    let text = edited(RECIPE, &rename(Section::Parameters, "depth", "relief"));
    let expected = RECIPE
        .replace("\"depth\": number", "\"relief\": number")
        .replace("$depth", "$relief");
    assert_eq!(text, expected);
    let text = edited(RECIPE, &rename(Section::Parameters, "tint", "late"));
    assert_eq!(
        text,
        RECIPE
            .replace("\"tint\": colour", "\"late\": colour")
            .replace("$tint", "$late")
    );
    let text = edited(RECIPE, &rename(Section::Outputs, "board", "plank"));
    assert_eq!(text, RECIPE.replace("\"board\": maps", "\"plank\": maps"));
}

#[test]
fn nodes_come_and_go() {
    let add = Edit::Add {
        section: Section::Nodes,
        name: "other".into(),
        instance: "material(base_color: \"look\")".into(),
    };
    let more = edited(RECIPE, &add);
    let new = "        \"other\": material(base_color: \"look\"),\n    },\n    outputs";
    assert_eq!(more, RECIPE.replace("    },\n    outputs", new));
    let delete = Edit::Delete {
        section: Section::Nodes,
        name: "other".into(),
    };
    assert_eq!(edited(&more, &delete), RECIPE);
}

#[test]
fn what_cannot_be_done_is_refused() {
    let delete = |section, name: &str| Edit::Delete {
        section,
        name: name.into(),
    };
    let add = |name: &str, instance: &str| Edit::Add {
        section: Section::Nodes,
        name: name.into(),
        instance: instance.into(),
    };
    let remove = |place| Edit::Remove { place };
    let rough = || node("wood", "roughness", &[]);
    for (edit, code, message) in [
        (
            delete(Section::Nodes, "look"),
            Code::InvalidEdit,
            "used by `wood`",
        ),
        (
            delete(Section::Parameters, "tint"),
            Code::InvalidEdit,
            "used by `bar`",
        ),
        (
            delete(Section::Nodes, "loook"),
            Code::UnknownNode,
            "no node `loook`",
        ),
        (
            delete(Section::Outputs, "plank"),
            Code::NoOutput,
            "no output `plank`",
        ),
        (
            remove(node("board", "offset", &[])),
            Code::InvalidEdit,
            "nothing to remove",
        ),
        (
            rename(Section::Nodes, "look", "Look"),
            Code::InvalidName,
            "`Look`",
        ),
        (
            rename(Section::Nodes, "look", "bar"),
            Code::DuplicateName,
            "called `bar`",
        ),
        (add("look", "mix()"), Code::DuplicateName, "called `look`"),
        (add("new", "3"), Code::NotANode, "an instance"),
        (add("new", "mix(1)"), Code::NotANode, "an instance"),
        (
            set(node("wood", "rough", &[]), "1"),
            Code::UnknownInput,
            "`rough`",
        ),
        (set(rough(), "1, x: 2"), Code::Syntax, "end of the file"),
        (set(rough(), "1 // c"), Code::Syntax, "one value"),
        (set(rough(), ""), Code::Syntax, "nothing"),
        (set(rough(), "(1"), Code::Unclosed, "`(`"),
        (set(rough(), "1.2.3"), Code::Syntax, "not a number"),
        (
            set(node("wood", "roughness", &[Step::Item(0)]), "1"),
            Code::TypeMismatch,
            "a list",
        ),
        (
            set(node("board", "origin", &[Step::Item(4)]), "1"),
            Code::WrongLength,
            "only 3",
        ),
        (
            set(node("board", "offset", &[part("a")]), "1"),
            Code::MissingInput,
            "not written",
        ),
        (
            set(Place::Recipe("nodes".into()), "1"),
            Code::UnknownField,
            "`nodes`",
        ),
        (
            set(node("bar", "stops", &[Step::Item(0), part("a b")]), "1"),
            Code::InvalidName,
            "`a b`",
        ),
    ] {
        let problem = refused(RECIPE, &edit);
        assert_eq!(problem.code, code, "{edit:?}: {}", problem.message);
        assert!(problem.message.contains(message), "{}", problem.message);
    }
    let deep = set(rough(), &format!("{}1{}", "(".repeat(62), ")".repeat(62)));
    assert_eq!(refused(RECIPE, &deep).code, Code::NestedTooDeep);
    assert_eq!(
        refused("(nodes: {", &set(rough(), "1")).code,
        Code::Unclosed
    );
    assert_eq!(refused("// c", &set(rough(), "1")).code, Code::NotARecipe);
    let twice = "(nodes: { \"a\": mix(a: 1, a: 2), \"b\": mix(), \"b\": mix() })";
    assert_eq!(
        refused(twice, &set(node("a", "a", &[]), "1")).code,
        Code::DuplicateField
    );
    assert_eq!(
        refused(twice, &set(node("b", "a", &[]), "1")).code,
        Code::DuplicateName
    );
    let unknown = "(nodes: { \"a\": none(b: \"c\"), \"c\": mix() })";
    let problem = refused(unknown, &rename(Section::Nodes, "c", "d"));
    assert_eq!(problem.code, Code::UnknownKind);
}

/// Everything that a graph means, without places and names of nodes.
fn meaning(graph: &Graph) -> Vec<String> {
    let nodes = graph.nodes.node_weights().map(|node| {
        let sources: Vec<_> = node.inputs.iter().map(|binding| &binding.source).collect();
        format!("{} {:?} {sources:?}", node.kind.name, node.domain)
    });
    nodes.collect()
}

fn gallery() -> Vec<String> {
    let folder = fs::read_dir("graphs").unwrap();
    let mut paths: Vec<_> = folder.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|found| found == "ron"));
    paths.sort();
    let texts = paths.iter().map(|path| fs::read_to_string(path).unwrap());
    texts.chain([RECIPE.to_owned()]).collect()
}

/// Every number that an input of a node holds as a literal in the text, by node and input.
fn numbers(graph: &Graph) -> Vec<(usize, usize, f64)> {
    let mut found = vec![];
    // What lies inside compounds is no part of the text.
    let nodes = graph.nodes.node_weights().enumerate();
    for (position, node) in nodes.filter(|(_, node)| node.origin.uses.is_none()) {
        for (index, binding) in node.inputs.iter().enumerate() {
            let written = graph.source.text[binding.span.clone()].parse::<f64>();
            if let (Source::Literal(_), Ok(number)) = (&binding.source, written) {
                found.push((position, index, number));
            }
        }
    }
    found
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// A slider: only the node's input changes, to the number, and nothing outside its bytes.
    #[test]
    fn setting_a_number_sets_that_number(recipe in 0..4_usize, pick in any::<prop::sample::Index>(), share in 0.0..1.0_f64) {
        let texts = gallery();
        let text = &texts[recipe % texts.len()];
        let before = load(text);
        let numbers = numbers(&before);
        let (position, index, old) = *pick.get(&numbers);
        let name = &before.nodes.node_weights().nth(position).unwrap().name;
        let kind = before.nodes.node_weights().nth(position).unwrap().kind;
        let input = &kind.inputs[index];
        let (low, high) = input.range.unwrap_or((-100.0, 100.0));
        let whole = input.value_type == yosegi::value::Type::Whole;
        let new = low.max(old / 2.0) * (1.0 - share) + high.min(old * 2.0 + 1.0) * share;
        let new = if whole { new.round() } else { new };
        let is_node = before.by_name.get(&**name).is_some_and(|node| node.index() == position);
        let section = if is_node { Section::Nodes } else { Section::Outputs };
        let place = Place::input(section, &**name, input.name);
        let literal = new.to_string();
        let edit = set(place.clone(), &literal);
        let source = source(text);
        let span = find(&source, &place).unwrap().expect("the number is written");
        let edited = apply(&all_kinds(), &source, &edit).unwrap();
        prop_assert_eq!(&edited[..span.start], &text[..span.start]);
        prop_assert_eq!(&edited[span.start + literal.len()..], &text[span.end..]);
        let after = load(&edited);
        for (at, (a, b)) in before.nodes.node_weights().zip(after.nodes.node_weights()).enumerate() {
            for (other, (a, b)) in a.inputs.iter().zip(&b.inputs).enumerate() {
                let [a, b] = [a, b].map(|binding| format!("{:?}", binding.source));
                if at == position && other == index {
                    prop_assert!(b.contains(&format!("({new:?})")) || whole, "{b} {new:?}");
                } else {
                    prop_assert_eq!(a, b);
                }
            }
        }
    }
}

/// What each entry of a recipe holds, for edits of everything.
fn places(text: &str) -> Vec<Place> {
    let graph = load(text);
    let mut places = vec![Place::Recipe("about".into()), Place::Recipe("seed".into())];
    let nodes = graph.nodes.node_references();
    for (index, node) in nodes.filter(|(_, node)| node.origin.uses.is_none()) {
        let section = match graph.outputs.contains(&index) {
            true => Section::Outputs,
            false => Section::Nodes,
        };
        for input in node.kind.inputs {
            places.push(Place::input(section, &*node.name, input.name));
        }
    }
    places
}

#[test]
fn editing_to_the_same_value_changes_nothing() {
    let mut count = 0;
    for text in gallery() {
        for place in places(&text) {
            let source = source(&text);
            let Some(span) = find(&source, &place).unwrap() else {
                continue;
            };
            let same = set(place, &text[span]);
            assert_eq!(
                changes(&all_kinds(), &source, &same).unwrap(),
                [] as [Change; 0]
            );
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

#[test]
fn setting_what_is_not_written_and_removing_it_gives_the_old_text() {
    let (mut same, mut all) = (0, 0);
    for text in gallery() {
        for place in places(&text) {
            if find(&source(&text), &place).unwrap().is_some() {
                continue;
            }
            let more = edited(&text, &set(place.clone(), "0.123"));
            let span = find(&source(&more), &place).unwrap().unwrap();
            assert_eq!(&more[span], "0.123");
            let back = edited(&more, &Edit::Remove { place });
            // A comma that was added for the new line may stay.
            assert_eq!(back.replace(',', ""), text.replace(',', ""));
            all += 1;
            same += usize::from(back == text);
        }
    }
    assert!(all > 80 && same * 10 > all * 9, "{same} of {all}");
}

#[test]
fn every_node_can_be_renamed_and_back() {
    for text in gallery() {
        let graph = load(&text);
        let written = |name: &&String| !name.contains('/');
        for name in graph.by_name.keys().filter(written) {
            let renamed = edited(&text, &rename(Section::Nodes, name, "quite_another"));
            assert_eq!(meaning(&load(&renamed)), meaning(&graph), "{name}");
            let back = edited(&renamed, &rename(Section::Nodes, "quite_another", name));
            assert_eq!(back.replace("\\u{2e}", "."), text.replace("\\u{2e}", "."));
        }
        for parameter in &graph.parameters {
            let renamed = edited(
                &text,
                &rename(Section::Parameters, &parameter.name, "other"),
            );
            assert_eq!(
                meaning(&load(&renamed)),
                meaning(&graph),
                "{}",
                parameter.name
            );
        }
    }
}
