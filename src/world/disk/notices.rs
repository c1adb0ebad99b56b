//! Notices of the operating system.
//!
//! Folders are listened to, never files: a file that is replaced by a rename is another one afterwards.
//! A path is followed from the root on through every link, and each folder on the way is listened to for the
//! one name that matters, so that a folder that is renamed and brought back is noticed as well.

use super::LINKS;
use crate::world::{Heard, Notices, NoticesError, Wake};
use notify::event::{AccessKind, AccessMode};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::{BTreeMap, BTreeSet, HashMap, VecDeque};
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Listens to folders.
pub(super) struct DiskNotices {
    watcher: RecommendedWatcher,
    interests: Arc<Mutex<Interests>>,
}

/// What is listened to, and why.
#[derive(Debug, Default)]
struct Interests {
    /// For each entry of a folder the followed paths that lead through it.
    entries: HashMap<PathBuf, BTreeSet<PathBuf>>,
    /// The folders; `true` if one may have been replaced since.
    folders: BTreeMap<PathBuf, bool>,
}

impl DiskNotices {
    /// Starts to listen, to nothing yet.
    ///
    /// # Errors
    /// If the system has no notices, or no more of them.
    pub(super) fn new(wake: Wake) -> Result<DiskNotices, NoticesError> {
        let interests = Arc::new(Mutex::new(Interests::default()));
        let heard = Arc::clone(&interests);
        let watcher = notify::recommended_watcher(move |event| {
            let what = lock(&heard).concerns(event);
            // Outside the lock: whoever is woken may follow other paths at once.
            what.into_iter().for_each(|what| wake(what));
        });
        let watcher = watcher.map_err(|error| refused(&error))?;
        Ok(DiskNotices { watcher, interests })
    }
}

impl Notices for DiskNotices {
    fn follow(&mut self, paths: &BTreeSet<PathBuf>) -> Result<bool, NoticesError> {
        let mut entries: HashMap<PathBuf, BTreeSet<PathBuf>> = HashMap::new();
        for path in paths {
            for entry in entries_on_the_way(path) {
                entries.entry(entry).or_default().insert(path.clone());
            }
        }
        let wanted: BTreeSet<PathBuf> = entries
            .keys()
            .filter_map(|entry| entry.parent().map(Path::to_owned))
            .collect();
        // The lock is not held while the watcher is called: its thread may wait for the lock.
        let known = {
            let mut interests = lock(&self.interests);
            interests.entries = entries;
            interests.folders.clone()
        };
        let is_wanted = |folder: &PathBuf, replaced: bool| wanted.contains(folder) && !replaced;
        for (folder, replaced) in &known {
            if !is_wanted(folder, *replaced) {
                // Gone already if the folder is gone.
                let _ = self.watcher.unwatch(folder);
                lock(&self.interests).folders.remove(folder);
            }
        }
        let mut is_new = false;
        for folder in &wanted {
            if known.get(folder).is_none_or(|replaced| *replaced) {
                is_new |= self.listen_to(folder)?;
            }
        }
        Ok(is_new)
    }
}

impl DiskNotices {
    /// Listens to a folder, if it is there and may be read.
    fn listen_to(&mut self, folder: &Path) -> Result<bool, NoticesError> {
        match self.watcher.watch(folder, RecursiveMode::NonRecursive) {
            Ok(()) => {
                lock(&self.interests)
                    .folders
                    .insert(folder.to_owned(), false);
                Ok(true)
            }
            Err(error) if is_not_there(&error) => Ok(false),
            Err(error) => Err(refused(&error)),
        }
    }
}

impl Interests {
    /// What an event means for those who follow; `None` if nothing.
    fn concerns(&mut self, event: notify::Result<Event>) -> Option<Heard> {
        let event = match event {
            Ok(event) if !event.need_rescan() => event,
            _ => {
                self.folders
                    .values_mut()
                    .for_each(|replaced| *replaced = true);
                return Some(Heard::All);
            }
        };
        let is_read = match event.kind {
            EventKind::Access(kind) => kind != AccessKind::Close(AccessMode::Write),
            _ => false,
        };
        if is_read {
            return None;
        }
        let mut paths = BTreeSet::new();
        for path in &event.paths {
            paths.extend(self.entries.get(path).into_iter().flatten().cloned());
            if self.entries.contains_key(path) || self.folders.contains_key(path) {
                self.doubt_below(path);
            }
        }
        (!paths.is_empty()).then_some(Heard::Paths(paths))
    }

    /// The folders at and below a path that changed may be others now.
    fn doubt_below(&mut self, path: &Path) {
        for (folder, replaced) in &mut self.folders {
            *replaced |= folder.starts_with(path);
        }
    }
}

/// The entries of folders that decide what a path leads to: one for each of its names and for each name in the
/// links on the way. Their folders are real ones: two names of one folder would share one notice.
fn entries_on_the_way(path: &Path) -> Vec<PathBuf> {
    let Ok(path) = std::path::absolute(path) else {
        return vec![];
    };
    let (mut place, mut names) = (PathBuf::new(), VecDeque::new());
    let (mut entries, mut links) = (vec![], 0);
    go(&path, &mut place, &mut names);
    while let Some(name) = names.pop_front() {
        if name == ".." {
            place.pop();
            continue;
        }
        let entry = place.join(&name);
        match fs::read_link(&entry) {
            Ok(target) if links < LINKS => {
                links += 1;
                go(&target, &mut place, &mut names);
            }
            _ => place = entry.clone(),
        }
        entries.push(entry);
    }
    entries
}

/// Sets out from `place` along `path`, before the names that are still to go.
fn go(path: &Path, place: &mut PathBuf, names: &mut VecDeque<OsString>) {
    let mut along = vec![];
    for component in path.components() {
        match component {
            Component::Prefix(_) | Component::RootDir => {
                // Replaces what is there: a link that begins at the root leads away from its folder.
                place.push(component);
            }
            Component::CurDir => {}
            Component::ParentDir | Component::Normal(_) => {
                along.push(component.as_os_str().to_owned());
            }
        }
    }
    along
        .into_iter()
        .rev()
        .for_each(|name| names.push_front(name));
}

fn is_not_there(error: &notify::Error) -> bool {
    match &error.kind {
        notify::ErrorKind::PathNotFound => true,
        notify::ErrorKind::Io(error) => matches!(
            error.kind(),
            io::ErrorKind::NotFound
                | io::ErrorKind::NotADirectory
                | io::ErrorKind::PermissionDenied
        ),
        _ => false,
    }
}

/// What the system says, in words: it calls the limit on notices a full disk.
fn refused(error: &notify::Error) -> NoticesError {
    let is_limit = match &error.kind {
        notify::ErrorKind::MaxFilesWatch => true,
        notify::ErrorKind::Io(error) => error.kind() == io::ErrorKind::StorageFull,
        _ => false,
    };
    NoticesError::new(if is_limit {
        "the system's limit on watched folders is reached".to_owned()
    } else {
        error.to_string()
    })
}

fn lock(interests: &Mutex<Interests>) -> MutexGuard<'_, Interests> {
    // Whole whenever the lock is free: a panic between two changes loses notices at worst.
    interests.lock().unwrap_or_else(PoisonError::into_inner)
}
