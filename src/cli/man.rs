//! `yosegi man`: manual pages.

use super::{Exit, report};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use yosegi::diagnostics::nearest;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The command to describe, for example `render` or `cache clean`; without it the program.
    command: Vec<String>,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let mut program = super::Arguments::command();
    program.build();
    let mut command = &program;
    for name in &arguments.command {
        let Some(found) = command.find_subcommand(name) else {
            report::problem(&no_command(command, name));
            return Exit::Wrong;
        };
        command = found;
    }
    let mut page = vec![];
    if let Err(error) = Man::new(command.clone()).render(&mut page) {
        report::problem(&format!("cannot make the page: {error}"));
        return Exit::Files;
    }
    report::line(String::from_utf8_lossy(&page).trim_end());
    Exit::Done
}

fn no_command(of: &Command, name: &str) -> String {
    let names: Vec<&str> = of.get_subcommands().map(Command::get_name).collect();
    match nearest(name, names.iter().copied()).first() {
        Some(near) => format!("there is no command `{name}`; did you mean `{near}`?"),
        None => format!("there is no command `{name}`"),
    }
}
