//! Removes unfinished files that nobody writes any more.

use super::again::uninterrupted;
use super::unfinished::{PREFIX, SUFFIX};
use std::fs::{self, DirEntry, File, OpenOptions, TryLockError};
use std::io;
use std::path::Path;
use std::time::{Duration, SystemTime};

/// From this age on an unfinished file is abandoned where the file system has no locks.
const OLD: Duration = Duration::from_secs(24 * 60 * 60);

/// Removes the unfinished files in `folder` whose programs have ended. What cannot be looked at stays.
pub(super) fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    entries.flatten().filter(is_unfinished).for_each(|entry| {
        remove_if_abandoned(&entry.path());
    });
}

/// Only regular files: others would be harmed by the look alone.
fn is_unfinished(entry: &DirEntry) -> bool {
    let name = entry.file_name();
    let has_name = name
        .to_str()
        .is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
    has_name && entry.file_type().is_ok_and(|kind| kind.is_file())
}

fn remove_if_abandoned(path: &Path) {
    // The lock is held until the file is gone: a program that has just made it finds that out.
    let lock = open(path).map(|file| (file.try_lock(), file));
    let is_abandoned = match &lock {
        Ok((Ok(()), _)) => true,
        Ok((Err(TryLockError::WouldBlock), _)) => false,
        Ok((Err(TryLockError::Error(_)), _)) | Err(_) => is_old(path),
    };
    if is_abandoned {
        // Another sweep may have been quicker.
        let _ = uninterrupted(|| fs::remove_file(path));
    }
}

/// Some file systems lock only what is open for writing, and some files can only be read.
fn open(path: &Path) -> io::Result<File> {
    let both = OpenOptions::new().read(true).write(true).open(path);
    both.or_else(|_| File::open(path))
}

fn is_old(path: &Path) -> bool {
    let changed = fs::symlink_metadata(path).and_then(|file| file.modified());
    let age = changed.map(|changed| SystemTime::now().duration_since(changed));
    // A time in the future tells nothing.
    matches!(age, Ok(Ok(age)) if age > OLD)
}

#[cfg(test)]
mod tests {
    use super::super::PendingFile;
    use super::super::unfinished::Unfinished;
    use super::*;
    use std::io::Write;
    use std::path::PathBuf;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;

    /// An unfinished file as a program that was killed leaves it.
    fn abandoned(folder: &Path, name: &str) -> PathBuf {
        let path = folder.join(format!("{PREFIX}{name}{SUFFIX}"));
        fs::write(&path, "half").unwrap();
        path
    }

    fn count(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn what_nobody_writes_is_swept_and_what_is_written_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.png");
        let mut file = Unfinished::new(path.clone(), folder.path()).unwrap();
        file.write_all(b"whole").unwrap();
        let left = abandoned(folder.path(), "left");
        sweep(folder.path());
        assert!(!left.exists());
        assert_eq!(count(folder.path()), 1);
        Box::new(file).commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        sweep(folder.path());
        assert_eq!(count(folder.path()), 1);
    }

    #[test]
    fn only_what_is_named_as_ours_is_swept() {
        let folder = tempfile::tempdir().unwrap();
        for name in [".yosegi-x", "a.part", ".yosegi.part", "yosegi-a.part"] {
            fs::write(folder.path().join(name), "of others").unwrap();
        }
        fs::create_dir(folder.path().join(".yosegi-folder.part")).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink("a.part", folder.path().join(".yosegi-link.part")).unwrap();
        let before = count(folder.path());
        sweep(folder.path());
        assert_eq!(count(folder.path()), before);
        sweep(&folder.path().join("missing"));
    }

    #[test]
    fn age_tells_where_locks_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = abandoned(folder.path(), "a");
        let file = File::options().write(true).open(&path).unwrap();
        let hour = Duration::from_secs(60 * 60);
        let now = SystemTime::now();
        for (changed, expected) in [
            (now - 23 * hour, false),
            (now - 25 * hour, true),
            (now + 48 * hour, false),
        ] {
            file.set_modified(changed).unwrap();
            assert_eq!(is_old(&path), expected);
        }
    }

    /// Sweeps run all the time while files are made and put in place: every one arrives.
    #[test]
    fn a_sweep_never_takes_a_file_that_is_being_made() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: usize| folder.path().join(name.to_string());
        let is_done = AtomicBool::new(false);
        thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| {
                    while !is_done.load(Ordering::Relaxed) {
                        sweep(folder.path());
                    }
                });
            }
            for name in 0..2000 {
                let file = Unfinished::new(place(name % 10), folder.path()).unwrap();
                Box::new(file).commit().unwrap();
            }
            is_done.store(true, Ordering::Relaxed);
        });
        assert_eq!(count(folder.path()), 10);
    }
}
