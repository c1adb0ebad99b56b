//! The limit of the store: what was used longest ago goes, whatever the clock says.

use super::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant, SystemTime};
use yosegi::engine::store_status;
use yosegi::world::{Disk, Listed, Memory, PendingFile};

const BLOCK: u64 = 4096;
const DAY: Duration = Duration::from_secs(24 * 3600);

fn limited(bytes: u64) -> Options {
    Options {
        store_limit: bytes,
        ..options()
    }
}

/// What the store takes in whole blocks.
fn taken(workshop: &Workshop) -> u64 {
    let sizes = entries(workshop).into_iter().map(|path| {
        let bytes = workshop.files.read(&path).unwrap().len() as u64;
        bytes.div_ceil(BLOCK) * BLOCK
    });
    sizes.sum()
}

/// The board with another growth: eight entries of which one structure is shared.
fn variant(number: usize) -> String {
    BOARD.replace("thickening: 3,", &format!("thickening: 3.{number:05},"))
}

/// Makes all entries look as if they were used so long ago, or so far in the future.
fn used(workshop: &Workshop, path: &Path, when: SystemTime) {
    assert!(workshop.files.set_modified(path, when));
}

#[test]
fn a_store_stays_within_its_limit_over_many_runs() {
    let limit = 40 * BLOCK;
    let workshop = workshop(limited(limit));
    for number in 0..60 {
        let log = workshop.run(&variant(number));
        assert!(log.contains("written board_height.png"), "{log}");
        assert!(taken(&workshop) <= limit, "{number}: {}", taken(&workshop));
        let last = workshop.run(&variant(number));
        assert!(last.contains("up to date board_height.png"), "{last}");
    }
    assert!(taken(&workshop) >= limit / 2, "{}", taken(&workshop));
}

#[test]
fn the_entries_used_longest_ago_go_first() {
    let workshop = workshop(limited(1 << 20));
    workshop.run(BOARD);
    let first = entries(&workshop);
    workshop.run(&variant(1));
    let now = SystemTime::now();
    for path in entries(&workshop) {
        let is_first = first.contains(&path);
        used(&workshop, &path, now - if is_first { 2 * DAY } else { DAY });
    }
    // The first board is used again: that counts, although nothing but times is written.
    let again = workshop.another(limited(1 << 20));
    assert!(again.run(BOARD).contains("restored"));
    let second = entries(&workshop).len() - first.len();
    let small = workshop.another(limited(15 * BLOCK));
    small.run(&variant(2));
    let left = entries(&workshop);
    assert!(first.iter().all(|path| left.contains(path)));
    // What is new is as much as the second board had.
    assert!(left.len() < first.len() + 2 * second);
    assert!(taken(&workshop) <= 15 * BLOCK);
}

/// Ten times too much, with times that no clock should have given.
#[test]
fn a_store_far_over_its_limit_is_brought_down_to_it_whatever_its_times_are() {
    let year = 365 * DAY;
    let now = SystemTime::now();
    let times = [
        SystemTime::UNIX_EPOCH,
        now - 10 * year,
        now - DAY,
        now,
        now + Duration::from_secs(60),
        now + 10 * year,
        now + 75 * year,
    ];
    let limit = 12 * BLOCK;
    for time in times {
        let workshop = workshop(limited(u64::MAX));
        for number in 0..25 {
            workshop.run(&variant(number));
        }
        assert!(taken(&workshop) > 9 * limit, "{}", taken(&workshop));
        entries(&workshop)
            .iter()
            .for_each(|path| used(&workshop, path, time));
        let small = workshop.another(limited(limit));
        let log = small.run(&variant(99));
        assert!(log.contains("written"), "{log}");
        assert!(taken(&workshop) <= limit, "{}", taken(&workshop));
        // What was written last is what is left.
        assert!(
            workshop
                .another(limited(limit))
                .run(&variant(99))
                .contains("up to date")
        );
    }
}

#[test]
fn what_lies_in_the_future_was_used_before_the_clock_was_set_back() {
    let workshop = workshop(limited(1 << 20));
    workshop.run(BOARD);
    let ahead = entries(&workshop);
    let now = SystemTime::now();
    ahead
        .iter()
        .for_each(|path| used(&workshop, path, now + 27_000 * DAY));
    workshop.run(&variant(1));
    let mut yesterday = entries(&workshop);
    yesterday.retain(|path| !ahead.contains(path));
    yesterday
        .iter()
        .for_each(|path| used(&workshop, path, now - DAY));
    // 13 entries, and 5 more of which two structures are in use.
    workshop.another(limited(15 * BLOCK)).run(&variant(2));
    let left = entries(&workshop);
    assert!(yesterday.iter().all(|path| left.contains(path)));
    let ahead = ahead.iter().filter(|path| left.contains(path)).count();
    assert!(ahead <= 5, "{ahead} entries of 2099 are left");
}

