//! The command line: arguments, subcommands and exit codes.

mod check;
mod nodes;
mod render;
mod report;
mod sample;

use clap::{Args, Parser, Subcommand, ValueEnum};
use fearless_simd::Level;
use std::path::PathBuf;
use std::process::ExitCode;

/// Turns text recipes into the maps of materials.
#[derive(Parser)]
#[command(name = "yosegi", version, about, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 a node failed, 2 the recipe or the call is wrong, \
    3 a file could not be read or written, 4 a limit was reached, 130 interrupted";

#[derive(Subcommand)]
enum Command {
    /// Render the outputs of recipes into image files.
    Render(render::Arguments),
    /// Report everything that is wrong with recipes, without rendering.
    Check(check::Arguments),
    /// Print the values of a node's field at points from a CSV file.
    Sample(sample::Arguments),
    /// List the kinds of nodes, or describe one.
    Nodes(nodes::Arguments),
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Exit {
    Done = 0,
    NodeFailed = 1,
    Wrong = 2,
    Files = 3,
    Limit = 4,
    Interrupted = 130,
}

/// Changes to a recipe's parameters.
#[derive(Args)]
struct RecipeArguments {
    /// Set a parameter: `--set ring_width=1.8`.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parse_setting)]
    set: Vec<(String, String)>,
    /// Seed of every random stream, instead of the recipe's own.
    #[arg(long)]
    seed: Option<u64>,
    /// Let recipes name files anywhere, and not only below their folders and assets.
    #[arg(long)]
    allow_outside: bool,
    /// Print events and diagnostics as JSON, one a line.
    #[arg(long)]
    json: bool,
}

/// What the engine may use.
#[derive(Args)]
struct EngineArguments {
    /// Number of threads [default: all processors].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Vector instructions to use, at most; the result is the same.
    #[arg(long)]
    simd: Option<Simd>,
}

/// Levels of vector instructions.
#[derive(Clone, Copy, ValueEnum)]
enum Simd {
    Baseline,
    #[value(name = "sse4.2")]
    Sse42,
    Avx2,
    Avx512,
}

impl EngineArguments {
    /// The level to use.
    ///
    /// # Errors
    /// If this machine does not have it.
    fn level(&self) -> Result<Option<Level>, String> {
        let Some(simd) = self.simd else {
            return Ok(None);
        };
        simd.level().map(Some).ok_or_else(|| {
            let name = simd
                .to_possible_value()
                .map(|value| value.get_name().to_owned());
            format!(
                "this machine has no {}; leave `--simd` out",
                name.unwrap_or_default()
            )
        })
    }
}

impl Simd {
    #[cfg(target_arch = "x86_64")]
    fn level(self) -> Option<Level> {
        let best = Level::new();
        match self {
            Simd::Baseline => Some(Level::baseline()),
            Simd::Sse42 => best.as_sse4_2().map(Level::Sse4_2),
            Simd::Avx2 => best.as_avx2().map(Level::Avx2),
            Simd::Avx512 => best.as_avx512().map(Level::Avx512),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn level(self) -> Option<Level> {
        matches!(self, Simd::Baseline).then(Level::baseline)
    }
}

impl RecipeArguments {
    fn settings(&self) -> yosegi::graph::Settings {
        yosegi::graph::Settings {
            set: self.set.clone(),
            seed: self.seed,
            allow_outside: self.allow_outside,
        }
    }
}

fn parse_setting(text: &str) -> Result<(String, String), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("expected NAME=VALUE, for example ring_width=1.8")?;
    Ok((name.trim_start_matches('$').to_owned(), value.to_owned()))
}

/// The recipes of a call.
#[derive(Args)]
struct Recipes {
    /// Recipe files.
    #[arg(required = true, value_name = "RECIPE")]
    recipes: Vec<PathBuf>,
}

/// Runs the program.
pub(crate) fn main() -> ExitCode {
    let exit = match Arguments::parse().command {
        Command::Render(arguments) => render::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Sample(arguments) => sample::run(&arguments),
        Command::Nodes(arguments) => nodes::run(&arguments),
    };
    ExitCode::from(exit as u8)
}
