//! Signals: the run stops, nothing is torn or left over, and the exit code says which it was.

use super::heard::heard;
use super::*;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command as Process};
use std::time::{Duration, Instant};

/// What a hang would exceed.
const LONG: Duration = Duration::from_secs(60);

/// Takes minutes.
const LARGE: [&str; 8] = [
    "render",
    "recipe.ron",
    "--only",
    "board",
    "--size",
    "12000x12000",
    "--threads",
    "2",
];

pub(super) fn send(signal: &str, child: &Child) {
    let status = Process::new("kill")
        .args([&format!("-{signal}"), &child.id().to_string()])
        .status();
    assert!(status.unwrap().success());
}

pub(super) fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < LONG, "waited for {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Whether a folder holds a file that is being written.
fn is_writing(place: &Place) -> bool {
    place
        .names("out")
        .iter()
        .any(|name| name.starts_with(".yosegi-"))
}

/// Waits for the end; gives the exit code.
pub(super) fn end(mut child: Child) -> i32 {
    let mut status = None;
    wait_until("the end", || {
        status = child.try_wait().unwrap();
        status.is_some()
    });
    status.unwrap().code().unwrap()
}

/// A place with maps in place, and what they are.
fn rendered() -> (Place, Vec<(String, Vec<u8>)>) {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&[])), 0);
    let maps = place.files("out");
    assert_eq!(maps.len(), 3);
    (place, maps)
}

fn start_large(place: &Place) -> Child {
    let child = start(place, &[&LARGE[..], &["--cache", "store"]].concat());
    wait_until("the first write", || is_writing(place));
    child
}

#[test]
fn a_signal_leaves_the_old_maps_and_nothing_else() {
    let (place, old) = rendered();
    for (signal, number) in heard() {
        let child = start_large(&place);
        send(signal, &child);
        assert_eq!(end(child), 128 + number, "{signal}");
        assert!(place.files("out") == old, "{signal}");
        assert!(place.names("store/unfinished").is_empty(), "{signal}");
    }
    assert_eq!(code(&place.render(&[])), 0);
    assert!(place.files("out") == old);
}

#[test]
fn a_watch_that_waits_ends_by_every_signal() {
    for (signal, number) in heard() {
        let place = Place::new(BOARD);
        let child = start(&place, &["watch", "recipe.ron", "--cache", "store"]);
        wait_until("the maps", || {
            place.names("out").len() == 3 && !is_writing(&place)
        });
        send(signal, &child);
        assert_eq!(end(child), 128 + number, "{signal}");
        assert_eq!(place.names("out").len(), 3, "{signal}");
        assert!(place.names("store/unfinished").is_empty(), "{signal}");
    }
}

#[test]
fn an_interrupt_is_the_last_event() {
    let place = Place::new(BOARD);
    let options = ["--no-cache", "--json", "--tile", "16"];
    let mut child = start(&place, &[&LARGE[..], &options].concat());
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.any(|line| line.unwrap().contains("\"progress\"")));
    let (signal, number) = heard()[0];
    send(signal, &child);
    let last = lines.map(Result::unwrap).last().unwrap();
    assert!(last.contains("\"cancelled\""), "{last}");
    assert_eq!(end(child), 128 + number);
    assert!(place.names("out").is_empty());
}

#[test]
fn a_second_signal_ends_at_once_and_tears_nothing() {
    let (place, old) = rendered();
    for (signal, number) in heard() {
        let child = start_large(&place);
        send(signal, &child);
        // It may have ended already.
        let _ = Process::new("kill")
            .args([&format!("-{signal}"), &child.id().to_string()])
            .stderr(Stdio::null())
            .status();
        assert_eq!(end(child), 128 + number, "{signal}");
        assert!(place.files("out") == old, "{signal}");
    }
}

/// The run stands still in a write to stdout, which no switch can stop.
#[cfg(target_os = "linux")]
#[test]
fn a_run_that_cannot_stop_is_ended_and_leaves_nothing() {
    let (place, old) = rendered();
    let (reader, mut writer) = std::io::pipe().unwrap();
    // All that a pipe holds but some bytes, for the events before the first write.
    writer.write_all(&[b'\n'; 16 * 4096 - 700]).unwrap();
    let mut process = Process::new(env!("CARGO_BIN_EXE_yosegi"));
    process.current_dir(place.folder.path()).args(LARGE);
    process.args(["--no-cache", "--json", "--tile", "8"]);
    let child = process.stdout(writer).spawn().unwrap();
    drop(process);
    wait_until("the first write", || is_writing(&place));
    // Ten events a second are more than is left.
    std::thread::sleep(Duration::from_millis(1500));
    let (signal, number) = heard()[0];
    let start = Instant::now();
    send(signal, &child);
    assert_eq!(end(child), 128 + number);
    assert!(
        start.elapsed() > Duration::from_millis(300),
        "it could stop"
    );
    assert!(place.files("out") == old);
    drop(reader);
}