#[test]
fn a_limit_of_nothing_keeps_nothing_and_harms_no_map() {
    let full = workshop(limited(1 << 20));
    full.run(&variant(1));
    assert!(taken(&full) > 0);
    let none = full.another(limited(0));
    let log = none.run(BOARD);
    assert!(!log.contains("store failed"), "{log}");
    assert_eq!(MAPS.map(|name| full.map(name)), right_maps());
    assert_eq!(entries(&full), [] as [PathBuf; 0]);
    assert!(
        full.another(limited(0))
            .run(BOARD)
            .contains("written board_height.png")
    );
}

#[test]
fn an_entry_larger_than_the_limit_is_not_kept_and_the_smaller_ones_are() {
    let whole = workshop(limited(1 << 20));
    let recipe = BOARD.replace("pixels: (24, 20)", "pixels: (120, 100), format: bmp");
    let recipe = recipe.replace("channels: [base_color, height]", "channels: [base_color]");
    whole.run(&recipe);
    assert!(entries_of(&whole, "file").len() == 1 && taken(&whole) > 8 * BLOCK);
    let small = workshop(limited(8 * BLOCK));
    let log = small.run(&recipe);
    assert!(!log.contains("store failed"), "{log}");
    assert_eq!(entries_of(&small, "file"), [] as [PathBuf; 0]);
    assert_eq!(entries_of(&small, "structure").len(), 2);
    // Its file is known, but cannot be restored.
    assert!(
        small
            .another(limited(8 * BLOCK))
            .run(&recipe)
            .contains("up to date")
    );
    small
        .files
        .remove(&place(&small, "board_base_color.bmp"))
        .unwrap();
    assert!(
        small
            .another(limited(8 * BLOCK))
            .run(&recipe)
            .contains("written")
    );
    assert_eq!(
        small.map("board_base_color.bmp"),
        whole.map("board_base_color.bmp")
    );
}

/// Looks at the store whenever the world is listed or an entry is put in place.
#[derive(Clone)]
struct Watched {
    files: Memory,
    listed: Arc<AtomicUsize>,
}

impl World for Watched {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        self.files.read(path)
    }

    fn create(&self, path: &Path) -> std::io::Result<Box<dyn PendingFile>> {
        self.files.create(path)
    }

    fn list(&self, folder: &Path) -> std::io::Result<Vec<Listed>> {
        if folder == Path::new("store/structure") {
            self.listed.fetch_add(1, Ordering::Relaxed);
        }
        self.files.list(folder)
    }

    fn touch(&self, path: &Path, after: Duration) -> std::io::Result<()> {
        self.files.touch(path, after)
    }

    fn remove(&self, path: &Path) -> std::io::Result<()> {
        self.files.remove(path)
    }
}

#[test]
fn nothing_that_a_run_uses_goes_before_it_ends() {
    let workshop = workshop(options());
    let world = Watched {
        files: workshop.files.clone(),
        listed: Arc::default(),
    };
    // Fewer blocks than one run needs.
    let small = workshop.another_on(Arc::new(world), limited(5 * BLOCK));
    let both = BOARD.replace(
        "    outputs: {",
        r#"    outputs: {
        "second": maps(of: "plank", pixels: (24, 20), channels: [base_color]),"#,
    );
    let most = AtomicUsize::new(0);
    let run = small.render(&both, &[], Cancel::new(), &|_| {
        most.fetch_max(entries(&small).len(), Ordering::Relaxed);
    });
    assert!(run.result.is_ok());
    assert!(most.into_inner() > 5);
    assert!(taken(&small) <= 5 * BLOCK, "{}", taken(&small));
}

/// Counting the folder has to cost little per entry, however many runs there are.
#[test]
fn the_folder_is_counted_once_in_many_puts() {
    let workshop = workshop(options());
    let world = Watched {
        files: workshop.files.clone(),
        listed: Arc::default(),
    };
    let listed = Arc::clone(&world.listed);
    let large = workshop.another_on(Arc::new(world), limited(200 * BLOCK));
    let puts = 7 * 100;
    for number in 0..100 {
        large.run(&variant(number));
    }
    assert!(taken(&large) <= 200 * BLOCK);
    // It is counted after 20 puts, or after 10 just below the limit, and each put takes a block.
    let listed = listed.load(Ordering::Relaxed);
    assert!((1..=2 + puts / 10).contains(&listed), "{listed}");
}

