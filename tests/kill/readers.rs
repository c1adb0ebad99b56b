//! Readers look at a map in a tight loop while several writers replace it.

use super::number;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use yosegi::key::KeyHasher;
use yosegi::output::{MapKind, MapRequest, create};
use yosegi::value::MapFormat;
use yosegi::world::{Disk, Memory, World};

const SIDE: u32 = 40;

/// A format for each type of file.
fn formats() -> Vec<MapFormat> {
    let mut formats: Vec<MapFormat> = vec![];
    for format in MapFormat::ALL {
        let is_new = |it: &MapFormat| it.file_type() != format.file_type();
        if formats.iter().all(is_new) {
            formats.push(format);
        }
    }
    formats
}

/// Writes a map whose pixels are all alike.
fn write(world: &dyn World, path: &Path, format: MapFormat, sample: u8) {
    let request = MapRequest {
        pixels: [SIDE, SIDE],
        size_mm: [10.0, 10.0],
        kind: MapKind::Colour,
        format,
        key: KeyHasher::new("test", 1).finish(),
        channel: "base_color".to_owned(),
    };
    let mut writer = create(world, path, &request).unwrap();
    let rows = vec![sample; request.row_bytes() * SIDE as usize];
    writer.write_rows(&rows).unwrap();
    writer.finish().unwrap();
}

/// Two writers replace one map; gives how often it was read meanwhile.
fn campaign(replacements: u64) -> u64 {
    let formats = formats();
    assert_eq!(formats.len(), 4);
    let share = replacements / formats.len() as u64;
    formats.iter().map(|format| replace(*format, share)).sum()
}

fn replace(format: MapFormat, replacements: u64) -> u64 {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("map.{}", format.extension()));
    let right = [10, 200].map(|sample| {
        let world = Memory::default();
        write(&world, &path, format, sample);
        world.read(&path).unwrap()
    });
    assert!(right[0] != right[1]);
    write(&Disk, &path, format, 10);
    let (is_done, reads) = (AtomicBool::new(false), AtomicU64::new(0));
    thread::scope(|scope| {
        let read = || {
            while !is_done.load(Ordering::Relaxed) {
                let bytes = fs::read(&path).unwrap();
                assert!(
                    right.contains(&bytes),
                    "a torn map of {} bytes",
                    bytes.len()
                );
                reads.fetch_add(1, Ordering::Relaxed);
            }
        };
        scope.spawn(read);
        let writers = [10, 200].map(|sample| {
            let path = &path;
            scope.spawn(move || {
                (0..replacements / 2).for_each(|_| write(&Disk, path, format, sample))
            })
        });
        writers
            .into_iter()
            .for_each(|writer| writer.join().unwrap());
        is_done.store(true, Ordering::Relaxed);
    });
    assert!(right.contains(&fs::read(&path).unwrap()));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    reads.into_inner()
}

#[test]
fn a_reader_never_sees_half_a_map() {
    assert!(campaign(400) > 0);
}

#[test]
#[ignore = "a campaign"]
fn a_reader_never_sees_half_a_map_of_a_hundred_thousand() {
    let replacements = number("YOSEGI_REPLACEMENTS", 100_000);
    let reads = campaign(replacements);
    println!("{replacements} replacements by two writers at once, {reads} reads, 0 torn maps");
}
