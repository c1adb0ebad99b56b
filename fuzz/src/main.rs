//! Feeds mutated recipes to the reader and to the editor, the same ones on every machine.
//!
//! ```sh
//! cargo run --release --manifest-path fuzz/Cargo.toml -- reader --executions 10000000
//! ```
//!
//! A text that makes a target panic is made as short as possible and written into `fuzz/found`. Texts are
//! numbered, so `--first N --executions 1` repeats one.

// The tests of the project run a little of the same.
#[path = "../../tests/fuzz/mutate.rs"]
mod mutate;
#[path = "../../tests/fuzz/targets.rs"]
mod targets;

use mutate::{Corpus, Random};
use std::fs;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use targets::{TARGETS, Target};

/// Folders of recipes to begin with, beside this crate.
const FOLDERS: [&str; 3] = ["graphs", "tests/diagnostics", "docs"];
/// Longest text to begin with: most of what is read is small, so that many are.
const LONGEST: usize = 4000;

struct Arguments {
    name: String,
    target: Target,
    executions: u64,
    first: u64,
}

fn main() -> ExitCode {
    let arguments = match arguments() {
        Ok(arguments) => arguments,
        Err(problem) => {
            eprintln!("{problem}");
            eprintln!("usage: yosegi-fuzz reader|edit [--executions N] [--first N]");
            return ExitCode::from(2);
        }
    };
    let texts = match corpus() {
        Ok(texts) => texts,
        Err(error) => {
            eprintln!("the recipes cannot be read: {error}");
            return ExitCode::from(3);
        }
    };
    let corpus = Corpus::new(texts.iter().map(String::as_str));
    panic::set_hook(Box::new(|_| {}));
    run(&arguments, &corpus, texts.len())
}

fn arguments() -> Result<Arguments, String> {
    let mut words = std::env::args().skip(1);
    let name = words.next().ok_or("which target?")?;
    let found = TARGETS.iter().find(|(known, _)| *known == name);
    let (_, target) = found.ok_or(format!("there is no target `{name}`"))?;
    let mut arguments = Arguments {
        name,
        target: *target,
        executions: 1_000_000,
        first: 0,
    };
    while let Some(word) = words.next() {
        let number = words.next().and_then(|word| word.parse().ok());
        let number = number.ok_or(format!("`{word}` needs a whole number"))?;
        match word.as_str() {
            "--executions" => arguments.executions = number,
            "--first" => arguments.first = number,
            _ => return Err(format!("there is no option `{word}`")),
        }
    }
    Ok(arguments)
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Recipes that are short enough, sorted by path.
fn corpus() -> std::io::Result<Vec<String>> {
    let mut paths: Vec<PathBuf> = vec![];
    for folder in FOLDERS {
        for entry in fs::read_dir(root().join("..").join(folder))? {
            paths.push(entry?.path());
        }
    }
    paths.retain(|path| path.extension().is_some_and(|found| found == "ron"));
    paths.sort();
    let texts = paths
        .iter()
        .filter_map(|path| fs::read_to_string(path).ok());
    Ok(texts.filter(|text| text.len() <= LONGEST).collect())
}

fn run(arguments: &Arguments, corpus: &Corpus, size: usize) -> ExitCode {
    let start = Instant::now();
    let mut accepted = 0_u64;
    let (mut panics, mut slowest, mut slow_text) = (0_u64, Duration::ZERO, String::new());
    for number in arguments.first..arguments.first + arguments.executions {
        let mut random = Random::new(number);
        let text = corpus.text(&mut random);
        let before = Instant::now();
        let result = accepts(arguments.target, &text, number);
        accepted += u64::from(result == Some(true));
        if before.elapsed() > slowest {
            (slowest, slow_text) = (before.elapsed(), text.clone());
        }
        if result.is_none() {
            panics += 1;
            report(arguments, number, &text);
            if panics >= 20 {
                break;
            }
        }
        let done = number - arguments.first + 1;
        if done.is_power_of_two() || done % 1_000_000 == 0 {
            let rate = done as f64 / start.elapsed().as_secs_f64();
            println!(
                "{}: {done} executions, {rate:.0} a second, {panics} panics",
                arguments.name
            );
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{}: {} executions from {size} recipes in {seconds:.1} s, {:.0} a second, {panics} panics, {accepted} accepted; slowest {:.2} ms of {} \
         bytes{}",
        arguments.name,
        arguments.executions,
        arguments.executions as f64 / seconds,
        slowest.as_secs_f64() * 1e3,
        slow_text.len(),
        peak_memory().unwrap_or_default(),
    );
    ExitCode::from(u8::from(panics > 0))
}

fn survives(target: Target, text: &str, number: u64) -> bool {
    accepts(target, text, number).is_some()
}

/// Whether the text is accepted; `None` if the target panics.
fn accepts(target: Target, text: &str, number: u64) -> Option<bool> {
    panic::catch_unwind(AssertUnwindSafe(|| target(text, number))).ok()
}

/// Writes the shortest text found that still panics, with the message.
fn report(arguments: &Arguments, number: u64, text: &str) {
    let shortest = shortened(text, |text| !survives(arguments.target, text, number));
    let caught = panic::catch_unwind(AssertUnwindSafe(|| (arguments.target)(&shortest, number)));
    let message = match caught.err().map(|panic| panic.downcast::<String>()) {
        Some(Ok(message)) => *message,
        Some(Err(panic)) => panic
            .downcast_ref::<&str>()
            .copied()
            .unwrap_or("")
            .to_owned(),
        None => String::new(),
    };
    let folder = root().join("found");
    let path = folder.join(format!("{}-{number}.ron", arguments.name));
    println!(
        "{} number {number} panics: {message}\n{shortest}",
        arguments.name
    );
    if let Err(error) = fs::create_dir_all(&folder).and_then(|()| fs::write(&path, &shortest)) {
        println!("{} cannot be written: {error}", path.display());
    }
}

/// Takes away halves, quarters and so on of a text as long as it stays wrong.
fn shortened(text: &str, is_wrong: impl Fn(&str) -> bool) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    let mut length = letters.len().next_power_of_two();
    while length > 0 {
        let mut start = 0;
        while start < letters.len() {
            let end = (start + length).min(letters.len());
            let rest: String = letters[..start].iter().chain(&letters[end..]).collect();
            if is_wrong(&rest) {
                letters.drain(start..end);
            } else {
                start += length;
            }
        }
        length /= 2;
    }
    letters.into_iter().collect()
}

/// The most memory that the process has had, where the system tells.
fn peak_memory() -> Option<String> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(format!("; peak memory {}", line["VmHWM:".len()..].trim()))
}
