//! Skeletons from measured trees in CSV.

use super::*;
use glam::DVec3;
use std::sync::Mutex;
use yosegi::engine::Event;
use yosegi::node::{Build, Failure, Inputs};
use yosegi::nodes::wood::skeleton_from_file::KIND;
use yosegi::value::{FileContents, Skeleton, Thickness, Value};

fn read(tree: impl Into<Vec<u8>>, unit: Option<&'static str>) -> Result<Arc<Skeleton>, Failure> {
    let mut values = vec![None; KIND.inputs.len()];
    let file = FileContents {
        path: "tree.csv".into(),
        bytes: tree.into().into(),
    };
    let given = [
        ("tree", Some(Value::File(file))),
        ("unit", unit.map(Value::Choice)),
        ("tangents", Some(Value::Choice("natural"))),
        ("every", Some(Value::Whole(1))),
    ];
    for (name, value) in given {
        values[KIND.input(name).unwrap().0] = value;
    }
    let build = Build {
        node: &Arc::from("test"),
        seed: 0,
        cancel: None,
    };
    match (KIND.build)(&Inputs::new(&KIND, &values), &build)?.remove(0) {
        Value::Skeleton(skeleton) => Ok(skeleton),
        other => panic!("found a {}", other.type_name()),
    }
}

/// A trunk of three nodes in metres with a branch, a twig on it, and a part that hangs.
const NODES: &str = "id,parent,x,y,z,radius
10,-1,5,5,100,0.2
20,10,5,5,101,0.2
30,20,5.1,5,103,0.1
40,20,6,5,102,0.05
50,40,7,5,102,0.04
60,40,6,6,102,0.01
70,30,5.2,5,102.5,0.05
";

#[test]
fn nodes_become_a_trunk_from_the_origin_and_a_branch() {
    let skeleton = read(NODES, Some("m")).unwrap();
    let expected = [[0.0, 0.0, 0.0], [0.0, 0.0, 1000.0], [100.0, 0.0, 3000.0]];
    assert!(
        skeleton
            .trunk
            .iter()
            .zip(expected)
            .all(|(a, b)| a.distance(DVec3::from_array(b)) < 1e-6)
    );
    let [branch] = &skeleton.branches[..] else {
        panic!("{:?}", skeleton.branches)
    };
    assert!((branch.height - 1000.0).abs() < 1e-9);
    assert!(
        branch
            .direction
            .distance(DVec3::new(1.0, 0.0, 1.0).normalize())
            < 1e-9
    );
    let Thickness::HalfWidth {
        distance,
        half_width,
    } = branch.thickness
    else {
        panic!("expected a half width")
    };
    assert!((distance - 1000.0 * 2f64.sqrt()).abs() < 1e-6 && (half_width - 50.0).abs() < 1e-9);
}

#[test]
fn the_same_tree_is_read_from_every_dialect() {
    let plain = read(NODES, Some("m")).unwrap();
    let commas = NODES.replace(',', ";").replace('.', ",");
    let dialects = [
        format!("\u{feff}{NODES}").into_bytes(),
        NODES.replace('\n', "\r\n").into_bytes(),
        NODES.replace('\n', "\r").into_bytes(),
        NODES.replace(',', "\t").into_bytes(),
        commas.into_bytes(),
        NODES
            .replace("ID", "Id")
            .replace("0.2", "\"0.2\"")
            .into_bytes(),
        format!("# a tree\n# unit: m\n{NODES}").into_bytes(),
    ];
    for (index, dialect) in dialects.into_iter().enumerate() {
        assert_eq!(read(dialect, Some("m")).unwrap(), plain, "dialect {index}");
    }
    assert_eq!(read(format!("# unit: m\n{NODES}"), None).unwrap(), plain);
    let mut nodes: Vec<&str> = NODES.lines().collect();
    nodes[1..].reverse();
    let reversed = read(nodes.join("\n"), Some("m")).unwrap();
    assert_eq!(
        (&reversed.trunk, &reversed.branches),
        (&plain.trunk, &plain.branches)
    );
}

/// What is said about a tree in metres.
fn told(tree: impl Into<Vec<u8>>) -> String {
    let failure = read(tree, Some("m")).unwrap_err();
    assert_eq!(failure.input, Some("tree"));
    failure.message
}

