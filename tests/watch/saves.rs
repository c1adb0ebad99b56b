//! The ways in which programs save a file.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// A way of saving.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// Open, truncate, write: most small editors.
    InPlace,
    /// The same, with the file empty for a while: VS Code on a slow disk.
    EmptyFirst,
    /// In three pieces with pauses.
    Pieces,
    /// A new file beside it, renamed over it.
    Rename,
    /// The old file renamed to a backup, a new one in its place: Vim.
    Backup,
    /// A new file beside it, the old one renamed away, the new one renamed to its place: IntelliJ.
    TwoRenames,
    /// Deleted, and made again after a while.
    DeleteAndCreate,
    /// A hard link to a new file, renamed over it.
    HardLink,
    /// `sed -i`.
    Sed,
}

impl Style {
    pub(crate) const ALL: [Style; 9] = [
        Style::InPlace,
        Style::EmptyFirst,
        Style::Pieces,
        Style::Rename,
        Style::Backup,
        Style::TwoRenames,
        Style::DeleteAndCreate,
        Style::HardLink,
        Style::Sed,
    ];

    /// Saves `text` at `path`; with pauses of this length where the style has any.
    pub(crate) fn save(self, path: &Path, text: &str, pause: Duration) {
        let wait = || std::thread::sleep(pause);
        let beside = |ending: &str| {
            let name = path.file_name().unwrap().to_str().unwrap();
            path.with_file_name(format!("{name}{ending}"))
        };
        match self {
            Style::InPlace => fs::write(path, text).unwrap(),
            Style::EmptyFirst => {
                fs::write(path, "").unwrap();
                wait();
                fs::write(path, text).unwrap();
            }
            Style::Pieces => in_pieces(path, text, pause),
            Style::Rename => {
                fs::write(beside(".tmp"), text).unwrap();
                fs::rename(beside(".tmp"), path).unwrap();
            }
            Style::Backup => {
                fs::rename(path, beside("~")).unwrap();
                fs::write(path, text).unwrap();
                fs::remove_file(beside("~")).unwrap();
            }
            Style::TwoRenames => {
                fs::write(beside("___jb_tmp___"), text).unwrap();
                fs::rename(path, beside("___jb_old___")).unwrap();
                fs::rename(beside("___jb_tmp___"), path).unwrap();
                fs::remove_file(beside("___jb_old___")).unwrap();
            }
            Style::DeleteAndCreate => {
                fs::remove_file(path).unwrap();
                wait();
                fs::write(path, text).unwrap();
            }
            Style::HardLink => {
                fs::write(beside(".new"), text).unwrap();
                fs::hard_link(beside(".new"), beside(".link")).unwrap();
                fs::rename(beside(".link"), path).unwrap();
                fs::remove_file(beside(".new")).unwrap();
            }
            Style::Sed => sed(path, text),
        }
    }
}

fn in_pieces(path: &Path, text: &str, pause: Duration) {
    let mut file = fs::File::create(path).unwrap();
    let third = text.len() / 3;
    for (index, piece) in [&text[..third], &text[third..2 * third], &text[2 * third..]]
        .into_iter()
        .enumerate()
    {
        if index > 0 {
            std::thread::sleep(pause);
        }
        file.write_all(piece.as_bytes()).unwrap();
        file.flush().unwrap();
    }
}

/// Replaces everything from the first line on by the lines of `text`, as `sed -i` does.
fn sed(path: &Path, text: &str) {
    let mut script = tempfile::NamedTempFile::new().unwrap();
    let lines: Vec<String> = text
        .lines()
        .map(|line| line.replace('\\', "\\\\"))
        .collect();
    let lines = lines.join("\\\n");
    write!(script, "1c\\\n{lines}\n2,$d\n").unwrap();
    let done = Command::new("sed")
        .arg("-i")
        .arg("-f")
        .arg(script.path())
        .arg(path)
        .status();
    // Systems without it save in the same way otherwise.
    if !done.is_ok_and(|status| status.success()) {
        Style::Rename.save(path, text, Duration::ZERO);
    }
}

/// Where the recipe lies, and the maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Situation {
    /// In a folder of its own.
    Plain,
    /// In a folder that is reached through a link.
    FolderLink,
    /// The recipe is a link to a file elsewhere, which is what is saved.
    FileLink,
    /// The maps are written into the recipe's own folder.
    OutputsBeside,
}

impl Situation {
    pub(crate) const ALL: [Situation; 4] = [
        Situation::Plain,
        Situation::FolderLink,
        Situation::FileLink,
        Situation::OutputsBeside,
    ];

    /// The recipe as it is followed, below the desk's folder.
    pub(crate) fn recipe(self) -> PathBuf {
        match self {
            Situation::FolderLink => "link/recipe.ron".into(),
            _ => "work/recipe.ron".into(),
        }
    }

    /// The file that is saved, below the desk's folder.
    pub(crate) fn saved(self) -> PathBuf {
        match self {
            Situation::FileLink => "elsewhere/real.ron".into(),
            _ => "work/recipe.ron".into(),
        }
    }

    /// Where the maps go, below the desk's folder.
    pub(crate) fn output(self) -> &'static str {
        match self {
            Situation::OutputsBeside => "work",
            _ => "out",
        }
    }

    /// Lays out the folders, with `text` as the recipe.
    pub(crate) fn lay(self, folder: &Path, text: &str) {
        for name in ["work", "elsewhere"] {
            fs::create_dir(folder.join(name)).unwrap();
        }
        fs::write(folder.join(self.saved()), text).unwrap();
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            match self {
                Situation::FolderLink => symlink("work", folder.join("link")).unwrap(),
                Situation::FileLink => {
                    let link = folder.join("work/recipe.ron");
                    symlink("../elsewhere/real.ron", link).unwrap();
                }
                _ => {}
            }
        }
    }
}
