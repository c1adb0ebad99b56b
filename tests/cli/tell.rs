//! `yosegi check`, `sample` and `nodes`.

use super::*;

#[test]
fn check_says_what_is_wrong_and_writes_nothing() {
    let place = Place::new(BOARD);
    let clean = place.call(&["check", "recipe.ron"]);
    assert_eq!((code(&clean), stderr(&clean)), (0, String::new()));
    assert_eq!(
        stdout(&clean),
        "recipe.ron: 6 nodes, 2 outputs, nothing wrong\n"
    );
    place.write("dirty.ron", &edit("thickening", "thickning"));
    let dirty = place.call(&["check", "dirty.ron", "recipe.ron"]);
    assert_eq!(code(&dirty), 2);
    assert!(
        stderr(&dirty).contains("thickning") && stderr(&dirty).contains("dirty.ron:5"),
        "{}",
        stderr(&dirty)
    );
    assert!(stdout(&dirty).contains("recipe.ron: 6 nodes"));
    let json = lines(&place.call(&["check", "dirty.ron", "--json"]));
    assert!(
        json.iter().any(|line| line["code"] == "unknown-input"),
        "{json:?}"
    );
    assert_eq!(code(&place.call(&["check", "none.ron"])), 3);
    assert!(!place.path("out").exists());
}

#[test]
fn sample_prints_values_in_a_solid() {
    let (nodes, _) = BOARD.split_once("    outputs").unwrap();
    let place = Place::new(&format!("{nodes})"));
    let height = place.sample("wood.height", "x,y,z\n1,2,3\n-4.5,5e1,6\n");
    assert_eq!(
        (code(&height), stdout(&height)),
        (0, "x,y,z,height\n1,2,3,2.5\n-4.5,5e1,6,2.5\n".to_owned())
    );
    let time = place.sample("time.time", "x,y,z\n10,0,100\n40,0,100\n10,0,100\n");
    let text = stdout(&time);
    let values: Vec<f32> = text
        .lines()
        .skip(1)
        .map(|line| line.rsplit(',').next().unwrap().parse().unwrap())
        .collect();
    assert!(
        text.starts_with("x,y,z,time\n") && values.len() == 3,
        "{text}"
    );
    assert!(
        values[0] > 0.0 && values[1] > values[0] && values[2] == values[0],
        "{text}"
    );
    let colour = stdout(&place.sample("look.colour", "x,y,z\n10,0,100\n"));
    assert!(
        colour.starts_with("x,y,z,colour.r,colour.g,colour.b\n"),
        "{colour}"
    );
}

#[test]
fn sample_prints_values_on_a_plane() {
    let place = Place::new(BOARD);
    let output = place.sample("plank.base_color", "u,v\n60,50\n");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    // The middle of the piece is the cut's origin.
    let [plane, solid] =
        [output, place.sample("wood.base_color", "x,y,z\n0,0,600\n")].map(|output| {
            let text = stdout(&output);
            text.lines()
                .nth(1)
                .unwrap()
                .split(',')
                .rev()
                .take(3)
                .map(str::to_owned)
                .collect::<Vec<_>>()
        });
    assert_eq!(plane, solid);
}

#[test]
fn sample_says_what_is_wrong_with_its_points_or_its_node() {
    let place = Place::new(BOARD);
    for (node, points, expected) in [
        ("time", "u,v\n1,2\n", "expected the header x,y,z, found u,v"),
        ("time", "x,y\n1,2\n", "expected the header x,y,z, found x,y"),
        (
            "plank",
            "x,y,z\n1,2,3\n",
            "expected the header u,v, found x,y,z",
        ),
        ("time", "", "expected the header x,y,z"),
        (
            "time",
            "x,y,z\n1,2,nan\n",
            "line 2: expected a finite number, found `nan`",
        ),
        (
            "time",
            "x,y,z\n1,2,3\n1,inf,3\n",
            "line 3: expected a finite number, found `inf`",
        ),
        ("time", "x,y,z\n1,two,3\n", "found `two`"),
        ("time", "x,y,z\n1,2\n", "points.csv"),
        ("tim", "x,y,z\n1,2,3\n", "`time`"),
        ("time.age", "x,y,z\n1,2,3\n", "it gives time, branch"),
        ("tree", "x,y,z\n1,2,3\n", "gives no field"),
    ] {
        let output = place.sample(node, points);
        assert_eq!(code(&output), 2, "{node}, {points:?}: {}", stderr(&output));
        assert!(
            stderr(&output).contains(expected),
            "{node}, {points:?}: {}",
            stderr(&output)
        );
        assert!(stdout(&output).is_empty(), "{node}, {points:?}");
    }
}

