//! Exit codes.

use super::*;

#[test]
fn a_failing_node_is_1() {
    let place = Place::new(&edit(
        "cut: quarter_sawn",
        "across: (1, 0, 0), along: (1, 0, 0)",
    ));
    let output = place.render(&[]);
    assert_eq!(code(&output), 1);
    assert!(
        stderr(&output).contains("span no plane") && stderr(&output).contains("recipe.ron:9"),
        "{}",
        stderr(&output)
    );
    assert!(stdout(&output).is_empty() && place.names("out").is_empty());
    let json = lines(&place.render(&["--json"]));
    assert_eq!(
        (
            json.last().unwrap()["code"].as_str(),
            json.last().unwrap()["node"].as_str()
        ),
        (Some("node-failed"), Some("plank"))
    );
}

#[test]
fn a_wrong_recipe_or_call_is_2() {
    let place = Place::new(&edit("growth_field", "growth_fild"));
    let output = place.render(&[]);
    assert_eq!(code(&output), 2);
    assert!(
        stderr(&output).contains("growth_field"),
        "{}",
        stderr(&output)
    );
    let place = Place::new(BOARD);
    for arguments in [
        &["--only", "bord"][..],
        &["--set", "speed=fast"],
        &["--set", "speed=99"],
        &["--set", "sped=4"],
        &["--set", "speed"],
        &["--size", "0x4"],
        &["--size", "12"],
        &["--tile", "0"],
        &["--threads", "0"],
        &["--simd", "mmx"],
        &["--no-cache"],
    ] {
        let output = place.render(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", stderr(&output));
        assert!(
            !stderr(&output).is_empty() && stdout(&output).is_empty(),
            "{arguments:?}"
        );
    }
    assert!(place.names("out").is_empty());
    assert!(stderr(&place.render(&["--only", "bord"])).contains("`board`"));
}

#[test]
fn files_that_cannot_be_read_or_written_are_3() {
    let place = Place::new(BOARD);
    let missing = place.call(&["render", "no.ron", "--cache", "store"]);
    assert_eq!(code(&missing), 3);
    assert!(stderr(&missing).contains("no.ron"), "{}", stderr(&missing));
    // A folder cannot lie inside a file.
    let unwritable = place.render(&["-o", "recipe.ron/out"]);
    assert_eq!(code(&unwritable), 3, "{}", stderr(&unwritable));
    let unread = Place::new(&edit(
        r#"skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)])"#,
        r#"skeleton_from_file(pith: "none.json")"#,
    ));
    let output = unread.render(&[]);
    assert_eq!(code(&output), 3);
    assert!(stderr(&output).contains("none.json"), "{}", stderr(&output));
    let points = place.call(&[
        "sample",
        "recipe.ron",
        "--node",
        "time",
        "--points",
        "none.csv",
    ]);
    assert_eq!(code(&points), 3);
}

#[test]
fn too_many_pixels_are_4() {
    let place = Place::new(BOARD);
    let output = place.render(&["--max-pixels", "2999"]);
    assert_eq!(code(&output), 4);
    assert!(
        stderr(&output).contains("--max-pixels 3000"),
        "{}",
        stderr(&output)
    );
    assert_eq!(code(&place.render(&["--max-pixels", "3000"])), 0);
}

#[test]
fn a_call_without_a_command_is_2_and_help_is_0() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.call(&[])), 2);
    assert_eq!(code(&place.call(&["paint"])), 2);
    let help = place.call(&["--help"]);
    assert!(code(&help) == 0 && stdout(&help).contains("Exit codes"));
    for exit in [
        "0 done", "1 a ", "2 the", "3 a ", "4 a ", "129 the", "130 int", "143 ter",
    ] {
        let text = stdout(&help).replace(['\n', '\r'], " ");
        let text: Vec<&str> = text.split_whitespace().collect();
        assert!(text.join(" ").contains(exit), "{exit}");
    }
    assert_eq!(
        stdout(&place.call(&["--version"])),
        format!("yosegi {}\n", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn a_reader_that_closes_the_pipe_is_no_failure() {
    let place = Place::new(BOARD);
    // More than any pipe holds.
    let points: String = (0..20_000).map(|x| format!("{x},1,2\n")).collect();
    place.write("points.csv", &format!("x,y,z\n{points}"));
    for arguments in [
        &[
            "sample",
            "recipe.ron",
            "--node",
            "time",
            "--points",
            "points.csv",
        ][..],
        &["nodes", "--json"],
        &["render", "recipe.ron", "--no-cache", "--json"],
    ] {
        let mut child = start(&place, arguments);
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(
            (code(&output), stderr(&output)),
            (0, String::new()),
            "{arguments:?}"
        );
    }
}

#[test]
fn recipes_that_would_share_a_folder_are_refused_before_anything_runs() {
    let place = Place::new(BOARD);
    for folder in ["p", "q"] {
        fs::create_dir(place.path(folder)).unwrap();
        place.write(&format!("{folder}/board.ron"), BOARD);
    }
    for command in ["render", "watch"] {
        for recipes in [
            ["p/board.ron", "recipe.ron", "q/board.ron"],
            ["recipe.ron", "p/board.ron", "p/board.ron"],
        ] {
            let output = place.call(&[&[command], &recipes[..]].concat());
            assert_eq!(code(&output), 2, "{command} {recipes:?}");
            let shared = Path::new("out").join("board");
            let said = format!(
                "the maps of `p/board.ron` and of `{}` would both go to `{}`",
                recipes[2],
                shared.display()
            );
            assert!(stderr(&output).contains(&said), "{}", stderr(&output));
            assert!(stdout(&output).is_empty() && place.names("out").is_empty());
        }
    }
    let apart = ["render", "p/board.ron", "recipe.ron", "--no-cache"];
    assert_eq!(code(&place.call(&apart)), 0);
    assert_eq!(place.names("out"), ["board", "recipe"]);
}
