//! The world on disk: files are replaced by a rename, so a reader sees the old one or the new one.

mod notices;

use super::again::Patience;
use super::sweep;
use super::unfinished::Unfinished;
use super::{Listed, Notices, NoticesError, PendingFile, Stamp, Wake, World, are_apart};
use notices::DiskNotices;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Most symbolic links on the way to a file: as many as Linux follows.
const LINKS: usize = 40;

/// The disk.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl World for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        require_regular(path)?;
        fs::read(path)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        require_regular(path)?;
        Ok(Box::new(File::open(path)?))
    }

    fn real_path(&self, path: &Path) -> io::Result<PathBuf> {
        match path.as_os_str().is_empty() {
            true => fs::canonicalize("."),
            false => fs::canonicalize(path),
        }
    }

    fn read_start(&self, path: &Path, length: usize) -> io::Result<Vec<u8>> {
        require_regular(path)?;
        let file = File::open(path)?;
        let there = usize::try_from(file.metadata()?.len()).unwrap_or(length);
        // Room for all, and for the read that finds the end.
        let mut bytes = Vec::with_capacity(there.min(length) + 32);
        file.take(length as u64).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn PendingFile>> {
        let real = behind_links(path)?;
        let folder = folder_of(&real).to_owned();
        if real != path {
            // Whoever sweeps the folder of the link does not come here.
            self.sweep(&folder);
        }
        start(real, &folder)
    }

    fn create_aside(&self, path: &Path, aside: &Path) -> io::Result<Box<dyn PendingFile>> {
        start(behind_links(path)?, aside)
    }

    fn sweep(&self, folder: &Path) {
        sweep::sweep(folder);
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<Listed>> {
        let mut listed = vec![];
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let Ok(metadata) = fs::metadata(entry.path()) else {
                // A link that leads nowhere, or a file that has just gone.
                continue;
            };
            if metadata.is_file() || metadata.is_dir() {
                let bytes = metadata.is_file().then_some(metadata.len());
                listed.push(Listed {
                    path: entry.path(),
                    bytes,
                    is_link: entry.file_type().is_ok_and(|it| it.is_symlink()),
                    modified: metadata.modified().ok(),
                });
            }
        }
        listed.sort();
        Ok(listed)
    }

    fn is_link(&self, path: &Path) -> bool {
        path.is_symlink()
    }

    fn touch(&self, path: &Path, after: Duration) -> io::Result<()> {
        let now = SystemTime::now();
        if !are_apart(fs::metadata(path)?.modified()?, now, after) {
            return Ok(());
        }
        // Some systems set times through a file that is open for writing only.
        File::options().write(true).open(path)?.set_modified(now)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        let is_folder = fs::symlink_metadata(path)?.is_dir();
        Patience::default().retry(|| {
            if is_folder {
                fs::remove_dir(path)
            } else {
                fs::remove_file(path)
            }
        })
    }

    fn stamp(&self, path: &Path) -> io::Result<Stamp> {
        Ok(Stamp::of(&fs::metadata(path)?))
    }

    fn notices(&self, wake: Wake) -> Result<Box<dyn Notices>, NoticesError> {
        Ok(Box::new(DiskNotices::new(wake)?))
    }
}

/// Starts the file that is to lie at `path`, which is no link, in the folder `aside`.
fn start(path: PathBuf, aside: &Path) -> io::Result<Box<dyn PendingFile>> {
    match fs::metadata(&path) {
        // A folder cannot be replaced, a device must not be, and who protects a file means it.
        Ok(there) if !there.is_file() => return Err(not_regular()),
        Ok(there) if there.permissions().readonly() => return Err(read_only()),
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    Ok(Box::new(Unfinished::new(path, aside)?))
}

/// Refuses folders, and what would never end, such as a FIFO or a device.
fn require_regular(path: &Path) -> io::Result<()> {
    if fs::metadata(path)?.is_file() {
        return Ok(());
    }
    Err(not_regular())
}

fn not_regular() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, "not a regular file")
}

