//! `yosegi cache`: what the store of earlier results holds.

use super::options::{LimitArguments, default_store};
use super::{Exit, bytes, report};
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
    Status(Status),
    /// Remove all entries of the store and nothing else; what was in them is computed again when needed.
    Clean(Folder),
}

#[derive(clap::Args)]
struct Status {
    #[command(flatten)]
    folder: Folder,
    #[command(flatten)]
    limit: LimitArguments,
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
struct Counted<'a> {
    folder: &'a Path,
    entries: usize,
    bytes: u64,
    /// Most bytes that the store may take; of `status` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<u64>,
    /// For how long the entry used longest ago has not been used.
    oldest_seconds: Option<u64>,
    families: &'a [StoreFamily],
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let (options, limit, result) = match &arguments.command {
        Command::Status(Status { folder, limit }) => {
            (folder, Some(limit.bytes), with(folder, store_status))
        }
        Command::Clean(folder) => (folder, None, with(folder, clean_store)),
    };
    match result {
        Ok((folder, families)) => {
            print(options, limit, &folder, &families);
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

fn print(options: &Folder, limit: Option<u64>, folder: &Path, families: &[StoreFamily]) {
    let counted = Counted {
        folder,
        entries: families.iter().map(|family| family.entries).sum(),
        bytes: families.iter().map(|family| family.bytes).sum(),
        limit,
        oldest_seconds: families.iter().filter_map(|it| it.oldest_seconds).max(),
        families,
    };
    if options.json {
        report::json(&counted);
    } else {
        print_text(&counted);
    }
}

fn print_text(counted: &Counted<'_>) {
    let verb = counted.limit.map_or("is rid of", |_| "holds");
    let most = counted
        .limit
        .map(|limit| format!(" of at most {}", bytes::shown(limit)));
    let oldest = counted.oldest_seconds;
    let oldest = oldest.map(|it| format!(", the oldest last used {} ago", age(it)));
    report::line(&format!(
        "{} {verb} {} entries, {}{}{}",
        counted.folder.display(),
        counted.entries,
        bytes::shown(counted.bytes),
        most.unwrap_or_default(),
        oldest.unwrap_or_default()
    ));
    for family in counted.families {
        let (name, entries) = (family.family, family.entries);
        let bytes = bytes::shown(family.bytes);
        report::line(&format!("  {name:10} {entries:>8}  {bytes:>10}"));
    }
}

/// A time in the largest unit that it holds twice.
fn age(seconds: u64) -> String {
    match seconds {
        0..120 => format!("{seconds} s"),
        120..7200 => format!("{} min", seconds / 60),
        7200..172_800 => format!("{} h", seconds / 3600),
        _ => format!("{} days", seconds / 86_400),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ages_have_a_unit_that_fits() {
        let ages = [0, 119, 120, 7199, 7200, 172_800].map(age);
        assert_eq!(ages, ["0 s", "119 s", "2 min", "119 min", "2 h", "2 days"]);
    }
}
