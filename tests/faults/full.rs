//! A real file system that is full after so many pages.

use super::place::State;
use super::*;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The sizes of the file system, in KiB.
const PAGE: usize = 4;
const LARGEST: usize = 1000;

/// In a name space of its own, so that nobody else sees the file system: puts the old maps into a small one,
/// renders there, and puts what it holds then into the place.
const SCRIPT: &str = r#"
home=$1 size=$2 program=$3
mount -t tmpfs -o "size=${size}k" none "$home/mount" || exit 100
cp -r "$home/template/out" "$home/mount/out" || exit 101
"$program" render "$home/work/recipe.ron" -o "$home/mount/out" --cache "$home/mount/store" --threads 1 >/dev/null
code=$?
rm -rf "$home/work/out" "$home/work/store"
cp -r "$home/mount/." "$home/work"
exit $code
"#;

fn render(place: &Place, size: usize) -> (i32, String) {
    let mut shell = Command::new("unshare");
    shell.args(["--mount", "sh", "-c", SCRIPT, "sh"]);
    shell.arg(place.home()).arg(size.to_string());
    shell.arg(env!("CARGO_BIN_EXE_yosegi"));
    let output = shell.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), said)
}

fn can_mount() -> bool {
    let mut mount = Command::new("unshare");
    mount.args(["--mount", "mount", "-t", "tmpfs", "none", "/mnt"]);
    let can = mount.stderr(Stdio::null()).status();
    let can = can.is_ok_and(|status| status.success());
    if !can {
        println!("skipped: only the superuser can mount a file system");
    }
    can
}

/// How runs end from the smallest disk that holds the old maps to one that holds all.
fn fill(place: &Place) -> Vec<&'static str> {
    std::fs::create_dir(place.home().join("mount")).unwrap();
    let mut ends = vec![];
    for size in (PAGE..LARGEST).step_by(PAGE) {
        place.reset();
        let (code, said) = render(place, size);
        let context = format!("{}, {size} KiB: {said}", place.case.name);
        let end = match code {
            101 => continue,
            3 => {
                assert!(said.contains("mount/out/"), "{context}");
                assert!(said.contains(&FULL.reason()), "{context}");
                "no map"
            }
            0 if said.is_empty() => "all",
            0 => {
                assert!(said.contains("the store of earlier results"), "{context}");
                assert_eq!(said.lines().count(), 1, "{context}");
                "no store"
            }
            other => panic!("{context}: exit code {other}"),
        };
        place.judge(code == 0, &context);
        assert_eq!(place.unfinished(), [] as [PathBuf; 0], "{context}");
        place.recover(&context);
        ends.push(end);
        if end == "all" {
            break;
        }
    }
    ends
}

#[test]
fn a_disk_that_is_full_after_any_page_keeps_the_old_maps() {
    if !can_mount() {
        return;
    }
    for case in CASES {
        let mut ends = fill(&Place::new(case, State::Cold));
        assert!(
            ends.is_sorted_by_key(|end| ["no map", "no store", "all"]
                .iter()
                .position(|it| it == end)),
            "{ends:?}"
        );
        ends.dedup();
        assert_eq!(ends, ["no map", "no store", "all"], "{}", case.name);
    }
}
