//! `yosegi cache`: what the store of earlier results holds.

use super::options::default_store;
use super::{Exit, report};
use serde::Serialize;
use std::path::{Path, PathBuf};
use yosegi::engine::{StoreFamily, clean_store, store_status};
use yosegi::world::Disk;

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Count the entries of the store and their bytes.
    Status(Folder),
    /// Remove all entries of the store and nothing else; what was in them is computed again when needed.
    Clean(Folder),
}

#[derive(clap::Args)]
struct Folder {
    /// Folder of the store [default: yosegi in the user's cache folder].
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Status<'a> {
    folder: &'a Path,
    entries: usize,
    bytes: u64,
    families: &'a [StoreFamily],
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let (options, verb, result) = match &arguments.command {
        Command::Status(options) => (options, "holds", with(options, store_status)),
        Command::Clean(options) => (options, "is rid of", with(options, clean_store)),
    };
    match result {
        Ok((folder, families)) => {
            print(options, verb, &folder, &families);
            Exit::Done
        }
        Err((exit, problem)) => {
            report::problem(&problem);
            exit
        }
    }
}

type Families = std::io::Result<Vec<StoreFamily>>;

fn with(
    options: &Folder,
    act: fn(&dyn yosegi::world::World, &Path) -> Families,
) -> Result<(PathBuf, Vec<StoreFamily>), (Exit, String)> {
    let folder = options
        .cache
        .clone()
        .or_else(default_store)
        .ok_or_else(|| {
            let problem = "there is no cache folder for this user; name one with `--cache`";
            (Exit::Wrong, problem.to_owned())
        })?;
    match act(&Disk, &folder) {
        Ok(families) => Ok((folder, families)),
        Err(error) => Err((Exit::Files, format!("`{}`: {error}", folder.display()))),
    }
}

fn print(options: &Folder, verb: &str, folder: &Path, families: &[StoreFamily]) {
    let status = Status {
        folder,
        entries: families.iter().map(|family| family.entries).sum(),
        bytes: families.iter().map(|family| family.bytes).sum(),
        families,
    };
    if options.json {
        report::json(&status);
        return;
    }
    let folder = folder.display();
    let (entries, bytes) = (status.entries, size(status.bytes));
    report::line(&format!("{folder} {verb} {entries} entries, {bytes}"));
    for family in families {
        let StoreFamily {
            family,
            entries,
            bytes,
        } = family;
        report::line(&format!("  {family:10} {entries:>8}  {:>10}", size(*bytes)));
    }
}

/// A number of bytes, in a unit that fits it.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["KiB", "MiB", "GiB", "TiB"];
    let mut size = bytes as f64;
    let mut unit = "bytes";
    for larger in UNITS {
        if size < 1024.0 {
            break;
        }
        (size, unit) = (size / 1024.0, larger);
    }
    match unit {
        "bytes" => format!("{bytes} bytes"),
        _ => format!("{size:.1} {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_a_unit_that_fits() {
        let sizes = [0, 1023, 1024, 1536 << 10, 3 << 40].map(size);
        assert_eq!(
            sizes,
            ["0 bytes", "1023 bytes", "1.0 KiB", "1.5 MiB", "3.0 TiB"]
        );
    }
}
