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
    assert_eq!(names, kinds);
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
    for kind in kinds {
        assert_eq!(code(&place.call(&["nodes", kind])), 0, "{kind}");
    }
    let wrong = place.call(&["nodes", "growth_fild"]);
    assert_eq!(code(&wrong), 2);
    assert_eq!(
        stderr(&wrong),
        "error: there is no kind `growth_fild`; did you mean `growth_field`?\n"
    );
}

#[test]
fn nodes_gives_json() {
    let place = Place::new(BOARD);
    let all: Value = serde_json::from_str(&stdout(&place.call(&["nodes", "--json"]))).unwrap();
    let kinds = all.as_array().unwrap();
    assert_eq!(kinds.len(), yosegi::nodes::KINDS.len());
    let one: Value =
        serde_json::from_str(&stdout(&place.call(&["nodes", "slice_cut", "--json"]))).unwrap();
    assert!(kinds.contains(&one));
    let input = |name: &str| {
        one["inputs"]
            .as_array()
            .unwrap()
            .iter()
            .find(|input| input["name"] == name)
            .unwrap()
            .clone()
    };
    assert_eq!(
        (&input("cut")["default"], &input("of")["required"]),
        (&Value::from("plane"), &Value::from(true))
    );
    assert_eq!(one["outputs"][0]["domain"], "plane");
}
