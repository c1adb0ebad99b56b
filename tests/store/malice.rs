//! A store that someone else has filled, with entries that are whole by their checksums: nothing in them may
//! choose which files are written, stop the program, or speak to the terminal.

use super::*;
use std::io::{self, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use yosegi::engine::{Event, Render, RunError};
use yosegi::world::{Memory, PendingFile};

/// Puts another payload into the entry at a path, under a right checksum.
fn replace(workshop: &Workshop, path: &Path, payload: &[u8]) {
    workshop.files.insert(path, sealed(path, payload));
}

/// Renders and asks without a map in place; every file that is there afterwards, but for the store.
fn survive(workshop: &Workshop, recipe: &str) -> Vec<PathBuf> {
    for map in workshop.maps() {
        workshop.files.remove(&place(workshop, &map)).unwrap();
    }
    let engine = workshop.another(options());
    let quiet = |_: Event| {};
    let graph = engine.graph(recipe);
    let request = Render {
        graph: &graph,
        folder: engine.folder.join("out"),
        only: vec![],
        pixels: None,
        listener: &quiet,
        cancel: Cancel::new(),
    };
    engine.engine.why(&request, "board").unwrap();
    for result in [
        engine.engine.check(&request),
        engine.engine.render(&request).map(|_| ()),
    ] {
        // A structure that is sound in itself may still be too much for the nodes that read it.
        if let Err(error) = result {
            let text = format!("{error:?}");
            assert!(matches!(error, RunError::Nodes(_)), "{text}");
            assert!(!text.contains("fault in Yosegi"), "{text}");
        }
    }
    let files = workshop.files.paths().into_iter();
    files.filter(|path| !path.starts_with(STORE)).collect()
}

#[test]
fn random_payloads_under_right_checksums_do_no_harm() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let files = survive(&workshop, BOARD);
    let mut random = campaign::Random::new(7);
    for path in entries(&workshop) {
        let whole = workshop.files.read(&path).unwrap();
        for round in 0..60 {
            let mut wrong = payload(&whole);
            if round % 3 == 0 {
                let length = random.below(200);
                wrong = (0..length).map(|_| random.next() as u8).collect();
            } else {
                for _ in 0..=random.below(3) {
                    let at = random.below(wrong.len());
                    wrong[at] = random.next() as u8;
                }
            }
            replace(&workshop, &path, &wrong);
            let found = survive(&workshop, BOARD);
            assert!(found.iter().all(|path| files.contains(path)), "{found:?}");
            workshop.files.insert(&path, whole.clone());
        }
    }
}

#[test]
fn counts_in_a_payload_are_not_believed() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let files = survive(&workshop, BOARD);
    // The largest number that fits, at each place where a count may stand.
    let large = [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01];
    for path in entries(&workshop) {
        let whole = workshop.files.read(&path).unwrap();
        let payload = payload(&whole);
        for at in 0..payload.len().min(120) {
            for number in [&large[..], &large[5..], &[0x80, 0x80, 0x80, 0x08]] {
                let wrong = [&payload[..at], number, &payload[at + 1..]].concat();
                replace(&workshop, &path, &wrong);
                let found = survive(&workshop, BOARD);
                assert!(found.iter().all(|path| files.contains(path)), "{found:?}");
            }
        }
        workshop.files.insert(&path, whole);
    }
}

/// The record of an output as the store has it: channels, file names and keys of maps, and warnings.
type Record = (Vec<(String, String, Key)>, Vec<(Key, String)>);

