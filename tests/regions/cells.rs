//! Cells with joints, attributes and tables, on a square of nine.

use super::{built, told};
use glam::DVec2;
use std::f64::consts::PI;
use std::sync::Arc;
use yosegi::field::Field;
use yosegi::nodes::partition::{cell_attribute, cell_table, inset_cells};
use yosegi::value::{Partition, Value};

/// Nine squares of 10 mm.
fn squares() -> Partition {
    let mut squares = Partition {
        rings: vec![0],
        cells: vec![0],
        ..Partition::default()
    };
    for cell in 0..9u32 {
        let (column, row) = (cell % 3, cell / 3);
        let low = 10.0 * DVec2::new(f64::from(column), f64::from(row));
        let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        squares
            .corners
            .extend(corners.map(|(x, y)| low + DVec2::new(x, y)));
        let beyond = |is_there: bool, other: u32| if is_there { other } else { Partition::NONE };
        squares.neighbours.extend([
            beyond(row > 0, cell.wrapping_sub(3)),
            beyond(column < 2, cell + 1),
            beyond(row < 2, cell + 3),
            beyond(column > 0, cell.wrapping_sub(1)),
        ]);
        squares.rings.push(4 * (cell + 1));
        squares.cells.push(cell + 1);
        squares.ids.push(100 + cell);
        squares.centres.push(low + 5.0);
        squares.frames.push(DVec2::Y);
        squares.areas.push(100.0);
    }
    assert!(squares.is_sound());
    squares
}

fn cells(value: &Value) -> Arc<Partition> {
    match value {
        Value::Partition(partition) => Arc::clone(partition),
        other => panic!("found a {}", other.type_name()),
    }
}

fn inset(given: Vec<(&str, Value)>) -> Arc<Partition> {
    let mut values = vec![
        ("of", Value::Partition(Arc::new(squares()))),
        ("joint", Value::Number(2.0)),
        ("vary", Value::Pair([1.0; 2])),
        ("each", Value::Choice("edge")),
        ("round", Value::Number(0.0)),
        ("round_vary", Value::Pair([1.0; 2])),
        ("least", Value::Number(0.0)),
        ("seed", Value::Whole(0)),
    ];
    values.extend(given);
    let inset = cells(&built(&inset_cells::KIND, values).unwrap()[0]);
    assert!(inset.is_sound());
    inset
}

#[test]
fn joints_are_as_wide_as_stated() {
    let inset_cells = inset(vec![]);
    assert_eq!(inset_cells.areas, [64.0; 9]);
    assert_eq!(inset_cells.ids, squares().ids);
    assert_eq!(inset_cells.centres, squares().centres);
    for cell in 0..9 {
        assert_eq!(
            inset_cells.neighbours_of(cell),
            squares().neighbours_of(cell)
        );
    }
    let to_the_border = inset(vec![("border", Value::Number(0.0))]);
    assert_eq!(
        to_the_border.areas,
        [81.0, 72.0, 81.0, 72.0, 64.0, 72.0, 81.0, 72.0, 81.0]
    );
}

#[test]
fn rounded_corners_are_exact() {
    let rounded = inset(vec![("round", Value::Number(2.0))]);
    for area in &rounded.areas {
        assert!((area - (64.0 - 4.0 * (4.0 - PI))).abs() < 1e-12);
    }
    assert_eq!(
        rounded.bulges.iter().filter(|bulge| **bulge > 0.0).count(),
        36
    );
    assert_eq!(rounded.neighbours_of(4), [1, 3, 5, 7]);
    let varied = inset(vec![
        ("round", Value::Number(2.0)),
        ("round_vary", Value::Pair([0.5, 1.5])),
    ]);
    let areas = varied
        .areas
        .iter()
        .map(|area| ((64.0 - area) / (4.0 - PI)).sqrt());
    let radii: Vec<f64> = areas.collect();
    assert!(
        radii.iter().all(|radius| (0.999..=3.001).contains(radius)),
        "{radii:?}"
    );
    assert!(radii.iter().any(|radius| *radius < 1.8) && radii.iter().any(|radius| *radius > 2.2));
}

