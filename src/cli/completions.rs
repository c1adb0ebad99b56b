//! `yosegi completions`: scripts that complete commands and options in a shell.

use super::{Exit, report};
use clap::CommandFactory;
use clap_complete::Shell;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The shell.
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    // Into memory first: the generator takes any failure to write for a fault of the program.
    let mut script = vec![];
    let mut command = super::Arguments::command();
    clap_complete::generate(arguments.shell, &mut command, "yosegi", &mut script);
    report::line(String::from_utf8_lossy(&script).trim_end());
    Exit::Done
}