#[test]
fn a_run_that_is_stopped_for_a_while_goes_on() {
    let place = Place::new(BOARD);
    let size = ["--size", "240x200"];
    assert_eq!(code(&place.render(&size)), 0);
    let whole = place.files("out");
    fs::remove_dir_all(place.path("out")).unwrap();
    let arguments = ["render", "recipe.ron", "--no-cache"];
    let child = start(&place, &[&arguments[..], &size].concat());
    send("STOP", &child);
    std::thread::sleep(Duration::from_millis(50));
    send("CONT", &child);
    assert_eq!(end(child), 0);
    assert!(place.files("out") == whole);
}

/// As `nohup` starts programs, and shells those in the background.
#[cfg(target_os = "linux")]
#[test]
fn signals_that_are_to_be_ignored_are() {
    let place = Place::new(BOARD);
    let script = "trap '' HUP INT; exec \"$0\" \"$@\"";
    let mut shell = Process::new("sh");
    shell.args(["-c", script, env!("CARGO_BIN_EXE_yosegi")]);
    shell.args(LARGE).arg("--no-cache");
    let child = shell.current_dir(place.folder.path()).spawn().unwrap();
    wait_until("the first write", || is_writing(&place));
    for signal in ["HUP", "INT", "HUP"] {
        send(signal, &child);
    }
    std::thread::sleep(Duration::from_millis(600));
    assert!(is_writing(&place));
    send("TERM", &child);
    assert_eq!(end(child), 143);
}

/// Runs a shell script in the folder, with `yosegi` as a function, and little in the environment.
fn shell(place: &Place, script: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_yosegi");
    let mut shell = Process::new("sh");
    shell.args([
        "-c",
        &format!("yosegi() {{ '{program}' \"$@\"; }}\n{script}"),
    ]);
    let path = std::env::var_os("PATH").unwrap_or_default();
    shell.current_dir(place.folder.path()).env_clear();
    shell.env("PATH", path).output().unwrap()
}

#[test]
fn odd_surroundings_change_no_map() {
    let (place, right) = rendered();
    for script in [
        "yosegi render recipe.ron <&-",
        "yosegi render recipe.ron >&-",
        "yosegi render recipe.ron 2>&-",
        "yosegi render recipe.ron <&- >&- 2>&-",
        "NO_COLOR=1 TERM=dumb yosegi render recipe.ron </dev/null",
        "LANG=C LC_ALL=C TZ=Nowhere/At_all yosegi render recipe.ron",
        "LANG=tr_TR.UTF-8 LC_ALL=tr_TR.UTF-8 TZ=:/dev/null yosegi render recipe.ron",
        "HOME= XDG_CACHE_HOME=relative yosegi render recipe.ron",
        "HOME=/dev/null yosegi render recipe.ron",
        "RUST_BACKTRACE=full COLUMNS=0 LINES=-1 yosegi render recipe.ron",
    ] {
        fs::remove_dir_all(place.path("out")).unwrap();
        let output = shell(&place, script);
        assert_eq!(code(&output), 0, "{script}: {}", stderr(&output));
        assert!(place.files("out") == right, "{script}");
    }
    assert!(!place.path("relative").exists());
}

#[test]
fn a_working_folder_that_is_gone_is_said_and_absolute_paths_do_without() {
    let (place, right) = rendered();
    fs::remove_dir_all(place.path("out")).unwrap();
    let output = shell(
        &place,
        "mkdir gone; cd gone; rmdir ../gone; yosegi render recipe.ron --no-cache",
    );
    assert_eq!(code(&output), 3);
    assert!(
        stderr(&output).contains("recipe.ron"),
        "{}",
        stderr(&output)
    );
    let output = shell(
        &place,
        "top=$PWD; mkdir gone; cd gone; rmdir ../gone
        yosegi render \"$top/recipe.ron\" -o \"$top/out\" --cache \"$top/store\"",
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(place.files("out") == right);
}