/// How far the upright edges of a row lie inside of where they were.
fn upright(cells: &Partition) -> Vec<[f64; 2]> {
    (0..9)
        .map(|cell| {
            let low = 10.0 * f64::from(cell % 3);
            let xs = cells.outline(cell as usize).iter().map(|corner| corner.x);
            let (left, right) = xs.fold((f64::INFINITY, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
            [left - low, low + 10.0 - right]
        })
        .collect()
}

#[test]
fn joints_vary_by_edge_or_by_cell() {
    let by_edge = upright(&inset(vec![("vary", Value::Pair([0.5, 1.5]))]));
    for cell in [0, 1, 3, 4, 6, 7] {
        let (here, there) = (by_edge[cell][1], by_edge[cell + 1][0]);
        assert!(
            (here - there).abs() < 1e-12,
            "both sides of a joint are alike"
        );
        assert!((0.5..=1.5).contains(&here));
    }
    assert!(
        by_edge
            .iter()
            .any(|[left, right]| (left - right).abs() > 0.2)
    );
    let by_cell = upright(&inset(vec![
        ("vary", Value::Pair([0.5, 1.5])),
        ("each", Value::Choice("cell")),
    ]));
    assert!(
        by_cell
            .iter()
            .all(|[left, right]| (left - right).abs() < 1e-12)
    );
    assert!(
        by_cell
            .windows(2)
            .all(|pair| (pair[0][0] - pair[1][0]).abs() > 1e-6)
    );
    let other = upright(&inset(vec![
        ("vary", Value::Pair([0.5, 1.5])),
        ("seed", Value::Whole(1)),
    ]));
    assert_ne!(by_edge, other);
}

#[test]
fn joints_follow_a_field() {
    // As wide as the point is to the right: 10 mm between the first and the second column.
    let x = Field::position(yosegi::value::Domain::Plane).part(0, 1);
    let given = vec![("joint", Value::Field(x)), ("border", Value::Number(0.0))];
    let left = inset(given);
    assert_eq!(left.ids, [100, 103, 106]);
    assert!(left.corners.iter().all(|corner| corner.x <= 5.0));
}

#[test]
fn cells_that_vanish_are_counted() {
    let wide = built(
        &inset_cells::KIND,
        vec![
            ("of", Value::Partition(Arc::new(squares()))),
            ("joint", Value::Number(10.0)),
            ("vary", Value::Pair([1.0; 2])),
            ("each", Value::Choice("edge")),
            ("round", Value::Number(0.0)),
            ("round_vary", Value::Pair([1.0; 2])),
            ("least", Value::Number(0.0)),
            ("seed", Value::Whole(0)),
        ],
    );
    assert_eq!(wide.unwrap_err().message, "nothing is left of any cell");
    let some = inset(vec![
        ("border", Value::Number(5.0)),
        ("joint", Value::Number(6.0)),
    ]);
    assert_eq!(
        (some.ids.clone(), some.neighbours_of(0)),
        (squares().ids, vec![1, 3])
    );
    let few = inset(vec![
        ("border", Value::Number(7.5)),
        ("joint", Value::Number(6.0)),
    ]);
    assert_eq!(few.ids, [104]);
    assert!(few.neighbours.iter().all(|cell| *cell == Partition::NONE));
    let nodes = "\"cells\": region_cells(of: \"two\"), \"two\": region(outlines: [
        (outline: [(0, 0), (9, 0), (9, 9)]), (outline: [(20, 0), (22, 0), (22, 2)])]),
        \"example\": inset_cells(of: \"cells\", joint: 2)";
    assert_eq!(
        told(&[], nodes).unwrap(),
        ["1 of 2 cells vanishes between their joints"]
    );
}

#[test]
fn cells_that_fall_apart_are_counted() {
    // Two dumbbells whose bars are narrower than the joint, and a square.
    let bell = |y: f64| {
        let [low, bar, top, high] = [0.0, 1.5, 2.5, 4.0].map(|it| it + y);
        format!(
            "(outline: [(0, {low}), (4, {low}), (4, {bar}), (8, {bar}), (8, {low}), (14, {low}), \
             (14, {high}), (8, {high}), (8, {top}), (4, {top}), (4, {high}), (0, {high})])"
        )
    };
    let nodes = format!(
        "\"cells\": region_cells(of: \"three\"), \"three\": region(outlines: [
        {}, {}, (outline: [(0, 20), (9, 20), (9, 29), (0, 29)])]),
        \"example\": inset_cells(of: \"cells\", joint: 1.2)",
        bell(0.0),
        bell(10.0)
    );
    assert_eq!(
        told(&[], &nodes).unwrap(),
        ["2 of 3 cells fall apart between their joints: the largest part of each is kept"]
    );
}

