//! The command line: arguments, subcommands and exit codes.

mod bytes;
mod cache;
mod check;
mod completions;
mod kind_json;
mod listen;
mod man;
mod nodes;
mod options;
mod render;
mod report;
mod sample;
mod signals;
mod watch;
mod why;

use clap::{Args, Parser, Subcommand};
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
    3 a file could not be read or written, 4 a limit was reached, 129 the terminal has gone, 130 interrupted, 143 terminated";

#[derive(Subcommand)]
enum Command {
    /// Render the outputs of recipes into image files.
    Render(render::Arguments),
    /// Render recipes, and again whenever a file that they read has changed.
    Watch(watch::Arguments),
    /// Report everything that is wrong with recipes: builds their nodes, but evaluates and writes nothing.
    Check(check::Arguments),
    /// Explain what a render would do with a node or an output, and why.
    Why(why::Arguments),
    /// Print the values of a node's field at points from a CSV file.
    Sample(sample::Arguments),
    /// List the kinds of nodes, or describe one.
    Nodes(nodes::Arguments),
    /// Say what the store of earlier results holds, or remove it.
    Cache(cache::Arguments),
    /// Print a script that completes commands and options in a shell.
    Completions(completions::Arguments),
    /// Print the manual page of the program or of a command, in roff.
    Man(man::Arguments),
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Exit {
    Done = 0,
    NodeFailed = 1,
    Wrong = 2,
    Files = 3,
    Limit = 4,
    HungUp = 129,
    Interrupted = 130,
    Terminated = 143,
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
    /// Largest number of nodes with those inside compounds [default: 200000].
    #[arg(long, value_name = "NUMBER")]
    max_nodes: Option<usize>,
    /// Let recipes name files anywhere, and not only below their folders and assets.
    #[arg(long)]
    allow_outside: bool,
    /// Print events and diagnostics as JSON, one a line.
    #[arg(long)]
    json: bool,
}

impl RecipeArguments {
    fn settings(&self) -> yosegi::graph::Settings {
        yosegi::graph::Settings {
            set: self.set.clone(),
            seed: self.seed,
            largest_graph: self.max_nodes,
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
        Command::Watch(arguments) => watch::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Why(arguments) => why::run(&arguments),
        Command::Sample(arguments) => sample::run(&arguments),
        Command::Nodes(arguments) => nodes::run(&arguments),
        Command::Cache(arguments) => cache::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
        Command::Man(arguments) => man::run(&arguments),
    };
    ExitCode::from(report::at_the_end(exit) as u8)
}
