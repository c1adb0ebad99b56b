//! Laws of what kinds declare.

use super::*;

#[test]
fn a_default_that_is_written_out_changes_nothing() {
    for kind in KINDS {
        let head = format!("\"example\": {}(", kind.name);
        let (_, body) = kind
            .example
            .split_once(&head)
            .unwrap_or_else(|| panic!("no `{head}` in its example"));
        let plain = loaded(kind, kind.example);
        for (index, input) in kind.inputs.iter().enumerate() {
            let Presence::Default(literal) = input.presence else {
                continue;
            };
            if body.contains(&format!("{}:", input.name)) {
                continue;
            }
            let written = kind
                .example
                .replace(&head, &format!("{head}{}: {literal}, ", input.name));
            let written = loaded(kind, &written);
            let [default, literal] = [&plain, &written].map(|graph| source(graph, index));
            assert_eq!(literal, default, "`{}` of `{}`", input.name, kind.name);
        }
    }
}

/// The value of an input of the node or output `example`.
fn source(graph: &Graph, input: usize) -> String {
    let node = graph
        .nodes
        .node_weights()
        .find(|node| &*node.name == "example")
        .unwrap();
    match &node.inputs[input].source {
        Source::Literal(value) => format!("{value:?}"),
        other => panic!("a default is a literal, not {other:?}"),
    }
}

fn is_snake_case(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_lowercase())
        && name
            .chars()
            .all(|part| part.is_ascii_lowercase() || part.is_ascii_digit() || part == '_')
        && !name.ends_with('_')
        && !name.contains("__")
}

fn is_sentence(text: &str) -> bool {
    text.ends_with('.') && !text.contains("  ") && !text.contains('\n')
}

/// All inputs of a list, with the parts of records inside.
fn with_parts(inputs: &'static [Input]) -> Vec<&'static Input> {
    let parts = |value_type: Type| match value_type {
        Type::Record(parts) => with_parts(parts),
        Type::List(Type::Record(parts)) => with_parts(parts),
        _ => vec![],
    };
    inputs
        .iter()
        .flat_map(|input| [vec![input], parts(input.value_type)].concat())
        .collect()
}

#[test]
fn every_kind_says_what_it_is_and_where_it_comes_from() {
    for kind in KINDS {
        assert!(is_snake_case(kind.name), "{}", kind.name);
        assert!(
            kind.version > 0 && is_sentence(kind.about),
            "`{}`: {}",
            kind.name,
            kind.about
        );
        assert!(kind.source.len() > 10, "`{}`: {}", kind.name, kind.source);
        assert!(!kind.outputs.is_empty(), "`{}`", kind.name);
        for input in with_parts(kind.inputs) {
            assert!(
                is_snake_case(input.name),
                "`{}` of `{}`",
                input.name,
                kind.name
            );
            assert!(
                is_sentence(input.about),
                "`{}` of `{}`: {}",
                input.name,
                kind.name,
                input.about
            );
            assert!(
                input.range.is_none_or(|(low, high)| low < high),
                "`{}` of `{}`",
                input.name,
                kind.name
            );
        }
        for output in kind.outputs {
            assert!(
                is_snake_case(output.name) && is_sentence(output.about),
                "`{}` of `{}`",
                output.name,
                kind.name
            );
        }
    }
}

#[test]
fn names_are_different() {
    let kinds: BTreeSet<&str> = KINDS.iter().map(|kind| kind.name).collect();
    assert_eq!(kinds.len(), KINDS.len());
    for kind in KINDS {
        let inputs: BTreeSet<&str> = kind.inputs.iter().map(|input| input.name).collect();
        let outputs: BTreeSet<&str> = kind.outputs.iter().map(|output| output.name).collect();
        assert_eq!(
            (inputs.len(), outputs.len()),
            (kind.inputs.len(), kind.outputs.len()),
            "`{}`",
            kind.name
        );
    }
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let files = |path: PathBuf| {
        if path.is_dir() {
            rust_files(&path)
        } else {
            vec![path]
        }
    };
    entries
        .flat_map(files)
        .filter(|path| path.extension().is_some_and(|it| it == "rs"))
        .collect()
}

#[test]
fn one_node_is_one_file_and_one_line_in_the_table() {
    let declares = |path: &PathBuf| {
        fs::read_to_string(path)
            .unwrap()
            .contains("pub static KIND: Kind")
    };
    let files = rust_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/nodes"));
    let mut names: Vec<String> = files
        .iter()
        .filter(|path| declares(path))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    let mut table: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
    table.sort_unstable();
    assert_eq!(names, table);
    assert!(
        table
            .iter()
            .all(|name| kind(name).is_some_and(|kind| kind.name == *name))
    );
}
