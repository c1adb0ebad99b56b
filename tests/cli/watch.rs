//! `watch` as a person sees it, and as a program does.

use super::signals::{end, send, wait_until};
use super::*;
use serde_json::Value as Json;
use std::io::{BufRead, BufReader, Lines};
use std::process::{Child, ChildStdout, Command as Process};

/// A watch of the recipe, and its lines.
fn watch(place: &Place, options: &[&str]) -> (Child, Lines<BufReader<ChildStdout>>) {
    let mut child = Process::new(env!("CARGO_BIN_EXE_yosegi"))
        .args(["watch", "recipe.ron", "--cache", "store"])
        .args(options)
        .current_dir(place.folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    (child, lines)
}

/// The next line that holds a text.
fn line_with(lines: &mut Lines<BufReader<ChildStdout>>, text: &str) -> String {
    lines
        .map(Result::unwrap)
        .find(|line| line.contains(text))
        .unwrap()
}

#[test]
fn each_save_has_a_line_with_what_ran_and_what_was_written() {
    let place = Place::new(BOARD);
    let (child, mut lines) = watch(&place, &[]);
    let first = line_with(&mut lines, " ms");
    assert!(first.starts_with("recipe.ron: "), "{first}");
    assert!(
        first.contains("wrote out/") && first.contains("ran board look plank"),
        "{first}"
    );
    place.write("recipe.ron", &BOARD.replace("#e8c99b", "#ffffff"));
    let second = line_with(&mut lines, " ms");
    assert!(
        second.contains("ran look year") && second.contains("reused"),
        "{second}"
    );
    place.write(
        "recipe.ron",
        &format!("{}// nothing", BOARD.replace("#e8c99b", "#ffffff")),
    );
    let third = line_with(&mut lines, " ms");
    assert!(third.ends_with("nothing changed"), "{third}");
    place.write("recipe.ron", &BOARD.replace("slice_cut", "slicecut"));
    let waiting = line_with(&mut lines, "waiting");
    assert_eq!(
        waiting,
        "recipe.ron: waiting for a change of recipe.ron ../nodes/slicecut.ron nodes/slicecut.ron"
    );
    send("TERM", &child);
    assert_eq!(end(child), 143);
}

#[test]
fn every_line_of_json_names_the_recipe() {
    let place = Place::new(BOARD);
    let (child, mut lines) = watch(&place, &["--json", "--preview"]);
    let mut heard = vec![];
    while heard.last().is_none_or(|event| event != "rendered") {
        let line = lines.next().unwrap().unwrap();
        let event: Json = serde_json::from_str(&line).unwrap();
        assert_eq!(event["recipe"], "recipe.ron", "{line}");
        heard.push(event["event"].as_str().unwrap_or_default().to_owned());
    }
    assert!(heard.contains(&"previewed".to_owned()), "{heard:?}");
    place.write("recipe.ron", "(");
    let failed = line_with(&mut lines, "\"severity\"");
    assert!(failed.contains("\"recipe\":\"recipe.ron\""), "{failed}");
    line_with(&mut lines, "\"failed\"");
    line_with(&mut lines, "\"waiting\"");
    send("INT", &child);
    assert_eq!(end(child), 130);
}

#[test]
fn it_ends_when_nobody_reads_it_any_more() {
    let place = Place::new(BOARD);
    let (mut child, mut lines) = watch(&place, &[]);
    line_with(&mut lines, " ms");
    drop(lines);
    place.write("recipe.ron", &BOARD.replace("#e8c99b", "#ffffff"));
    wait_until("the end", || child.try_wait().unwrap().is_some());
    assert_eq!(end(child), 0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_unicode_does_not_end_it() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let place = Place::new(BOARD);
    let name = OsStr::from_bytes(b"r\xff.ron");
    fs::write(place.folder.path().join(name), BOARD).unwrap();
    let mut child = Process::new(env!("CARGO_BIN_EXE_yosegi"))
        .arg("watch")
        .arg(name)
        .args(["--json", "--no-cache"])
        .current_dir(place.folder.path())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    line_with(&mut lines, "\"rendered\"");
    send("INT", &child);
    assert_eq!(end(child), 130);
}
