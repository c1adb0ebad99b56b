//! Places for maps that are no good, and what becomes of modes and links.
#![cfg(unix)]

use super::*;
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
use std::os::unix::process::CommandExt;
use std::process::Command as Process;

const MAP: &str = "board_base_color.png";

fn rendered(recipe: &str) -> Place {
    let place = Place::new(recipe);
    assert_eq!(code(&place.render(&[])), 0);
    place
}

/// Renders into `out`, which must fail with exit code 3 and say why of the path.
fn refused(place: &Place, path: &str, reason: &str) {
    let output = place.render(&["--set", "speed=4"]);
    let said = stderr(&output);
    assert_eq!(code(&output), 3, "{said}");
    assert!(said.contains(path) && said.contains(reason), "{said}");
    assert!(
        !place
            .names("out")
            .iter()
            .any(|name| name.ends_with(".part"))
    );
}

#[test]
fn what_is_no_file_is_not_replaced() {
    let place = Place::new(BOARD);
    let map = place.path(&format!("out/{MAP}"));
    fs::create_dir_all(&map).unwrap();
    refused(&place, MAP, "not a regular file");
    fs::remove_dir(&map).unwrap();
    symlink("/dev/full", &map).unwrap();
    refused(&place, MAP, "not a regular file");
    fs::remove_file(&map).unwrap();
    let made = Process::new("mkfifo").arg(&map).status().unwrap();
    assert!(made.success());
    refused(&place, MAP, "not a regular file");
    assert!(fs::metadata(&map).unwrap().file_type().is_fifo());
    // Behind a link that leads into a folder that is a file.
    fs::remove_file(&map).unwrap();
    symlink("../recipe.ron/map.png", &map).unwrap();
    refused(&place, MAP, "Not a directory");
}

#[test]
fn a_missing_folder_is_made_and_a_file_is_no_folder() {
    let place = Place::new(BOARD);
    assert_eq!(code(&place.render(&["-o", "far/away/out"])), 0);
    assert_eq!(place.names("far/away/out").len(), 3);
    let output = place.render(&["-o", "recipe.ron/out"]);
    assert_eq!(code(&output), 3);
    assert!(stderr(&output).contains("Not a directory"));
}

#[test]
fn a_map_that_is_protected_stays() {
    let place = rendered(BOARD);
    let map = place.path(&format!("out/{MAP}"));
    let old = fs::read(&map).unwrap();
    fs::set_permissions(&map, fs::Permissions::from_mode(0o444)).unwrap();
    refused(&place, MAP, "read-only");
    assert_eq!(fs::read(&map).unwrap(), old);
}

#[test]
fn a_folder_without_permission_is_an_error_and_the_old_map_stays() {
    const NOBODY: u32 = 65534;
    let place = rendered(BOARD);
    let old = place.files("out");
    let folder = |mode| fs::set_permissions(place.path("out"), fs::Permissions::from_mode(mode));
    let everyone = fs::Permissions::from_mode(0o755);
    fs::set_permissions(place.folder.path(), everyone).unwrap();
    folder(0o555).unwrap();
    let is_root = fs::metadata("/proc/self").is_ok_and(|process| process.uid() == 0);
    let mut process = Process::new(env!("CARGO_BIN_EXE_yosegi"));
    process.current_dir(place.folder.path());
    process.args(["render", "recipe.ron", "--no-cache", "--set", "speed=4"]);
    if is_root {
        // Nothing is forbidden to the superuser.
        process.uid(NOBODY);
    }
    let Ok(output) = process.output() else {
        // The program lies where others may not look.
        return;
    };
    folder(0o755).unwrap();
    assert_eq!(code(&output), 3, "{}", stderr(&output));
    assert!(stderr(&output).contains("ermission denied"));
    assert!(
        stderr(&output).contains("out/board_"),
        "{}",
        stderr(&output)
    );
    assert!(place.files("out") == old);
}