#[test]
fn nodes_lists_and_describes_kinds() {
    let place = Place::new(BOARD);
    let list = stdout(&place.call(&["nodes"]));
    let names: Vec<&str> = list
        .lines()
        .map(|line| line.split(' ').next().unwrap())
        .collect();
    let kinds: Vec<&str> = yosegi::nodes::KINDS.iter().map(|kind| kind.name).collect();
    let (native, compounds) = names.split_at(kinds.len());
    assert_eq!(native, kinds);
    assert_eq!(
        compounds,
        [
            "",
            "Compounds",
            "figured_wood",
            "joint_grass",
            "joint_sand",
            "marble",
            "pavement",
            "slate",
            "streaked",
            "tree_wood",
            "wavy"
        ]
    );
    let growth = stdout(&place.call(&["nodes", "growth_field"]));
    for part in [
        "elongation: number in mm/year",
        "Inputs",
        "Outputs",
        "Source",
        "Example",
        "from 1 to 100000",
    ] {
        assert!(growth.contains(part), "no `{part}` in\n{growth}");
    }
    let compound = stdout(&place.call(&["nodes", "pavement"]));
    let example = "Example\n  \"example\": pavement(cells: \"cells\"),\n";
    assert!(compound.contains(example), "{compound}");
    for kind in kinds {
        assert_eq!(code(&place.call(&["nodes", kind])), 0, "{kind}");
    }
    let wrong = place.call(&["nodes", "growth_fild"]);
    assert_eq!(code(&wrong), 2);
    assert_eq!(
        stderr(&wrong),
        "error: there is no kind `growth_fild`; did you mean `growth_field` or `growth_model`?\n"
    );
    let part = stderr(&place.call(&["nodes", "patern"]));
    for name in ["colour_pattern", "sample_pattern", "pattern_lookup"] {
        assert!(part.contains(&format!("`{name}`")), "{part}");
    }
    let far = stderr(&place.call(&["nodes", "qqqqqqqq", "--json"]));
    assert!(far.contains("`yosegi nodes` lists all kinds"), "{far}");
}

#[test]
fn check_builds_nodes_and_says_where_a_file_is_missing() {
    let place = Place::new(&edit(
        r##"colour_pattern(stops: [(at: 0, colour: "#e8c99b"), (at: 1, colour: "#9a6438")])"##,
        r#"sample_pattern(file: "none.png", spans: bar, rings: 4)"#,
    ));
    let check = || place.call(&["check", "recipe.ron", "--cache", "store"]);
    let missing = check();
    assert_eq!(code(&missing), 3);
    assert!(
        stderr(&missing).contains("none.png") && stderr(&missing).contains("recipe.ron:6"),
        "{}",
        stderr(&missing)
    );
    place.write("none.png", "no picture");
    let damaged = check();
    assert_eq!(code(&damaged), 1);
    assert!(
        stderr(&damaged).contains("recipe.ron:6"),
        "{}",
        stderr(&damaged)
    );
    let place = Place::new(BOARD);
    let large = ["check", "recipe.ron", "--max-pixels", "2999", "--no-cache"];
    assert_eq!(code(&place.call(&large)), 4);
    assert_eq!(
        code(&place.call(&[&large[..], &["--size", "8x8"]].concat())),
        0
    );
    assert_eq!(place.names("."), ["recipe.ron"]);
}
