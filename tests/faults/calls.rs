//! Every operation of the world fails once: the table of outcomes.

use super::place::{End, Outcome, STATES, State};
use super::world::{Act, Faulty};
use super::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use yosegi::world::World;

/// What is promised of a run in which one operation fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Promise {
    /// The maps are right, as if nothing had happened.
    Silent,
    /// The maps are right, and it is said that the store failed.
    Warned,
    /// Exit code 3, with the path and the reason of the system.
    Files,
    /// The maps are right; that the store cannot remember them is said.
    SilentOrWarned,
    /// Silent where the answer does not matter, otherwise exit code 3 with the reason.
    SilentOrFiles,
}

/// Where a file lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Where {
    Input,
    Store,
    Output,
}

fn place_of(place: &Place, path: &Path) -> Where {
    if path.starts_with(place.path("store")) {
        Where::Store
    } else if path.starts_with(place.path("out")) {
        Where::Output
    } else {
        Where::Input
    }
}

/// The table of outcomes.
fn promise(act: Act, place: Where, state: State, error: Errno) -> Promise {
    use Act::{
        Commit, Create, List, Open, Read, ReadStart, RealPath, Remove, Seek, Stream, Sync, Touch,
        Write,
    };
    match (act, place) {
        // Interrupted streams are read and written again.
        (Write | Stream, _) if error == INTERRUPTED => Promise::Silent,
        // What cannot be read is missing in the store, and is painted anew in the output folder.
        (Read | Open | Stream, Where::Store) => Promise::Silent,
        (ReadStart | RealPath | List | Remove | Touch, Where::Store | Where::Output) => {
            Promise::Silent
        }
        (Read | Open | Stream | ReadStart, Where::Input) => Promise::Files,
        // Folders whose place tells whether a file lies outside of them.
        (RealPath, Where::Input) => Promise::SilentOrFiles,
        (Create | Write | Seek | Sync | Commit, Where::Store) => Promise::Warned,
        // A map that cannot be copied from the store is painted.
        (Create | Write | Seek | Sync | Commit, Where::Output) if state == State::Warm => {
            Promise::Silent
        }
        (Create | Write | Seek | Sync | Commit, Where::Output) => Promise::Files,
        // A map is read to see whether it is the right one, and to remember it.
        (Open | Stream, Where::Output) => Promise::SilentOrWarned,
        other => panic!("{other:?} is in no table"),
    }
}

/// Fails operation number `number`; gives what it was, or `None` if there are fewer.
fn fail(place: &Place, number: usize, error: Errno) -> Option<(Act, Where, Promise)> {
    place.reset();
    let world = Faulty::new(number, error);
    let shared: Arc<dyn World> = Arc::new(world.clone());
    let outcome = place.render(&shared, "store");
    let (act, path) = world.steps().get(number)?.clone();
    let (case, state) = (place.case.name, place.state);
    let context = format!(
        "{case}, {state:?}: {error:?} at {number}, {act:?} {}",
        path.display()
    );
    let lies = place_of(place, &path);
    let promised = promise(act, lies, state, error);
    keep(promised, &outcome, &path, error, &context);
    place.judge(outcome.end == End::Done, &context);
    assert_eq!(place.unfinished(), [] as [PathBuf; 0], "{context}");
    place.recover(&context);
    Some((act, lies, promised))
}

fn keep(promised: Promise, outcome: &Outcome, path: &Path, error: Errno, context: &str) {
    let found = match &outcome.end {
        End::Done if outcome.has_store_failed => Promise::Warned,
        End::Done => Promise::Silent,
        End::NotLoaded(1) | End::Files => Promise::Files,
        other => panic!("{context}: {other:?}: {}", outcome.said),
    };
    let is_kept = match promised {
        Promise::SilentOrWarned => found != Promise::Files,
        Promise::SilentOrFiles => found != Promise::Warned,
        _ => found == promised,
    };
    assert!(
        is_kept,
        "{context}: {found:?}, not {promised:?}: {}",
        outcome.said
    );
    if found == Promise::Files {
        let name = path.file_name().unwrap().to_str().unwrap();
        let names = promised == Promise::SilentOrFiles || outcome.said.contains(name);
        let says = names && outcome.said.contains(&error.reason());
        assert!(says, "{context}: {}", outcome.said);
    }
}

/// Fails every operation with the errors that `errors` gives for its number; says how often what failed.
fn sweep(errors: impl Fn(usize) -> Vec<Errno>) -> BTreeMap<(Act, Where, Promise), usize> {
    let mut tally = BTreeMap::new();
    for (case, state) in CASES
        .iter()
        .flat_map(|case| STATES.map(|state| (*case, state)))
    {
        let place = Place::new(case, state);
        let mut number = 0;
        'numbers: loop {
            for error in errors(number) {
                let Some(failed) = fail(&place, number, error) else {
                    break 'numbers;
                };
                *tally.entry(failed).or_insert(0) += 1;
            }
            number += 1;
        }
        assert!(number > 5, "{}, {state:?}: {number}", case.name);
    }
    tally
}

#[test]
fn every_operation_that_fails_ends_as_promised() {
    let tally = sweep(|number| vec![ERRORS[number % ERRORS.len()]]);
    let acts = |promise| tally.keys().filter(move |(_, _, it)| *it == promise);
    assert!(acts(Promise::Files).count() > 5 && acts(Promise::Warned).count() > 2);
}

#[test]
#[ignore = "a campaign"]
fn every_operation_fails_with_every_error() {
    let tally = sweep(|_| ERRORS.to_vec());
    for ((act, lies, promise), count) in &tally {
        println!("{act:?} of {lies:?}: {promise:?}, {count} times");
    }
    let faults: usize = tally.values().sum();
    println!("faults injected through the world: {faults}, 0 broken promises");
}
