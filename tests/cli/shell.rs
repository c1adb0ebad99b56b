//! Completions, manual pages, and streams that cannot be written.

use super::*;

const COMMANDS: [&str; 9] = [
    "render",
    "check",
    "why",
    "sample",
    "watch",
    "nodes",
    "cache",
    "completions",
    "man",
];

#[test]
fn every_shell_gets_a_script_with_all_commands_and_options() {
    let place = Place::new(BOARD);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = place.call(&["completions", shell]);
        assert_eq!((code(&output), stderr(&output)), (0, String::new()));
        let script = stdout(&output);
        for command in COMMANDS {
            assert!(script.contains(command), "{shell}: no `{command}`");
        }
        for option in ["max-pixels", "no-cache", "threads", "json"] {
            assert!(script.contains(option), "{shell}: no `{option}`");
        }
    }
    assert!(stdout(&place.call(&["completions", "zsh"])).contains("avx512"));
    assert_eq!(code(&place.call(&["completions", "tcsh"])), 2);
}

#[cfg(unix)]
#[test]
fn the_script_for_bash_is_one() {
    let place = Place::new(BOARD);
    place.write("script", &stdout(&place.call(&["completions", "bash"])));
    let Ok(checked) = std::process::Command::new("bash")
        .args(["-c", ". ./script && COMP_WORDS=(yosegi ch) && COMP_CWORD=1 && _yosegi yosegi ch yosegi && echo ${COMPREPLY[@]}"])
        .current_dir(place.folder.path())
        .output()
    else {
        // There is no bash here.
        return;
    };
    assert_eq!(stdout(&checked), "check\n", "{}", stderr(&checked));
}

#[test]
fn every_command_has_a_manual_page() {
    let place = Place::new(BOARD);
    let program = stdout(&place.call(&["man"]));
    assert!(
        program.contains(".TH yosegi 1") && program.contains("Exit codes"),
        "{program}"
    );
    for command in COMMANDS {
        let named = format!("yosegi\\-{command}");
        assert!(program.contains(&named), "no `{named}` in\n{program}");
        let page = stdout(&place.call(&["man", command]));
        let title = format!(".TH yosegi-{command} 1");
        assert!(
            page.contains(&title) && page.contains(".SH SYNOPSIS"),
            "{page}"
        );
    }
    let render = stdout(&place.call(&["man", "render"]));
    for option in ["max\\-pixels", "tile", "seed", "only"] {
        assert!(
            render.contains(&format!("\\-\\-{option}")),
            "no `{option}` in\n{render}"
        );
    }
    assert!(stdout(&place.call(&["man", "cache", "clean"])).contains("yosegi\\-cache\\-clean"));
    let wrong = place.call(&["man", "rendr"]);
    assert_eq!(code(&wrong), 2);
    assert!(stderr(&wrong).contains("did you mean `render`?"));
}

#[test]
fn nothing_is_hidden_from_the_help() {
    let help = stdout(&Place::new(BOARD).call(&["--help"]));
    for command in COMMANDS {
        assert!(
            help.contains(&format!("\n  {command} ")),
            "no `{command}` in\n{help}"
        );
    }
}

/// Calls that print something.
const PRINTING: [&[&str]; 8] = [
    &["render", "recipe.ron", "--no-cache"],
    &["render", "recipe.ron", "--no-cache", "--json"],
    &["check", "recipe.ron", "--no-cache"],
    &["why", "recipe.ron", "time", "--no-cache"],
    &["nodes", "--json"],
    &["completions", "bash"],
    &["man"],
    &[
        "sample",
        "recipe.ron",
        "--node",
        "time",
        "--points",
        "points.csv",
    ],
];

fn full() -> Option<fs::File> {
    fs::OpenOptions::new().write(true).open("/dev/full").ok()
}

#[test]
fn a_full_disk_behind_stdout_is_3_and_does_not_stop_a_render() {
    let place = Place::new(BOARD);
    place.write("points.csv", "x,y,z\n1,2,3\n");
    for arguments in PRINTING {
        let Some(full) = full() else {
            // Only some systems have such a device.
            return;
        };
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_yosegi"));
        command.current_dir(place.folder.path()).args(arguments);
        let output = command.stdout(full).output().unwrap();
        assert_eq!(code(&output), 3, "{arguments:?}: {}", stderr(&output));
        let told = stderr(&output);
        assert!(told.starts_with("error: cannot write the result"), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
    assert_eq!(place.names("out").len(), 3);
}

#[test]
fn a_full_disk_behind_stderr_changes_no_exit_code() {
    let place = Place::new(BOARD);
    // Clamped samples, so that there is something to warn of; a kind that is not there; a wrong call.
    place.write(
        "clamped.ron",
        r##"(
        nodes: {
            "wood": material(base_color: "#c8a06e", height: 3),
            "board": slice_cut(of: "wood", cut: end_grain, origin: (0, 0, 0), size: (4, 3)),
        },
        outputs: { "flat": maps(
            of: "board", pixels_per_mm: 1, channels: [height],
            ranges: [(channel: "height", low: 0, high: 1)],
        ) },
    )"##,
    );
    for (arguments, expected) in [
        (&["render", "clamped.ron", "--no-cache"][..], 0),
        (&["nodes", "mixx"], 2),
        (&["check", "none.ron"], 3),
        (&["paint"], 2),
    ] {
        let Some(full) = full() else { return };
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_yosegi"));
        command.current_dir(place.folder.path()).args(arguments);
        let status = command.stdout(Stdio::null()).stderr(full).status().unwrap();
        assert_eq!(status.code(), Some(expected), "{arguments:?}");
    }
}

#[test]
fn a_reader_that_has_gone_does_not_stop_the_recipes_that_follow() {
    let place = Place::new(BOARD);
    place.write("second.ron", BOARD);
    let mut child = start(
        &place,
        &["render", "recipe.ron", "second.ron", "--no-cache"],
    );
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((code(&output), stderr(&output)), (0, String::new()));
    assert_eq!(place.names("out/second").len(), 3);
}
