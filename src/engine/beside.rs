//! Files that a recipe names: beside it, in the assets of its folder, or in those beside its folder.

use crate::world::World;
use std::io;
use std::path::{Path, PathBuf};

/// Reads the files of one recipe.
pub(super) struct Beside<'w> {
    world: &'w dyn World,
    folders: [PathBuf; 3],
    /// Where the folders that exist really lie; empty if files may be anywhere.
    roots: Vec<PathBuf>,
    /// Why it is not known of some folder where it lies.
    trouble: Option<io::Error>,
    allow_outside: bool,
}

impl<'w> Beside<'w> {
    /// For a recipe in `folder`.
    pub(super) fn new(world: &'w dyn World, folder: &Path, allow_outside: bool) -> Beside<'w> {
        let folders = [
            folder.to_owned(),
            folder.join("assets"),
            folder.join("../assets"),
        ];
        let (mut roots, mut trouble) = (vec![], None);
        for folder in &folders {
            match world.real_path(folder) {
                Ok(root) => roots.push(root),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => trouble = Some(error),
            }
        }
        Beside {
            roots,
            trouble,
            world,
            folders,
            allow_outside,
        }
    }

    /// The first file called `path`, with the place where it really lies.
    ///
    /// # Errors
    /// As [`World::read`]. A symbolic link that leads out of the folders counts as if nothing were there,
    /// whether something is there or not.
    pub(super) fn read(&self, path: &Path) -> io::Result<(PathBuf, Vec<u8>)> {
        let mut missing = io::Error::new(io::ErrorKind::NotFound, "no such file");
        for folder in &self.folders {
            match self.read_at(&folder.join(path)) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => missing = error,
                read => return read,
            }
        }
        Err(missing)
    }

    fn read_at(&self, place: &Path) -> io::Result<(PathBuf, Vec<u8>)> {
        let missing = || io::Error::new(io::ErrorKind::NotFound, "no such file");
        let real = match self.world.real_path(place) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Err(missing()),
            real => real?,
        };
        let is_inside = self.roots.iter().any(|root| real.starts_with(root));
        if !is_inside && !self.allow_outside {
            let trouble = self.trouble.as_ref();
            return Err(trouble.map_or_else(missing, |error| {
                io::Error::new(error.kind(), error.to_string())
            }));
        }
        // What was looked at is what is read.
        let bytes = self.world.read(&real)?;
        Ok((real, bytes))
    }
}
