//! Keeping house in the store: what lies in it, and removing it.

use super::store::{FAMILIES, LAYOUT_NAME, UNFINISHED};
use crate::world::{Listed, World};
use serde::Serialize;
use std::io;
use std::path::Path;

/// The entries of one family in a store.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StoreFamily {
    /// `structure`, `map` (what is known of a map), `file` (copies of maps), `plan` or `run`.
    pub family: &'static str,
    /// How many there are.
    pub entries: usize,
    /// What they take on disk, in bytes.
    pub bytes: u64,
}

/// Counts the entries of the store in `folder`; a folder that is not there holds none.
///
/// # Errors
/// Whatever the operating system says.
pub fn store_status(world: &dyn World, folder: &Path) -> io::Result<Vec<StoreFamily>> {
    let status = |family: &'static str| {
        let entries = entries(world, &folder.join(family))?;
        Ok(family_of(family, &entries))
    };
    FAMILIES.into_iter().map(status).collect()
}

/// Removes every entry of the store in `folder`, and the folders that are empty then; says what was
/// removed. Whatever is not named and begun as an entry stays. Runs that use the store meanwhile miss what
/// is gone and are not harmed.
///
/// # Errors
/// The first error of the operating system; what could be removed is removed.
pub fn clean_store(world: &dyn World, folder: &Path) -> io::Result<Vec<StoreFamily>> {
    let mut removed = vec![];
    let mut result = Ok(());
    for family in FAMILIES {
        let place = folder.join(family);
        let (gone, failed): (Vec<_>, Vec<_>) = entries(world, &place)?
            .into_iter()
            .map(|entry| (remove(world, &entry.path), entry))
            .partition(|(removed, _)| removed.is_ok());
        for (error, _) in failed {
            result = result.and(error);
        }
        let gone: Vec<Listed> = gone.into_iter().map(|(_, entry)| entry).collect();
        removed.push(family_of(family, &gone));
        remove_empty(world, &place);
    }
    let unfinished = folder.join(UNFINISHED);
    world.sweep(&unfinished);
    // Holds other things, or is in use: then it stays.
    let _ = world.remove(&unfinished);
    let _ = world.remove(folder);
    result.map(|()| removed)
}

fn family_of(family: &'static str, entries: &[Listed]) -> StoreFamily {
    StoreFamily {
        family,
        entries: entries.len(),
        bytes: entries.iter().filter_map(|entry| entry.bytes).sum(),
    }
}

/// The files of a family: entries, and what programs that were killed have left half-written.
fn entries(world: &dyn World, family: &Path) -> io::Result<Vec<Listed>> {
    let mut entries = vec![];
    for folder in list(world, family)? {
        if folder.bytes.is_none() && has_digits(&folder.path, 2) {
            let files = list(world, &folder.path)?;
            entries.extend(files.into_iter().filter(|file| is_ours(world, file)));
        }
    }
    Ok(entries)
}

fn list(world: &dyn World, folder: &Path) -> io::Result<Vec<Listed>> {
    match world.list(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(vec![]),
        listed => listed,
    }
}

fn is_ours(world: &dyn World, file: &Listed) -> bool {
    let name = file.path.file_name().and_then(|name| name.to_str());
    let Some((name, bytes)) = name.zip(file.bytes) else {
        return false;
    };
    let is_half = name.starts_with(".yosegi-") && name.ends_with(".part");
    // A loss of power may leave an entry without contents.
    let begins_well = || {
        let start = world.read_start(&file.path, LAYOUT_NAME.len());
        bytes == 0 || start.is_ok_and(|start| start == LAYOUT_NAME)
    };
    is_half || has_digits(&file.path, 62) && begins_well()
}

/// Whether the name of a path is `count` hexadecimal digits.
fn has_digits(path: &Path, count: usize) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    name.is_some_and(|name| name.len() == count && name.bytes().all(is_digit))
}

fn remove(world: &dyn World, path: &Path) -> io::Result<()> {
    match world.remove(path) {
        // Another program was quicker.
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        removed => removed,
    }
}

/// Removes the folders of a family that are empty.
fn remove_empty(world: &dyn World, family: &Path) {
    for folder in list(world, family).unwrap_or_default() {
        if folder.bytes.is_none() && has_digits(&folder.path, 2) {
            // A folder that is not empty is refused by the system, and stays.
            let _ = world.remove(&folder.path);
        }
    }
    let _ = world.remove(family);
}
