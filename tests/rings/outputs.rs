//! A ring series as a table and as a plot: what is in them, and that they are outputs like any other.

use super::workshop::Workshop;
use super::*;
use fearless_simd::Level;
use yosegi::field::{Program, RunContext, Samples, Scratch};
use yosegi::nodes::output::ring_table;
use yosegi::nodes::rings::growth_model::statistics::detrended;
use yosegi::nodes::rings::ring_plot;

const RECIPE: &str = "(nodes: {
    \"oxford\": weather(file: \"weather/oxforddata.txt\", to: 2020),
    \"rings\": growth_model(climate: \"oxford\", ring_width: 2),
    \"plot\": ring_plot(of: \"rings\"),
}, outputs: {
    \"tree\": ring_table(of: \"rings\"),
    \"plot\": maps(of: \"plot\", pixels_per_mm: 1),
})";

fn series() -> Arc<RingSeries> {
    grown(&oxford(), 0, &[]).unwrap()
}

#[test]
fn a_table_has_a_row_for_each_year_with_every_digit() {
    let series = series();
    let given = vec![("of", Value::RingSeries(Arc::clone(&series)))];
    let Value::Table(table) = built(&ring_table::KIND, 0, given).unwrap() else {
        panic!("a table")
    };
    let mut lines = table.text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let column = |name: &str| -> Vec<f64> {
        let index = header.iter().position(|it| *it == name).unwrap();
        rows.iter().map(|row| row[index]).collect()
    };
    let years: Vec<f64> = (1853..=2020).map(f64::from).collect();
    assert_eq!(column("year"), years);
    assert_eq!(column("age")[167], 168.0);
    assert_eq!(column("area_mm2"), series.areas);
    assert_eq!(column("ring_width_mm"), series.widths());
    assert_eq!(column("index"), detrended(&series.widths()));
    assert_eq!(column("radius_mm"), series.radii().collect::<Vec<f64>>());
    assert!(
        column("height_m")
            .iter()
            .zip(&series.heights)
            .all(|(m, mm)| *m == mm / 1000.0)
    );
    let sum: f64 = column("area_increment_mm2").iter().sum();
    assert!((sum / series.areas[167] - 1.0).abs() < 1e-12);
}

#[test]
fn a_table_is_written_kept_restored_and_written_again() {
    let store = Options {
        store: Some("cache".into()),
        ..Options::default()
    };
    let workshop = Workshop::new("recipes", store.clone());
    let log = workshop.run(RECIPE);
    assert!(
        log.contains("written tree.csv") && log.contains("written plot_base_color.png"),
        "{log}"
    );
    let text = workshop.map("tree.csv");
    assert!(text.starts_with(b"year,age,ring_width_mm") && text.ends_with(b"\n"));
    let log = workshop.another(store.clone()).run(RECIPE);
    assert!(
        log.contains("up to date tree.csv") && !log.contains("written"),
        "{log}"
    );
    // Someone has saved it from a spreadsheet.
    workshop
        .files
        .insert("recipes/out/tree.csv", b"year;age\n".to_vec());
    let log = workshop.another(store.clone()).run(RECIPE);
    assert!(log.contains("restored tree.csv"), "{log}");
    assert_eq!(workshop.map("tree.csv"), text);
    let log = workshop
        .another(store)
        .run(&RECIPE.replace("ring_width: 2", "ring_width: 3"));
    assert!(log.contains("written tree.csv"), "{log}");
    assert_ne!(workshop.map("tree.csv"), text);
    // A run that has no store writes it as well.
    assert!(
        workshop
            .another(Options::default())
            .run(RECIPE)
            .contains("written tree.csv")
    );
    assert_eq!(workshop.map("tree.csv"), text);
}

#[test]
fn a_table_replaces_nothing_that_is_read() {
    let workshop = Workshop::new("recipes", Options::default());
    workshop.files.insert(
        "recipes/out/tree.csv",
        project_file("assets/weather/oxforddata.txt"),
    );
    let recipe = RECIPE.replace("weather/oxforddata.txt", "out/tree.csv");
    let run = workshop.render(&recipe, &["tree"], Cancel::new(), &|_| {});
    let told = yosegi::diagnostics::render_all(run.result.unwrap_err().diagnostics());
    assert!(
        told.contains("would replace the recipe or a file that it reads"),
        "{told}"
    );
}

