//! Every system call of the program fails once, by injection with `strace`.

use super::place::{STATES, State};
use super::*;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// Calls that fail, with a name of all that a system has for one purpose.
const CALLS: [&str; 9] = [
    "openat",
    "read",
    "write",
    "fsync,fdatasync",
    "rename,renameat,renameat2",
    "flock",
    "mkdir,mkdirat",
    "unlink,unlinkat",
    "getdents64",
];

/// One fault: which call, with which number in its thread, fails how.
struct Fault {
    call: &'static str,
    number: usize,
    error: Errno,
    /// Counts only calls that name files of the place; the dynamic linker opens and reads others before.
    only_ours: bool,
}

/// A run with a fault.
struct Traced {
    output: Output,
    /// The calls that failed.
    injected: Vec<String>,
}

fn has_strace() -> bool {
    let mut strace = Command::new("strace");
    strace.args(["-qq", "-e", "inject=fsync:error=EIO", "true"]);
    let is_there = strace
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|it| it.success());
    if !is_there {
        println!("skipped: this machine has no `strace`, or does not let it trace");
    }
    is_there
}

/// The files of a place that are known by name: what is read, what the store has, and the maps.
fn known_paths(place: &Place) -> Vec<PathBuf> {
    let mut paths = vec![];
    let mut pending = vec![place.work()];
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                pending.push(path);
            } else {
                paths.push(path);
            }
        }
        paths.push(folder);
    }
    paths
}

fn run(place: &Place, fault: &Fault) -> Traced {
    let log = place.work().with_file_name("calls.log");
    let mut strace = Command::new("strace");
    strace
        .args(["-f", "-y", "-e", "signal=none", "-o"])
        .arg(&log);
    let Fault {
        call,
        number,
        error,
        ..
    } = fault;
    strace.args(["-e", &format!("trace={call}")]);
    strace.args([
        "-e",
        &format!("inject={call}:error={}:when={number}", error.1),
    ]);
    if fault.only_ours {
        for path in known_paths(place) {
            strace.arg("-P").arg(path);
        }
    }
    strace.arg(env!("CARGO_BIN_EXE_yosegi")).arg("render");
    strace
        .arg(place.path("recipe.ron"))
        .arg("-o")
        .arg(place.path("out"));
    strace
        .arg("--cache")
        .arg(place.path("store"))
        .args(["--threads", "1"]);
    let output = strace.current_dir(place.work()).output().unwrap();
    let log = fs::read_to_string(log).unwrap();
    let injected = log.lines().filter(|line| line.contains("(INJECTED)"));
    Traced {
        injected: injected.map(str::to_owned).collect(),
        output,
    }
}

/// Injects a fault and holds the run to what is promised; `None` if there are fewer calls.
fn fail(place: &Place, fault: &Fault) -> Option<i32> {
    place.reset();
    let Traced { output, injected } = run(place, fault);
    if injected.is_empty() {
        assert_eq!(output.status.code(), Some(0));
        return None;
    }
    let (case, state) = (place.case.name, place.state);
    let context = format!("{case}, {state:?}: {}", injected.join("\n"));
    let said = String::from_utf8(output.stderr).unwrap();
    let code = output.status.code();
    match code {
        Some(0) => {}
        Some(3) if fault.error != INTERRUPTED => {
            let names = said.contains(place.work().to_str().unwrap())
                || said.contains("cannot read `")
                || said.contains("cannot write the result");
            assert!(
                names && said.contains(&fault.error.reason()),
                "{context}: {said}"
            );
        }
        // The program has not begun.
        Some(127) if said.contains("error while loading shared libraries") => {}
        other => panic!("{context}: exit code {other:?}: {said}"),
    }
    place.judge(code == Some(0), &context);
    // What could not be removed is swept by the next run.
    if !fault.call.starts_with("unlink") {
        assert_eq!(place.unfinished(), [] as [PathBuf; 0], "{context}");
    }
    place.recover(&context);
    code
}

/// Injects the faults of the numbers that are `wanted`, as long as there are so many calls; counts exit codes.
fn sweep(states: &[State], numbers: &[usize], errors: impl Fn(usize) -> Vec<Errno>) -> Tally {
    let mut tally = Tally::new();
    for (case, state) in CASES
        .iter()
        .flat_map(|case| states.iter().map(move |it| (*case, *it)))
    {
        let place = Place::new(case, state);
        for call in CALLS {
            // Calls that the dynamic linker makes as well are counted in both ways.
            let ways: &[bool] = if matches!(call, "openat" | "read") {
                &[true, false]
            } else {
                &[false]
            };
            for only_ours in ways {
                let number = |turn: usize| numbers.get(turn).copied();
                'turns: for turn in 0.. {
                    let Some(number) = number(turn) else { break };
                    for error in errors(turn) {
                        let fault = Fault {
                            call,
                            number,
                            error,
                            only_ours: *only_ours,
                        };
                        let Some(code) = fail(&place, &fault) else {
                            break 'turns;
                        };
                        *tally.entry((call, code)).or_insert(0) += 1;
                    }
                }
            }
        }
    }
    tally
}

type Tally = BTreeMap<(&'static str, i32), usize>;

#[test]
fn some_system_calls_that_fail_end_as_promised() {
    if has_strace() {
        let tally = sweep(&[State::Cold], &[1, 2, 6, 11, 23], |turn| {
            vec![ERRORS[turn % ERRORS.len()]]
        });
        let count = |code| {
            tally
                .iter()
                .filter(|((_, it), _)| *it == code)
                .map(|(_, count)| count)
                .sum()
        };
        let [done, files]: [usize; 2] = [0, 3].map(count);
        assert!(done > 20 && files > 10, "{tally:?}");
    }
}

#[test]
#[ignore = "a campaign"]
fn every_system_call_fails_with_every_error() {
    if has_strace() {
        let all: Vec<usize> = (1..10_000).collect();
        let tally = sweep(&STATES, &all, |_| ERRORS.to_vec());
        for ((call, code), count) in &tally {
            println!("{call}: exit code {code}, {count} times");
        }
        let faults: usize = tally.values().sum();
        println!("faults injected into system calls: {faults}, 0 broken promises");
    }
}
