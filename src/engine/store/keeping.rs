//! Keeping house in the store: what lies in it, and removing it.

use super::family::Family;
use super::{UNFINISHED, entry};
use crate::world::{Listed, World};
use serde::Serialize;
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The entries of one family in a store.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StoreFamily {
    /// `structure`, `map` (what is known of a map), `file` (copies of maps), `plan` or `run`.
    pub family: &'static str,
    /// How many there are.
    pub entries: usize,
    /// Their bytes.
    pub bytes: u64,
    /// For how many seconds the one has not been used that was used longest ago, to within some hours;
    /// `None` if there are none.
    pub oldest_seconds: Option<u64>,
}

/// A file in the store with the name of an entry.
pub(super) struct Kept {
    pub(super) path: PathBuf,
    pub(super) bytes: u64,
    /// When it was last written or used.
    pub(super) modified: Option<SystemTime>,
}

/// Counts the entries of the store in `folder`; a folder that is not there holds none.
///
/// # Errors
/// Whatever the operating system says.
pub fn store_status(world: &dyn World, folder: &Path) -> io::Result<Vec<StoreFamily>> {
    let status = |family: Family| {
        let entries = entries(world, &folder.join(family.name()))?;
        Ok(family_of(family, &entries))
    };
    Family::ALL.into_iter().map(status).collect()
}

/// Removes every entry of the store in `folder`, and the folders that are empty by that; says what was
/// removed. Whatever is not named and begun as an entry stays, and so does every folder in which there was
/// none. Runs that use the store meanwhile miss what is gone and are not harmed.
///
/// # Errors
/// The first error of the operating system; what could be removed is removed.
pub fn clean_store(world: &dyn World, folder: &Path) -> io::Result<Vec<StoreFamily>> {
    let mut removed = vec![];
    let mut result = Ok(());
    for family in Family::ALL {
        let place = folder.join(family.name());
        let (gone, failed): (Vec<_>, Vec<_>) = entries(world, &place)?
            .into_iter()
            .map(|entry| (remove(world, &entry.path), entry))
            .partition(|(removed, _)| removed.is_ok());
        for (error, _) in failed {
            result = result.and(error);
        }
        let gone: Vec<Kept> = gone.into_iter().map(|(_, entry)| entry).collect();
        remove_left(world, &place, &gone);
        removed.push(family_of(family, &gone));
    }
    let is_store = removed.iter().any(|family| family.entries > 0);
    let unfinished = folder.join(UNFINISHED);
    if !world.is_link(&unfinished) {
        world.sweep(&unfinished);
        if is_store {
            let _ = world.remove(&unfinished);
        }
    }
    if is_store && !world.is_link(folder) {
        // Holds other things, or is in use: then it stays.
        let _ = world.remove(folder);
    }
    result.map(|()| removed)
}

/// Every file in the store that counts; folders that may not be looked into hold none.
///
/// # Errors
/// If the disk fails, or the run was cancelled: then nothing is known.
pub(super) fn kept(world: &dyn World, folder: &Path) -> io::Result<Vec<Kept>> {
    let mut kept = vec![];
    for family in Family::ALL {
        for numbered in or_nothing(numbered(world, &folder.join(family.name())))? {
            let files = or_nothing(list(world, &numbered))?;
            kept.extend(files.into_iter().filter_map(Kept::new));
        }
    }
    Ok(kept)
}

/// Nothing, for a folder that is none or that may not be looked into.
fn or_nothing<T>(listed: io::Result<Vec<T>>) -> io::Result<Vec<T>> {
    use io::ErrorKind::{NotADirectory, PermissionDenied, Unsupported};
    match listed {
        Err(error) if matches!(error.kind(), NotADirectory | PermissionDenied | Unsupported) => {
            Ok(vec![])
        }
        listed => listed,
    }
}

/// Removes what another process may have removed as well.
pub(super) fn remove(world: &dyn World, path: &Path) -> io::Result<()> {
    match world.remove(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        removed => removed,
    }
}

impl Kept {
    /// `None` if it is something else by its name, or no plain file.
    fn new(listed: Listed) -> Option<Kept> {
        let named = has_digits(&listed.path, 62);
        let bytes = listed.bytes.filter(|_| named && !listed.is_link)?;
        Some(Kept {
            path: listed.path,
            bytes,
            modified: listed.modified,
        })
    }

    /// Whether its time is further in the future than `by`.
    pub(super) fn is_ahead(&self, now: SystemTime, by: Duration) -> bool {
        let ahead = self.modified.and_then(|it| it.duration_since(now).ok());
        ahead.is_some_and(|ahead| ahead > by)
    }

    /// Whether it may be removed: it is begun as an entry.
    pub(super) fn is_ours(&self, world: &dyn World) -> bool {
        entry::is_ours(world, &self.path)
    }

    /// How long ago it was used; no time at all if that lies in the future.
    fn age(&self, now: SystemTime) -> Duration {
        let age = self.modified.and_then(|it| now.duration_since(it).ok());
        age.unwrap_or_default()
    }
}

fn family_of(family: Family, entries: &[Kept]) -> StoreFamily {
    let now = SystemTime::now();
    let ages = entries.iter().map(|entry| entry.age(now).as_secs());
    StoreFamily {
        family: family.name(),
        entries: entries.len(),
        bytes: entries
            .iter()
            .fold(0, |sum: u64, entry| sum.saturating_add(entry.bytes)),
        oldest_seconds: ages.max(),
    }
}

/// The entries of a family.
fn entries(world: &dyn World, family: &Path) -> io::Result<Vec<Kept>> {
    let mut entries = vec![];
    for folder in numbered(world, family)? {
        let files = list(world, &folder)?.into_iter().filter_map(Kept::new);
        entries.extend(files.filter(|file| file.is_ours(world)));
    }
    Ok(entries)
}

/// The folders of a family.
fn numbered(world: &dyn World, family: &Path) -> io::Result<Vec<PathBuf>> {
    if world.is_link(family) {
        return Ok(vec![]);
    }
    let folders = list(world, family)?.into_iter();
    let folders = folders.filter(|it| it.bytes.is_none() && !it.is_link);
    let paths = folders.map(|folder| folder.path);
    Ok(paths.filter(|path| has_digits(path, 2)).collect())
}

/// What is in a folder, or would be if it were there and one.
fn list(world: &dyn World, folder: &Path) -> io::Result<Vec<Listed>> {
    match world.list(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(vec![]),
        listed => listed,
    }
}

/// Whether the name of a path is `count` hexadecimal digits.
fn has_digits(path: &Path, count: usize) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    name.is_some_and(|name| name.len() == count && name.bytes().all(is_digit))
}

/// Removes the folders of a family from which all entries are gone.
fn remove_left(world: &dyn World, family: &Path, gone: &[Kept]) {
    let folders: BTreeSet<&Path> = gone
        .iter()
        .filter_map(|entry| entry.path.parent())
        .collect();
    for folder in &folders {
        // A folder that is not empty is refused by the system, and stays.
        let _ = world.remove(folder);
    }
    if !folders.is_empty() {
        let _ = world.remove(family);
    }
}