fn read_only() -> io::Error {
    io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only")
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Where a file named `path` really lies: a rename would replace the link instead of its target.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        if !path.is_symlink() {
            return Ok(path);
        }
        path = folder_of(&path).join(fs::read_link(&path)?);
    }
    Err(io::Error::new(
        io::ErrorKind::InvalidInput,
        "too many symbolic links",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Seek;

    fn write(path: &Path, bytes: &[u8]) {
        let mut file = Disk.create(path).unwrap();
        file.write_all(bytes).unwrap();
        file.commit().unwrap();
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let name = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name().into_string();
        let mut names: Vec<String> = entries.map(|entry| name(entry).unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_only_when_it_is_committed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/map.png");
        let mut file = Disk.create(&path).unwrap();
        file.write_all(b"half").unwrap();
        file.rewind().unwrap();
        assert_eq!(io::read_to_string(&mut file).unwrap(), "half");
        assert!(!path.exists());
        drop(file);
        assert_eq!(names(&folder.path().join("new")), [""; 0]);
        write(&path, b"whole");
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(names(&folder.path().join("new")), ["map.png"]);
    }

    #[test]
    fn a_dropped_file_leaves_the_old_one_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.png");
        write(&path, b"old");
        let mut file = Disk.create(&path).unwrap();
        file.write_all(b"new").unwrap();
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["map.png"]);
    }

    #[test]
    fn only_the_asked_part_of_a_file_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.png");
        write(&path, b"abcdef");
        assert_eq!(Disk.read_start(&path, 3).unwrap(), b"abc");
        assert_eq!(Disk.read_start(&path, 9).unwrap(), b"abcdef");
        assert!(Disk.read_start(folder.path(), 3).is_err());
    }

    #[test]
    fn a_folder_is_listed_and_only_an_empty_one_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        write(&place("b"), b"four");
        write(&place("a/c"), b"");
        let listed = Disk.list(folder.path()).unwrap();
        let listed = listed.into_iter().map(|it| (it.path, it.bytes));
        let expected = [(place("a"), None), (place("b"), Some(4))];
        assert_eq!(listed.collect::<Vec<_>>(), expected);
        assert!(Disk.list(&place("b")).is_err());
        assert!(Disk.remove(&place("a")).is_err());
        for name in ["a/c", "a", "b"] {
            Disk.remove(&place(name)).unwrap();
        }
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[test]
    fn a_folder_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let error = Disk.create(folder.path()).err().unwrap();
        assert_eq!(error.to_string(), "not a regular file");
    }

    #[test]
    fn a_file_is_touched_only_if_its_time_is_far_away() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("entry");
        write(&path, b"entry");
        let hour = Duration::from_secs(3600);
        let now = SystemTime::now();
        let touched_from = |time: SystemTime| {
            let file = File::options().write(true).open(&path).unwrap();
            file.set_modified(time).unwrap();
            Disk.touch(&path, hour).unwrap();
            let [listed] = &Disk.list(folder.path()).unwrap()[..] else {
                panic!("one file was written")
            };
            listed.modified.unwrap() != time
        };
        assert!(!touched_from(now - hour / 2) && !touched_from(now + hour / 2));
        assert!(touched_from(now - 2 * hour) && touched_from(now + 2 * hour));
        assert!(Disk.touch(&folder.path().join("none"), hour).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn the_mode_of_a_replaced_file_is_kept_and_a_new_one_is_ordinary() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
        let [path, plain] = ["map.png", "plain"].map(|name| folder.path().join(name));
        write(&path, b"old");
        File::create(&plain).unwrap();
        assert_eq!(mode(&path), mode(&plain));
        fs::set_permissions(&path, fs::Permissions::from_mode(0o604)).unwrap();
        write(&path, b"new");
        assert_eq!(mode(&path), 0o604);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_stays_a_link() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::create_dir(place("real")).unwrap();
        symlink("real/map.png", place("first")).unwrap();
        symlink(place("first"), place("second")).unwrap();
        // The target does not exist yet, then it does.
        for bytes in [b"one", b"two"] {
            write(&place("second"), bytes);
            assert_eq!(fs::read(place("real/map.png")).unwrap(), bytes);
            assert!(Disk.is_link(&place("first")) && Disk.is_link(&place("second")));
            assert!(!Disk.is_link(&place("real/map.png")));
            let listed = Disk.list(folder.path()).unwrap();
            let links = listed.iter().map(|it| it.is_link);
            assert_eq!(links.collect::<Vec<_>>(), [true, false, true]);
        }
        symlink("loop", place("loop")).unwrap();
        let error = Disk.create(&place("loop")).err().unwrap();
        assert_eq!(error.to_string(), "too many symbolic links");
    }
}