#[test]
fn what_is_wrong_with_a_file_is_told_with_line_and_column() {
    let with = |from: &str, to: &str| {
        assert!(NODES.contains(from));
        told(NODES.replacen(from, to, 1))
    };
    assert_eq!(told(""), "the file is empty");
    assert_eq!(
        told("id,parent,x,y,z,radius\n"),
        "the file has a header, but no rows"
    );
    assert_eq!(
        with("5.1", "NaN"),
        "line 4: column 3 (`x`): expected a finite number, found `NaN`"
    );
    assert_eq!(
        with("5.1", ""),
        "line 4: column 3 (`x`): expected a finite number, found an empty cell"
    );
    assert_eq!(
        with("5.1", "1e400"),
        "line 4: column 3 (`x`): expected a finite number, found `1e400`"
    );
    assert_eq!(with("5.1,5", "5.1"), "line 4: expected 6 cells, found 5");
    assert_eq!(
        with("5.1", "\"5.1"),
        "line 4: a quotation mark that is not closed"
    );
    assert_eq!(with("5.1", "5\0"), "line 4: a zero byte: this is no text");
    assert_eq!(
        with("30,20", "30.5,20"),
        "line 4: column 1 (`id`): expected a whole number, found `30.5`"
    );
    assert_eq!(
        with("30,20", "20,20"),
        "line 4: column 1 (`id`): expected an id that no line before has, found `20`"
    );
    assert_eq!(
        with("30,20", "30,21"),
        "line 4: column 2 (`parent`): expected an id of the file, 0 or -1, found `21`"
    );
    assert_eq!(
        with("30,20", "30,-1"),
        "the tree has several roots, in lines 2 and 4"
    );
    assert_eq!(
        with("30,20", "30,30"),
        "the part in line 4 is its own parent"
    );
    assert_eq!(
        with("20,10", "20,30"),
        "parts are each other's parents, in lines 3, 4"
    );
    assert_eq!(
        with("0.1\n", "-0.1\n"),
        "line 4: column 6 (`radius`): expected a radius of at least 0, found `-0.1`"
    );
    assert_eq!(with("y,z", "y,y"), "columns 4 and 5 are both called `y`");
    assert_eq!(
        with("y,z", "y,height"),
        "the columns are id, parent, x, y, height, radius"
    );
    assert_eq!(
        with("10,-1,5,5,100", "10,-1,5,5,10000"),
        "line 3: the part lies more than 1 km from the root"
    );
}

#[test]
fn units_have_to_be_known_and_agree() {
    let none = read(NODES, None).unwrap_err();
    assert_eq!(
        none.message,
        "the file does not say in which unit its lengths are"
    );
    let both = read(format!("# unit: mm\n{NODES}"), Some("m")).unwrap_err();
    assert_eq!(both.message, "`unit` is m, and the file says mm");
    assert_eq!(
        told(format!("# unit: km\n{NODES}")),
        "line 1: expected the unit mm, cm or m, found `km`"
    );
    assert_eq!(told(b"\xff\xfei\0d\0".to_vec()), "the file is UTF-16");
    assert_eq!(
        told(b"id,parent\n\xe4".to_vec()),
        "line 2: letters that are not UTF-8"
    );
}

fn asset() -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/measured_tree/tree.csv");
    std::fs::read(path).unwrap()
}

#[test]
fn a_measured_tree_is_read_and_what_is_left_out_is_told() {
    let skeleton = read(asset(), Some("m")).unwrap();
    assert!(
        skeleton
            .trunk
            .windows(2)
            .all(|pair| pair[1].z >= pair[0].z + 1.0)
    );
    assert_eq!(skeleton.trunk[0], DVec3::ZERO);
    // The first cylinder ends 0.8579 m along (0.01314, -0.01595, 0.99979).
    assert!(
        (skeleton.trunk[1].z - 857.9 * 0.999_786).abs() < 0.1,
        "{}",
        skeleton.trunk[1]
    );
    let world = Memory::default();
    world.insert("recipes/tree.csv", asset());
    let recipe = "(nodes: { \"tree\": skeleton_from_file(tree: \"tree.csv\", unit: m),
        \"example\": growth_field(skeleton: \"tree\", elongation: 400, thickening: 3) })";
    let graph = load_text("recipes/recipe.ron", recipe, &Settings::default())
        .unwrap()
        .graph;
    let engine = Engine::new(Arc::new(world), Options::default()).unwrap();
    for _ in 0..2 {
        let told = Mutex::new(vec![]);
        let listener = |event: Event| {
            if let Event::Warning { node, message, .. } = event {
                told.lock().unwrap().push(format!("{node}: {message}"));
            }
        };
        engine.fields(&graph, "example", &listener).unwrap();
        let told = told.into_inner().unwrap();
        println!(
            "{told:#?}\n{} points, {} branches",
            skeleton.trunk.len(),
            skeleton.branches.len()
        );
        assert!(
            told.iter()
                .any(|it| it.contains("branches of branches are left out")),
            "{told:?}"
        );
    }
}

#[test]
fn a_hanging_part_of_the_trunk_is_left_out() {
    // The last part hangs, and is the only one that goes on from the trunk.
    let skeleton = read(NODES, Some("m")).unwrap();
    assert_eq!(skeleton.trunk.len(), 3);
    let hanging = read(
        "id,parent,x,y,z,radius\n1,0,0,0,0,1\n2,1,0,0,0.0005,1\n3,2,1,0,2,1\n4,3,1,0,2,1\n5,4,1,0,1,1\n6,5,2,0,9,1",
        Some("mm"),
    );
    let heights: Vec<f64> = hanging.unwrap().trunk.iter().map(|point| point.z).collect();
    assert_eq!(heights, [0.0, 2.0, 9.0]);
    assert!(
        told("id,parent,x,y,z,radius\n1,0,0,0,0,1\n2,1,1,0,0,1")
            .contains("expected at least 2 nodes, found 1")
    );
}