/// Three outputs; the third cannot be written.
#[test]
fn outputs_before_the_one_that_fails_are_whole_and_told() {
    let recipe = edit(
        "\"plain\": maps",
        "\"rough\": maps(of: \"plank\", pixels: (30, 25), channels: [roughness]), \"plain\": maps",
    );
    let right = rendered(&recipe);
    let place = Place::new(&recipe);
    fs::create_dir_all(place.path("out/plain_roughness.png")).unwrap();
    let output = place.render(&[]);
    assert_eq!(code(&output), 3);
    let said = stderr(&output);
    assert!(said.contains("plain_roughness.png"), "{said}");
    assert!(!said.contains("rough_roughness.png"), "{said}");
    let whole = ["board_base_color", "board_normal", "rough_roughness"];
    let paths = whole.map(|name| format!("out/{name}.png"));
    assert_eq!(stdout(&output), paths.join("\n") + "\n");
    for path in &paths {
        assert!(fs::read(place.path(path)).unwrap() == fs::read(right.path(path)).unwrap());
    }
    fs::remove_dir(place.path("out/plain_roughness.png")).unwrap();
    let events = lines(&place.render(&["--json"]));
    let count = |name: &str| events.iter().filter(|it| it["event"] == name).count();
    // The third is the same map as the second.
    assert_eq!([count("map_up_to_date"), count("map_restored")], [3, 1]);
    assert!(place.files("out") == right.files("out"));
}

#[test]
fn modes_are_kept_and_new_files_follow_the_umask() {
    let place = Place::new(BOARD);
    let mode = |name: &str| {
        let file = fs::metadata(place.path(&format!("out/{name}"))).unwrap();
        file.permissions().mode() & 0o7777
    };
    let program = env!("CARGO_BIN_EXE_yosegi");
    let script = format!("umask 027; '{program}' render recipe.ron --no-cache");
    let mut shell = Process::new("sh");
    shell.args(["-c", &script]).current_dir(place.folder.path());
    assert!(shell.output().unwrap().status.success());
    assert_eq!(mode(MAP), 0o640);
    let map = place.path(&format!("out/{MAP}"));
    fs::set_permissions(&map, fs::Permissions::from_mode(0o606)).unwrap();
    assert_eq!(code(&place.render(&["--set", "speed=4"])), 0);
    assert_eq!([mode(MAP), mode("board_normal.png")], [0o606, 0o640]);
}

#[test]
fn a_link_stays_a_link_and_a_second_name_keeps_the_old_map() {
    let place = rendered(BOARD);
    let [map, second] = [MAP, "second.png"].map(|name| place.path(&format!("out/{name}")));
    let old = fs::read(&map).unwrap();
    fs::hard_link(&map, &second).unwrap();
    assert_eq!(code(&place.render(&["--set", "speed=4"])), 0);
    let new = fs::read(&map).unwrap();
    assert!(new != old && fs::read(&second).unwrap() == old);
    // A link to another folder, on another device if there is one.
    let shared = Path::new("/dev/shm");
    let elsewhere = match shared.is_dir() {
        true => tempfile::tempdir_in(shared),
        false => tempfile::tempdir(),
    }
    .unwrap();
    let target = elsewhere.path().join("map.png");
    fs::remove_file(&map).unwrap();
    symlink(&target, &map).unwrap();
    for (speed, expected) in [("speed=4", &new), ("speed=3", &old), ("speed=4", &new)] {
        // What another program that was killed has left there.
        fs::write(elsewhere.path().join(".yosegi-left.part"), "half").unwrap();
        assert_eq!(code(&place.render(&["--set", speed])), 0);
        assert!(map.is_symlink() && fs::read(&target).unwrap() == *expected);
        assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 1);
    }
}

#[test]
fn what_killed_programs_left_is_gone_after_the_next_start() {
    let place = rendered(BOARD);
    let leave = || {
        for folder in ["out", "store/unfinished"] {
            fs::write(place.path(&format!("{folder}/.yosegi-left.part")), "half").unwrap();
        }
    };
    leave();
    // Even a run that writes nothing.
    assert_eq!(code(&place.render(&[])), 0);
    assert_eq!(place.names("out").len(), 3);
    assert!(place.names("store/unfinished").is_empty());
    leave();
    assert_eq!(
        code(&place.call(&["cache", "clean", "--cache", "store"])),
        0
    );
    assert!(!place.path("store").exists());
}