#[test]
fn a_table_has_no_small_picture_and_is_told_as_planned() {
    let store = Options {
        store: Some("cache".into()),
        ..Options::default()
    };
    let workshop = Workshop::new("recipes", store.clone());
    let graph = workshop.graph(RECIPE);
    let request = Render {
        graph: &graph,
        folder: "recipes/out".into(),
        only: vec![],
        pixels: None,
        listener: &|_| {},
        cancel: Cancel::new(),
    };
    let inputs: Arc<dyn yosegi::world::World> = Arc::new(workshop.files.clone());
    let time = std::time::Duration::from_secs(1);
    let pictures = workshop.engine.preview(&request, &inputs, time).unwrap();
    assert_eq!(pictures, [Path::new("recipes/out/plot.preview.png")]);
    workshop.engine.check(&request).unwrap();
    // Made again and compared with the store, the table is the same.
    workshop.run(RECIPE);
    let verifying = Options {
        verify: true,
        ..store
    };
    let log = workshop.another(verifying).run(RECIPE);
    assert!(
        log.contains("written tree.csv") && log.contains("compared"),
        "{log}"
    );
}

/// The brightness of the plot's red at points, each a pixel of its own.
fn red(series: &Arc<RingSeries>, points: &[[f64; 2]]) -> Vec<f32> {
    let given = vec![
        ("of", Value::RingSeries(Arc::clone(series))),
        ("size", Value::Pair([240.0, 120.0])),
    ];
    let Value::Material(plot) = built(&ring_plot::KIND, 0, given).unwrap() else {
        panic!("a material")
    };
    assert_eq!(plot.size, Some([240.0, 120.0]));
    let program = Program::compile(&[plot.channels["base_color"].clone()]);
    let points: Vec<[f64; 3]> = points.iter().map(|[u, v]| [*u, *v, 0.0]).collect();
    let mut scratch = Scratch::default();
    let context = RunContext {
        level: Level::new(),
        cache: None,
        filtering: true,
        cancel: None,
    };
    program.run(&Samples::Points(&points), &mut scratch, &context);
    program.output(&scratch, 0, 0)[..points.len()].to_vec()
}

#[test]
fn a_plot_has_its_axes_and_each_year_in_its_place() {
    let series = series();
    let widths = series.widths();
    // Figures are 3.36 mm tall on a piece of this size; margins are multiples of that.
    let (left, right, bottom, top) = (
        6.0 * 3.36,
        240.0 - 2.5 * 3.36,
        5.0 * 3.36,
        120.0 - 4.5 * 3.36,
    );
    let most = 1.05 * widths.iter().copied().fold(0.0, f64::max);
    let place = |year: usize| {
        let across = left + (right - left) * year as f64 / 167.0;
        [across, bottom + (top - bottom) * widths[year] / most]
    };
    let years: Vec<[f64; 2]> = (0..168).map(place).collect();
    assert!(red(&series, &years).iter().all(|red| *red < 0.3));
    let beside: Vec<[f64; 2]> = years[1..]
        .iter()
        .map(|[u, v]| [*u, v / 2.0 + 9.3])
        .collect();
    assert!(red(&series, &beside).iter().all(|red| *red > 0.7));
    let axes = [[left, 60.0], [120.0, bottom]];
    assert!(red(&series, &axes).iter().all(|red| *red < 0.05));
    assert_eq!(
        red(&series, &[[1.0, 1.0], [239.0, 60.0], [-5.0, 500.0]]),
        [1.0; 3]
    );
}

#[test]
fn short_and_long_series_have_plots() {
    for (first_year, years) in [(2000, 1), (-50, 2), (1, 9000)] {
        let areas: Vec<f64> = (1..=years).map(f64::from).collect();
        let series = Arc::new(RingSeries {
            first_year,
            heights: areas.clone(),
            areas,
        });
        assert!(series.is_sound());
        let points: Vec<[f64; 2]> = (0..600)
            .map(|at| [f64::from(at) * 0.4, f64::from(at % 120)])
            .collect();
        let red = red(&series, &points);
        assert!(
            red.iter().all(|red| (0.0..=1.0).contains(red)),
            "{years} years"
        );
        assert!(red.iter().any(|red| *red < 0.5), "{years} years");
    }
}
