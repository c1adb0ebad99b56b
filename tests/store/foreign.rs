//! A program that puts its own file over a map before the store has taken its copy: it is not remembered.

use super::*;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::Arc;
use yosegi::world::{Listed, Memory, PendingFile};

/// Files of which every map is replaced by a foreign file as soon as it is in place.
struct Overwritten {
    files: Memory,
    foreign: Vec<u8>,
}

struct OverwrittenFile {
    file: Box<dyn PendingFile>,
    files: Memory,
    path: PathBuf,
    foreign: Vec<u8>,
}

impl World for Overwritten {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.files.read(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        let file = self.files.create(path)?;
        if path.starts_with(STORE) {
            return Ok(file);
        }
        Ok(Box::new(OverwrittenFile {
            file,
            files: self.files.clone(),
            path: path.to_owned(),
            foreign: self.foreign.clone(),
        }))
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        self.files.list(folder)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.files.remove(path)
    }
}

impl Read for OverwrittenFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Write for OverwrittenFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for OverwrittenFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl PendingFile for OverwrittenFile {
    fn commit(self: Box<Self>) -> io::Result<()> {
        self.file.commit()?;
        self.files.insert(self.path, self.foreign);
        Ok(())
    }
}

/// Every map that is there, by path.
fn maps(workshop: &Workshop) -> Vec<(String, Vec<u8>)> {
    let names = workshop.maps().into_iter();
    names
        .map(|name| (name.clone(), workshop.map(&name)))
        .collect()
}

#[test]
fn the_file_of_another_program_is_not_remembered_as_the_map() {
    for format in ["png8", "bmp", "tiff16", "exr_half"] {
        let recipe = BOARD.replace(
            "of: \"plank\",",
            &format!("of: \"plank\", format: {format},"),
        );
        let right = workshop(options());
        right.run(&recipe);
        let right = maps(&right);
        // Of another program without a key, of this one with the same key and other samples, and no picture.
        let mut like_ours = right[0].1.clone();
        *like_ours.last_mut().unwrap() ^= 1;
        let foreign_png = b"\x89PNG\r\n\x1a\nforeign".to_vec();
        for foreign in [foreign_png, b"BMforeign".to_vec(), like_ours, vec![]] {
            let workshop = workshop(options());
            let world = Overwritten {
                files: workshop.files.clone(),
                foreign,
            };
            workshop.another_on(Arc::new(world), options()).run(&recipe);
            assert!(entries_of(&workshop, "map").is_empty());
            assert!(entries_of(&workshop, "file").is_empty());
            for (name, _) in &right {
                workshop.files.remove(&place(&workshop, name)).unwrap();
            }
            workshop.another(options()).run(&recipe);
            assert!(maps(&workshop) == right, "{format}");
            assert_eq!(entries_of(&workshop, "map").len(), 2);
        }
    }
}
