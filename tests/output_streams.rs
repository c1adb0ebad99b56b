//! Maps are streams: their bytes depend on nothing but the rows, and a failure leaves nothing behind.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

mod output_support;

use output_support::worlds::{Counting, Failing, noise};
use output_support::{encoded, key, request, with_size};
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use yosegi::output::{MapKind, MapRequest, create};
use yosegi::value::{FileType, MapFormat};
use yosegi::world::{Disk, Memory, World};

const FORMATS: [MapFormat; 9] = MapFormat::ALL;
const PATH: &str = "maps/bark";

/// Writes the rows in calls of these numbers of rows, over and over.
fn written(request: &MapRequest, rows: &[u8], calls: &[usize]) -> Vec<u8> {
    let world = Memory::default();
    let mut writer = create(&world, PATH.as_ref(), request).unwrap();
    let mut rest = rows;
    for count in calls.iter().cycle() {
        let (now, later) = rest.split_at(rest.len().min(count * request.row_bytes()));
        writer.write_rows(now).unwrap();
        rest = later;
        if rest.is_empty() {
            break;
        }
    }
    writer.finish().unwrap();
    world.read(PATH.as_ref()).unwrap()
}

#[test]
fn grouping_rows_differently_does_not_change_the_file() {
    for (kind, size) in [
        (MapKind::Colour, [17, 67]),
        (MapKind::Number, [333, 32]),
        (MapKind::Normal, [1700, 40]),
    ] {
        for format in FORMATS {
            let request = with_size(size, kind, format);
            let rows = encoded(&request);
            let whole = written(&request, &rows, &[1000]);
            for calls in [
                &[1][..],
                &[2],
                &[7, 0, 3],
                &[16],
                &[17],
                &[15, 33],
                &[0, 40],
            ] {
                assert!(
                    whole == written(&request, &rows, calls),
                    "{format:?} {calls:?}"
                );
            }
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_the_file() {
    for format in FORMATS {
        let request = with_size([700, 300], MapKind::Colour, format);
        let rows = encoded(&request);
        let with_threads = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| written(&request, &rows, &[5, 300]))
        };
        let one = with_threads(1);
        for threads in [2, 3, 7] {
            assert!(one == with_threads(threads), "{format:?} {threads} threads");
        }
    }
}

#[test]
fn the_same_rows_give_the_same_file_every_time() {
    for format in FORMATS {
        let request = with_size([97, 41], MapKind::Normal, format);
        let rows = encoded(&request);
        let first = written(&request, &rows, &[41]);
        std::thread::scope(|scope| {
            let again = || (0..10).all(|_| first == written(&request, &rows, &[5]));
            let threads = [scope.spawn(again), scope.spawn(again)];
            assert!(
                threads
                    .map(|thread| thread.join().unwrap())
                    .iter()
                    .all(|same| *same)
            );
        });
    }
}

#[test]
fn a_file_appears_when_it_is_finished_and_not_before() {
    for format in FORMATS {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("maps/bark");
        let request = request(MapKind::Colour, format);
        let rows = encoded(&request);
        let files = || {
            std::fs::read_dir(folder.path().join("maps"))
                .unwrap()
                .count()
        };
        for part in [0, rows.len() / 4, rows.len()] {
            let whole_rows = part - part % request.row_bytes();
            let mut writer = create(&Disk, &path, &request).unwrap();
            writer.write_rows(&rows[..whole_rows]).unwrap();
            assert!(!path.exists());
            drop(writer);
            assert_eq!(files(), 0, "{format:?} dropped after {whole_rows} bytes");
        }
        let mut writer = create(&Disk, &path, &request).unwrap();
        writer.write_rows(&rows).unwrap();
        writer.finish().unwrap();
        assert_eq!(files(), 1);
        assert_eq!(
            std::fs::read(&path).unwrap(),
            written(&request, &rows, &[20])
        );
    }
}

#[test]
fn wrong_rows_are_errors_and_the_map_is_given_up() {
    for format in FORMATS {
        let request = request(MapKind::Number, format);
        let rows = encoded(&request);
        let row = request.row_bytes();
        let cases: [(&[&[u8]], String); 4] = [
            (
                &[&rows, &rows[..row]],
                "expected 0 more rows, found 1".to_owned(),
            ),
            (
                &[&rows[..row + 1]],
                format!("expected rows of {row} bytes, found {} bytes", row + 1),
            ),
            (&[&rows[..row * 2]], "18 rows are missing".to_owned()),
            (&[], "20 rows are missing".to_owned()),
        ];
        for (calls, message) in cases {
            let world = Memory::default();
            let mut writer = create(&world, PATH.as_ref(), &request).unwrap();
            let result = calls.iter().try_for_each(|rows| writer.write_rows(rows));
            let wrong_call = result.is_err();
            let error = result
                .and_then(|()| create_nothing(writer, wrong_call))
                .unwrap_err();
            assert_eq!(
                error.to_string(),
                format!("cannot write `{PATH}`: {message}")
            );
            assert!(world.paths().is_empty());
        }
    }
}

/// Finishes a writer unless it has failed before.
fn create_nothing(writer: Box<dyn yosegi::output::MapWriter>, failed: bool) -> io::Result<()> {
    assert!(!failed);
    writer.finish()
}

#[test]
fn a_request_that_no_file_can_hold_is_refused() {
    let world = Memory::default();
    let good = request(MapKind::Number, MapFormat::Png8);
    let nameless = MapRequest {
        channel: String::new(),
        ..good.clone()
    };
    let foreign = MapRequest {
        channel: "樹皮".to_owned(),
        ..good.clone()
    };
    let flat = |format| with_size([0, 5], MapKind::Number, format);
    let wide = with_size([(1 << 22) + 1, 5], MapKind::Number, MapFormat::ExrFloat);
    for request in [
        nameless,
        foreign,
        flat(MapFormat::Png8),
        flat(MapFormat::ExrHalf),
        wide,
    ] {
        let error = create(&world, PATH.as_ref(), &request).err().unwrap();
        assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        assert!(
            error
                .to_string()
                .starts_with("cannot write `maps/bark`: expected"),
            "{error}"
        );
    }
}

#[test]
fn a_size_that_says_nothing_is_left_out() {
    for format in FORMATS {
        for size_mm in [[0.0, 1.0], [f64::NAN, 1.0], [-1.0, 1.0]] {
            let request = MapRequest {
                size_mm,
                ..request(MapKind::Number, format)
            };
            let plain = written(&request, &encoded(&request), &[20]);
            assert!(!plain.windows(4).any(|name| name == b"pHYs"));
            assert!(!plain.windows(8).any(|name| name == b"xDensity"));
            // The tag of the resolution across, a fraction.
            assert!(!plain.windows(4).any(|tag| tag == [0x1a, 1, 5, 0]));
        }
    }
}

fn write_all(world: &dyn World, request: &MapRequest, rows: &[u8]) -> io::Result<()> {
    let mut writer = create(world, PATH.as_ref(), request)?;
    for row in rows.chunks(request.row_bytes()) {
        if let Err(error) = writer.write_rows(row) {
            assert!(
                writer.write_rows(row).is_err(),
                "a map that failed stays failed"
            );
            assert!(writer.finish().is_err());
            return Err(error);
        }
    }
    writer.finish()
}

#[test]
fn a_disk_that_fails_at_any_moment_gives_an_error_and_no_file() {
    for format in FORMATS {
        let request = with_size([700, 130], MapKind::Colour, format);
        let rows = noise(130 * request.row_bytes(), 0);
        let mut failures = 0;
        loop {
            let files = Memory::default();
            files.insert(PATH, "the old map");
            let world = Failing {
                files,
                left: Arc::new(AtomicUsize::new(failures)),
            };
            let result = write_all(&world, &request, &rows);
            let Err(error) = result else { break };
            assert_eq!(error.kind(), io::ErrorKind::StorageFull);
            assert_eq!(
                error.to_string(),
                "cannot write `maps/bark`: the disk is full"
            );
            assert_eq!(world.files.read(PATH.as_ref()).unwrap(), b"the old map");
            failures += 1;
        }
        // Every block of rows, the header, the table or the end, and the commit can fail.
        assert!(failures > 6, "{format:?}: {failures}");
    }
}

#[test]
fn a_writer_holds_no_more_than_a_block_of_rows() {
    for format in FORMATS {
        // PIZ is slow.
        let height = match format.file_type() {
            FileType::Exr => 160,
            _ => 500,
        };
        let request = with_size([16384, height], MapKind::Number, format);
        let world = Counting::default();
        let mut writer = create(&world, PATH.as_ref(), &request).unwrap();
        // What has been fed and has not come out is inside.
        let mut held = 0;
        for fed in 1..=height as usize / 4 {
            let block = noise(4 * request.row_bytes(), fed as u64);
            writer.write_rows(&block).unwrap();
            held = held.max((fed * block.len()).saturating_sub(world.0.load(Ordering::Relaxed)));
        }
        writer.finish().unwrap();
        let limit = (1 << 17) + 32 * request.row_bytes();
        assert!(held <= limit, "{format:?}: {held} > {limit}");
    }
}

#[test]
fn a_map_replaces_the_one_before_and_its_key_is_the_new_one() {
    let world = Memory::default();
    let mut request = request(MapKind::Number, MapFormat::Png8);
    for key in [key(), yosegi::key::Key::of_bytes(b"another board")] {
        request.key = key;
        write_all(&world, &request, &encoded(&request)).unwrap();
        assert_eq!(yosegi::output::read_key(&world, PATH.as_ref()), Some(key));
    }
    assert_eq!(world.paths(), [Path::new(PATH)]);
}