/// What cannot be counted is not taken for an empty store: once the disk is well again the limit holds.
#[test]
fn a_store_that_could_not_be_counted_is_counted_later() {
    let workshop = workshop(options());
    for number in 0..20 {
        workshop.run(&variant(number));
    }
    let fails = Arc::new(AtomicUsize::new(1));
    let world = Uncounted(workshop.files.clone(), Arc::clone(&fails));
    let limited = workshop.another_on(Arc::new(world), limited(20 * BLOCK));
    assert!(!limited.run(&variant(21)).contains("store failed"));
    assert!(taken(&workshop) > 20 * BLOCK);
    fails.store(0, Ordering::Relaxed);
    assert!(!limited.run(&variant(22)).contains("store failed"));
    assert!(taken(&workshop) <= 20 * BLOCK);
}

/// Cannot be listed as long as the number is not 0.
struct Uncounted(Memory, Arc<AtomicUsize>);

impl World for Uncounted {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        self.0.read(path)
    }

    fn create(&self, path: &Path) -> std::io::Result<Box<dyn PendingFile>> {
        self.0.create(path)
    }

    fn list(&self, folder: &Path) -> std::io::Result<Vec<Listed>> {
        match self.1.load(Ordering::Relaxed) {
            0 => self.0.list(folder),
            _ => Err(std::io::Error::other("a fault")),
        }
    }

    fn remove(&self, path: &Path) -> std::io::Result<()> {
        self.0.remove(path)
    }
}

#[test]
fn entries_that_another_process_evicts_are_misses() {
    let workshop = workshop(options());
    workshop.run(BOARD);
    let right = right_maps();
    for path in entries(&workshop) {
        let whole = workshop.files.read(&path).unwrap();
        workshop.files.remove(&path).unwrap();
        for map in MAPS {
            workshop.files.remove(&place(&workshop, map)).unwrap();
        }
        workshop.another(options()).run(BOARD);
        assert_eq!(MAPS.map(|name| workshop.map(name)), right);
        workshop.files.insert(path, whole);
    }
}

#[test]
fn the_age_of_the_oldest_entry_is_told() {
    let workshop = workshop(options());
    let oldest = || {
        let families = store_status(&workshop.files, Path::new(STORE)).unwrap();
        families
            .into_iter()
            .map(|it| it.oldest_seconds)
            .collect::<Vec<_>>()
    };
    assert_eq!(oldest(), [None; 5]);
    workshop.run(BOARD);
    let now = SystemTime::now();
    used(&workshop, &entries_of(&workshop, "map")[1], now - DAY);
    used(&workshop, &entries_of(&workshop, "plan")[0], now + DAY);
    let ages = oldest();
    assert!(
        ages[1].is_some_and(|age| (86_400..90_000).contains(&age)),
        "{ages:?}"
    );
    assert_eq!(ages[3], Some(0));
}

/// Renders so many different boards into one store on disk, as one long session does; gives the most that the
/// store took, in whole blocks.
fn session(runs: usize, limit: u64) -> u64 {
    let folder = tempfile::tempdir().unwrap();
    let options = Options {
        store: Some(folder.path().join("store")),
        ..limited(limit)
    };
    let mut session = workshop(options.clone()).another_on(Arc::new(Disk), options.clone());
    session.folder = folder.path().to_owned();
    let (mut most, mut seconds) = (0, vec![]);
    for number in 0..runs {
        let start = Instant::now();
        let log = session.run(&variant(number));
        seconds.push(start.elapsed().as_secs_f64());
        assert!(
            log.contains("written") && !log.contains("store failed"),
            "{log}"
        );
        if number % (runs / 50) == 0 || number + 1 == runs {
            most = most.max(taken_on_disk(&folder.path().join("store")));
        }
    }
    let tenth = runs / 10;
    let mean = |part: &[f64]| 1e3 * part.iter().sum::<f64>() / part.len() as f64;
    println!(
        "{runs} runs, limit {limit} bytes, at most {most} taken; {:.2} ms a run in the first tenth, {:.2} ms in the \
         last, {:.1} s in all",
        mean(&seconds[..tenth]),
        mean(&seconds[runs - tenth..]),
        seconds.iter().sum::<f64>()
    );
    most
}

fn taken_on_disk(folder: &Path) -> u64 {
    let entries = Disk.list(folder).unwrap().into_iter();
    let sizes = entries.map(|entry| match entry.bytes {
        Some(bytes) => bytes.div_ceil(BLOCK) * BLOCK,
        None => taken_on_disk(&entry.path),
    });
    sizes.sum()
}

#[test]
fn a_session_stays_within_its_limit() {
    let most = session(100, 1 << 20);
    assert!(most <= 1 << 20, "{most}");
    assert!(most > 3 << 18, "{most}");
}

#[test]
#[ignore = "takes a minute"]
fn campaign_of_a_long_session() {
    let runs = usize::try_from(campaign::variable("YOSEGI_RUNS", 20_000)).unwrap();
    let most = session(runs, 64 << 20);
    assert!(most <= 64 << 20, "{most}");
}