fn with_attribute(given: Vec<(&str, Value)>) -> Result<Vec<f64>, String> {
    let mut values = vec![
        ("of", Value::Partition(Arc::new(squares()))),
        ("name", Value::Text("tone".to_owned())),
        ("seed", Value::Whole(0)),
    ];
    values.extend(given);
    let built = built(&cell_attribute::KIND, values).map_err(|failure| failure.message)?;
    Ok(cells(&built[0]).attributes["tone"].clone())
}

#[test]
fn attributes_are_stated_drawn_chosen_or_asked_for() {
    assert_eq!(
        with_attribute(vec![("value", Value::Number(0.5))]).unwrap(),
        [0.5; 9]
    );
    let height = Field::position(yosegi::value::Domain::Plane).part(1, 1);
    let asked = with_attribute(vec![("value", Value::Field(height))]).unwrap();
    assert_eq!(asked, [5.0, 5.0, 5.0, 15.0, 15.0, 15.0, 25.0, 25.0, 25.0]);
    let drawn = with_attribute(vec![("random", Value::Pair([2.0, 3.0]))]).unwrap();
    assert!(drawn.iter().all(|number| (2.0..3.0).contains(number)));
    assert!(drawn.windows(2).all(|pair| pair[0] != pair[1]));
    let item = |value: f64, weight: f64| {
        Value::Record(vec![
            ("value", Value::Number(value)),
            ("weight", Value::Number(weight)),
        ])
    };
    let chosen = |items: Vec<Value>| with_attribute(vec![("choice", Value::List(items))]);
    let both = chosen(vec![item(1.0, 1.0), item(7.0, 1.0)]).unwrap();
    assert!(both.contains(&1.0) && both.contains(&7.0));
    assert_eq!(
        chosen(vec![item(1.0, 0.0), item(7.0, 2.0)]).unwrap(),
        [7.0; 9]
    );
    assert_eq!(
        chosen(vec![]).unwrap_err(),
        "there is nothing to choose from"
    );
    assert_eq!(
        with_attribute(vec![]).unwrap_err(),
        "nothing says what the number is"
    );
    let two = vec![
        ("value", Value::Number(1.0)),
        ("random", Value::Pair([0.0, 1.0])),
    ];
    assert_eq!(
        with_attribute(two).unwrap_err(),
        "more than one of `value`, `random` and `choice` is stated"
    );
}

fn table(rows: &'static str) -> String {
    let mut squares = squares();
    squares
        .attributes
        .insert("size, wanted".to_owned(), vec![10.0; 9]);
    let given = vec![
        ("of", Value::Partition(Arc::new(squares))),
        ("rows", Value::Choice(rows)),
    ];
    match &built(&cell_table::KIND, given).unwrap()[0] {
        Value::Table(table) => table.text.clone(),
        other => panic!("found a {}", other.type_name()),
    }
}

#[test]
fn a_table_has_a_row_for_each_cell() {
    let table = table("cells");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[0],
        "id,x_mm,y_mm,area_mm2,corners,axis_degree,neighbours,\"size, wanted\""
    );
    assert_eq!(lines[5], "104,15,15,100,4,90,4,10");
    assert_eq!(lines.len(), 10);
}

#[test]
fn a_summary_says_how_regular_squares_are() {
    let table = table("summary");
    let number = |name: &str| -> f64 {
        let line = table
            .lines()
            .find(|line| line.starts_with(&format!("{name},")));
        line.unwrap().split(',').nth(1).unwrap().parse().unwrap()
    };
    let expected = [
        ("cells", 9.0),
        ("area_mm2", 900.0),
        ("mean_area_mm2", 100.0),
        ("area_variation", 0.0),
        ("neighbours_2", 4.0 / 9.0),
        ("neighbours_3", 4.0 / 9.0),
        ("neighbours_4", 1.0 / 9.0),
        ("psi4", 1.0),
        // Of two neighbours at a right angle, of three, and of four.
        ("psi6", (0.0 + 4.0 / 3.0 + 0.0) / 9.0),
        ("mean_spacing_mm", 10.0),
        ("nearest_ratio", 2.0),
        ("nearest_over_mean_spacing", 1.0),
    ];
    for (name, expected) in expected {
        assert!(
            (number(name) - expected).abs() < 1e-12,
            "{name}: {}",
            number(name)
        );
    }
}
