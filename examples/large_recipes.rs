//! Writes recipes that no person would write, loads them, renders them, and says what that took.
//!
//! ```sh
//! cargo run --release --example large_recipes -- chain 100000
//! cargo run --release --example large_recipes -- fan 100000
//! cargo run --release --example large_recipes -- links 1000000
//! cargo run --release --example large_recipes -- ladder 60
//! ```
//!
//! A chain has nodes that each read the one before, a fan one node that reads all others, links are a million
//! between few nodes, and a ladder has two ways at every step, 2^60 in all.

use std::error::Error;
use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;
use yosegi::diagnostics::render_all;
use yosegi::engine::{Cancel, Engine, Options, Render};
use yosegi::graph::{Settings, load_text};
use yosegi::world::Memory;

const END: &str = "
    \"wood\": material(base_color: \"last\"),
    \"board\": slice_cut(of: \"wood\", cut: end_grain, origin: (0, 0, 0), size: (4, 4)),
}, outputs: { \"board\": maps(of: \"board\", pixels: (4, 4)) })";

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let shape = words.next().unwrap_or_else(|| "chain".to_owned());
    let size: usize = words.next().as_deref().unwrap_or("100000").parse()?;
    let text = match shape.as_str() {
        "chain" => chain(size)?,
        "fan" => fan(size)?,
        "links" => links(size)?,
        "ladder" => ladder(size)?,
        other => return Err(format!("there is no shape `{other}`").into()),
    };
    println!("{shape} of {size}: {} bytes", text.len());
    let start = Instant::now();
    let loaded = load_text("large.ron", text, &Settings::default());
    let graph = loaded.map_err(|errors| render_all(&errors))?.graph;
    let (nodes, edges) = (graph.nodes.node_count(), graph.nodes.edge_count());
    println!("loaded {nodes} nodes, {edges} links: {}", taken(start));
    let start = Instant::now();
    let engine = Engine::new(Arc::new(Memory::default()), Options::default())?;
    let result = engine.render(&Render {
        graph: &graph,
        folder: "out".into(),
        only: vec![],
        pixels: None,
        listener: &|_| {},
        cancel: Cancel::new(),
    });
    match result {
        Ok(_) => println!("rendered: {}", taken(start)),
        Err(error) => println!(
            "refused: {}\n{}",
            taken(start),
            render_all(error.diagnostics())
        ),
    }
    Ok(())
}

/// Seconds since `start`, and the most memory that the process has had where the system tells.
fn taken(start: Instant) -> String {
    let seconds = start.elapsed().as_secs_f64();
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    format!(
        "{seconds:.2} s, peak memory {}",
        peak.unwrap_or("unknown").trim()
    )
}

/// Each node mixes a little into the one before.
fn chain(length: usize) -> Result<String, std::fmt::Error> {
    let mut text =
        String::from("(nodes: {\n    \"n0\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: 0.5),\n");
    for index in 1..length {
        let before = index - 1;
        writeln!(
            text,
            "    \"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: 0.01),"
        )?;
    }
    let last = length - 1;
    write!(
        text,
        "    \"last\": mix(a: \"n{last}\", b: \"#000000\", amount: 0),{END}"
    )?;
    Ok(text)
}

/// One material has a channel for every node.
fn fan(width: usize) -> Result<String, std::fmt::Error> {
    let mut text = String::from("(nodes: {\n");
    for index in 0..width {
        writeln!(
            text,
            "    \"n{index}\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: 0.5),"
        )?;
    }
    text += "    \"last\": mix(a: \"n0\", b: \"n1\", amount: 0.5),\n    \"all\": material(base_color: \"last\", extras: {";
    for index in 0..width {
        write!(text, "\"c{index}\": \"n{index}\",")?;
    }
    text += "}),";
    Ok(text + &END.replace("of: \"wood\"", "of: \"all\""))
}

/// Materials whose channels all lead to the same few nodes.
fn links(count: usize) -> Result<String, std::fmt::Error> {
    let mut text =
        String::from("(nodes: {\"last\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: 0.5),\n");
    for material in 0..count.div_ceil(1000) {
        write!(
            text,
            "\"m{material}\": material(base_color: \"last\", extras: {{"
        )?;
        for index in 0..count.min(1000) {
            write!(text, "\"c{index}\":\"last\",")?;
        }
        text += "}),\n";
    }
    Ok(text + &END.replace("of: \"wood\"", "of: \"m0\""))
}

/// Each node reads the one before twice.
fn ladder(length: usize) -> Result<String, std::fmt::Error> {
    let mut text = String::from("(nodes: {\n    \"n0\": solid_noise(size: (5, 5, 5)),\n");
    for index in 1..=length {
        let before = match index {
            1 => "n0.value".to_owned(),
            _ => format!("luminance(n{}.colour)", index - 1),
        };
        writeln!(
            text,
            "    \"n{index}\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"= 0.5 * {before} + 0.5 * {before}\"),"
        )?;
    }
    write!(
        text,
        "    \"last\": mix(a: \"n{length}\", b: \"#000000\", amount: 0),{END}"
    )?;
    Ok(text)
}