#[test]
fn records_name_no_files_but_those_of_the_output() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let files = survive(&workshop, BOARD);
    let plan = entries_of(&workshop, "plan").remove(0);
    let whole = payload(&workshop.files.read(&plan).unwrap());
    let (maps, warnings): Record = postcard::from_bytes(&whole).unwrap();
    assert_eq!(maps[1].1, MAPS[1]);
    for name in [
        "../escaped.png",
        "../../escaped.png",
        "/escaped.png",
        "board_/../../escaped.png",
        "board_height.png/escaped.png",
        "board_height.sh",
        "other_height.png",
        "",
    ] {
        let mut wrong = maps.clone();
        name.clone_into(&mut wrong[1].1);
        replace(
            &workshop,
            &plan,
            &postcard::to_stdvec(&(&wrong, &warnings)).unwrap(),
        );
        assert_eq!(survive(&workshop, BOARD), files, "{name}");
        // The same through the channel's name.
        let mut wrong = maps.clone();
        wrong[1].0 = format!("/../{name}");
        wrong[1].1 = format!("board_{}.png", wrong[1].0);
        replace(
            &workshop,
            &plan,
            &postcard::to_stdvec(&(&wrong, &warnings)).unwrap(),
        );
        assert_eq!(survive(&workshop, BOARD), files, "{name}");
    }
}

#[test]
fn warnings_from_the_store_do_not_speak_to_the_terminal() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let plan = entries_of(&workshop, "plan").remove(0);
    let whole = payload(&workshop.files.read(&plan).unwrap());
    let (maps, _): Record = postcard::from_bytes(&whole).unwrap();
    let told = |warning: &str| {
        // All keys of nodes: one of them is in the plan.
        let graph = workshop.graph(BOARD);
        let warnings = vec![(maps[0].2, warning.to_owned()); graph.nodes.node_count()];
        replace(
            &workshop,
            &plan,
            &postcard::to_stdvec(&(&maps, &warnings)).unwrap(),
        );
        let run = workshop
            .another(options())
            .render(BOARD, &[], Cancel::new(), &|_| {});
        // A record that is believed is left alone.
        let after = workshop.files.read(&plan).unwrap();
        (run.log().contains("\u{1b}"), payload(&after) == whole)
    };
    assert_eq!(told("\u{1b}[2J\u{7}"), (false, true));
    assert_eq!(told("a plain word\nand another"), (false, false));
}

/// A store in which every entry goes on for ever; counts what is read of it.
struct Endless {
    files: Memory,
    read: Arc<AtomicU64>,
}

struct Counted(Arc<AtomicU64>, Box<dyn Read>);

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.1.read(buffer)?;
        self.0.fetch_add(read as u64, Ordering::Relaxed);
        Ok(read)
    }
}

impl World for Endless {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        assert!(!path.starts_with(STORE), "entries are read as streams");
        self.files.read(path)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        let start = io::Cursor::new(self.files.read(path)?);
        if !path.starts_with(STORE) {
            return Ok(Box::new(start));
        }
        let endless = Box::new(start.chain(io::repeat(0)));
        Ok(Box::new(Counted(Arc::clone(&self.read), endless)))
    }

    fn read_start(&self, path: &Path, length: usize) -> io::Result<Vec<u8>> {
        let mut start = vec![];
        self.open(path)?
            .take(length as u64)
            .read_to_end(&mut start)?;
        Ok(start)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        self.files.create(path)
    }
}

#[test]
fn no_more_is_read_of_an_entry_than_its_header_says_and_its_family_may_have() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let right = right_maps();
    let read = Arc::new(AtomicU64::new(0));
    let whole: u64 = entries(&workshop)
        .iter()
        .map(|path| workshop.files.read(path).unwrap().len() as u64)
        .sum();
    let endless = || {
        let world = Endless {
            files: workshop.files.clone(),
            read: Arc::clone(&read),
        };
        read.store(0, Ordering::Relaxed);
        let log = workshop.another_on(Arc::new(world), options()).run(BOARD);
        assert!(MAPS.map(|name| workshop.map(name)) == right);
        (log, read.load(Ordering::Relaxed))
    };
    // Headers as they were: each entry is read to its end and one byte further.
    let (log, bytes) = endless();
    assert!(log.contains("built tree"), "{log}");
    assert!(bytes <= 2 * whole + 1000, "{bytes} of {whole}");
    // Headers that promise more than there can be.
    for path in entries(&workshop) {
        let mut entry = workshop.files.read(&path).unwrap();
        entry[HEADER - 16..HEADER].copy_from_slice(b"0fffffffffffffff");
        workshop.files.insert(&path, entry);
    }
    let (_, bytes) = endless();
    assert!(bytes <= 2 * whole + 1000, "{bytes} of {whole}");
}
