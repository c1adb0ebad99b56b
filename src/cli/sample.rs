//! `yosegi sample`: values of a node's field at points from a CSV file.

use super::listen::Listen;
use super::options::EngineArguments;
use super::{Exit, RecipeArguments, report};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use yosegi::engine::{Engine, Options, SampledField};
use yosegi::node::common_domain;
use yosegi::value::Domain;
use yosegi::world::Disk;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The recipe; it needs no outputs.
    recipe_path: PathBuf,
    /// A node, or one of its outputs or channels: `time`, `look.colour`, `board.height`.
    #[arg(long, value_name = "NAME")]
    node: String,
    /// Points in mm: CSV with the header x,y,z (in a solid) or u,v (on a plane).
    #[arg(long, value_name = "FILE.csv")]
    points: PathBuf,
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    engine: EngineArguments,
}

/// The points of a file, with the file's own words for them.
struct Points {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    places: Vec<[f64; 3]>,
}

pub(super) fn run(arguments: &Arguments) -> Exit {
    let json = arguments.recipe.json;
    let graph =
        match report::load_recipe(&arguments.recipe_path, &arguments.recipe.settings(), json) {
            Ok(graph) => graph,
            Err(exit) => return exit,
        };
    let engine = match engine(arguments) {
        Ok(engine) => engine,
        Err(problem) => {
            report::problem(&problem);
            return Exit::Wrong;
        }
    };
    // The table goes to stdout, so events do not.
    let listener = Listen::new(false);
    let fields = match engine.fields(&graph, &arguments.node, &listener) {
        Ok(fields) => fields,
        Err(error) => return report::run_error(&error, json),
    };
    match read_points(&arguments.points, &fields) {
        Ok(points) => print(&points, &fields, &engine),
        Err((exit, problem)) => {
            report::problem(&problem);
            exit
        }
    }
}

fn engine(arguments: &Arguments) -> Result<Engine, String> {
    let options = Options {
        threads: arguments.engine.threads.map(usize::from),
        level: arguments.engine.level()?,
        memory: 0,
        ..Options::default()
    };
    Engine::new(Arc::new(Disk), options).map_err(|error| format!("cannot start threads: {error}"))
}

fn read_points(path: &Path, fields: &[SampledField]) -> Result<Points, (Exit, String)> {
    let shown = path.display();
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|error| (Exit::Files, format!("cannot read `{shown}`: {error}")))?;
    let wrong = |problem: String| (Exit::Wrong, format!("{shown}: {problem}"));
    let header: Vec<String> = reader
        .headers()
        .map_err(|error| wrong(error.to_string()))?
        .iter()
        .map(str::to_owned)
        .collect();
    let expected = expected_header(fields, &header).map_err(wrong)?;
    let mut points = Points {
        header,
        rows: vec![],
        places: vec![],
    };
    for record in reader.records() {
        let record = record.map_err(|error| wrong(error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut place = [0.0; 3];
        for (axis, cell) in record.iter().enumerate().take(expected) {
            let number: Option<f64> = cell
                .parse()
                .ok()
                .filter(|it: &f64| (*it as f32).is_finite());
            place[axis] = number.ok_or_else(|| {
                wrong(format!(
                    "line {line}: expected a finite number, found `{cell}`"
                ))
            })?;
        }
        points.rows.push(record.iter().map(str::to_owned).collect());
        points.places.push(place);
    }
    Ok(points)
}

/// The number of coordinates, if the header fits the domain of the fields.
fn expected_header(fields: &[SampledField], header: &[String]) -> Result<usize, String> {
    let names: Vec<&str> = header.iter().map(String::as_str).collect();
    match (
        common_domain(fields.iter().map(|sampled| &sampled.field)),
        names.as_slice(),
    ) {
        (Domain::Solid | Domain::Everywhere, ["x", "y", "z"]) => Ok(3),
        (Domain::Plane | Domain::Everywhere, ["u", "v"]) => Ok(2),
        (Domain::Plane, found) => Err(format!(
            "the node is flat: expected the header u,v, found {}",
            found.join(",")
        )),
        (_, found) => Err(format!(
            "expected the header x,y,z, found {}",
            found.join(",")
        )),
    }
}

fn print(points: &Points, fields: &[SampledField], engine: &Engine) -> Exit {
    let values = engine.sample(fields, &points.places);
    let columns: Vec<&Vec<f32>> = values.iter().flatten().collect();
    let mut writer = csv::Writer::from_writer(std::io::stdout().lock());
    let names = fields.iter().flat_map(|sampled| &sampled.columns);
    let mut written = writer.write_record(points.header.iter().chain(names));
    for (index, row) in points.rows.iter().enumerate() {
        // The shortest decimal that reads back as the same 32-bit float.
        let numbers = columns.iter().map(|column| format!("{:?}", column[index]));
        written = written.and_then(|()| writer.write_record(row.iter().cloned().chain(numbers)));
    }
    match written.and_then(|()| writer.flush().map_err(csv::Error::from)) {
        // A reader that has seen enough is no failure.
        Err(error) if !is_closed_pipe(&error) => {
            report::problem(&format!("cannot write the result: {error}"));
            Exit::Files
        }
        _ => Exit::Done,
    }
}

fn is_closed_pipe(error: &csv::Error) -> bool {
    matches!(error.kind(), csv::ErrorKind::Io(error) if error.kind() == std::io::ErrorKind::BrokenPipe)
}
