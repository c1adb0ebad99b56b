//! The model against numbers that were computed apart from it, and its laws.

use super::*;
use libm::pow;
use serde_json::Value as Json;
use std::f64::consts::PI;
use yosegi::nodes::rings::growth_model::series::{Thickening, series, with_reserves};
use yosegi::nodes::rings::growth_model::species::Allometry;
use yosegi::nodes::rings::growth_model::vs_lite::{
    Thresholds, Window, day_factors, growth, light, moisture,
};
use yosegi::value::Month;

fn vectors() -> Json {
    let text = String::from_utf8(project_file("tests/data/growth-vectors.json")).unwrap();
    serde_json::from_str::<Json>(&text).unwrap()["growth"].clone()
}

/// All numbers of a list, lists within it after each other.
fn numbers(json: &Json) -> Vec<f64> {
    match json {
        Json::Array(items) => items.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap()],
    }
}

fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-9,
            "{found} instead of {expected}"
        );
    }
}

fn of_vectors(vectors: &Json) -> Climate {
    let (temperatures, rains) = (numbers(&vectors["temp"]), numbers(&vectors["prec"]));
    let pairs = temperatures.into_iter().zip(rains);
    let months = pairs.map(|(temperature, rain)| Month {
        temperature,
        rain,
        sunshine: None,
    });
    Climate {
        latitude: vectors["lat"].as_f64().unwrap(),
        first_year: 2000,
        months: months.collect(),
    }
}

const YEAR: Window = Window { first: 1, last: 12 };

#[test]
fn light_evaporation_moisture_and_growth_are_those_of_an_independent_program() {
    let vectors = vectors();
    let climate = of_vectors(&vectors);
    near(&light(climate.latitude), &numbers(&vectors["g_light"]));
    near(
        &day_factors(climate.latitude),
        &numbers(&vectors["day_factor"]),
    );
    near(&moisture(&climate), &numbers(&vectors["moisture"]));
    let [t1, t2, m1, m2] = numbers(&vectors["vs_lite_T1_T2_M1_M2"])[..] else {
        panic!("four thresholds")
    };
    let thresholds = Thresholds {
        temperature: [t1, t2],
        moisture: [m1, m2],
    };
    let months = growth(&climate, &thresholds, true);
    near(
        &YEAR.sums(&months, climate.latitude),
        &numbers(&vectors["vs_lite"]),
    );
}

#[test]
fn the_node_in_its_plain_form_adds_areas_in_proportion_to_the_sums() {
    let vectors = vectors();
    let given = [
        ("temperature", Value::Pair([5.8, 17.0])),
        ("moisture", Value::Pair([0.035, 0.25])),
        ("reserve", Value::Number(0.0)),
        ("slowdown", Value::Number(1.0)),
        ("ring_width", Value::Number(2.0)),
    ];
    let rings = grown(&Arc::new(of_vectors(&vectors)), 0, &given).unwrap();
    let sums = numbers(&vectors["vs_lite"]);
    let total: f64 = sums.iter().sum();
    let mut area = 0.0;
    for (found, sum) in rings.areas.iter().zip(&sums) {
        area += PI * 36.0 * sum / total;
        assert!((found - area).abs() < 1e-9, "{found} instead of {area}");
    }
}

#[test]
fn sections_and_heights_are_those_of_an_independent_program() {
    let vectors = vectors();
    let first = vectors["S1"].as_f64().unwrap();
    let areas = numbers(&vectors["dS"])
        .into_iter()
        .scan(first, |area, more| {
            *area += more;
            Some(*area)
        });
    let areas: Vec<f64> = std::iter::once(first).chain(areas).collect();
    let [factor, exponent, most] = numbers(&vectors["A_h_Hmax"])[..] else {
        panic!("three numbers")
    };
    let allometry = Allometry {
        factor,
        exponent,
        most,
    };
    let radii: Vec<f64> = series(1, areas.clone(), &allometry).radii().collect();
    near(&radii, &numbers(&vectors["R"]));
    // Their radii are in cm: a hundred times the area in mm².
    let in_millimetres = areas.iter().map(|area| 100.0 * area).collect();
    let heights = series(1, in_millimetres, &allometry).heights;
    let metres: Vec<f64> = heights.iter().map(|height| height / 1000.0).collect();
    near(&metres, &numbers(&vectors["H"]));
    let times: Vec<f64> = numbers(&vectors["ring_index_r"])
        .iter()
        .map(|radius| series(1, areas.clone(), &allometry).time_at(*radius, 0.0))
        .collect();
    near(&times, &numbers(&vectors["ring_index"]));
}

#[test]
fn the_great_droughts_of_oxford_are_among_its_narrowest_rings() {
    let from_1900 = ("from", Value::Whole(1900));
    let file = project_file("assets/weather/oxforddata.txt");
    let short = read(file, std::slice::from_ref(&from_1900)).unwrap();
    let plain = ("sunshine", Value::Toggle(false));
    let runs = [
        (oxford(), 0, vec![]),
        (oxford(), 99, vec![]),
        (oxford(), 0, vec![from_1900]),
        (oxford(), 0, vec![plain]),
        (short, 0, vec![]),
    ];
    for (climate, seed, given) in runs {
        let rings = grown(&climate, seed, &given).unwrap();
        let widths = rings.widths();
        let mut years: Vec<i32> = (1900..=2020).collect();
        years.sort_by(|a, b| {
            widths[(a - rings.first_year) as usize]
                .total_cmp(&widths[(b - rings.first_year) as usize])
        });
        println!("narrowest rings {:?}", &years[..12]);
        assert!(
            [1976, 1934, 1921]
                .iter()
                .all(|year| years[..8].contains(year)),
            "{:?}",
            &years[..12]
        );
    }
}

/// The correlation of two series.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let product = |(a, b): (&f64, &f64)| (a - mean_a) * (b - mean_b);
    let along = |a: &[f64], b: &[f64], of: &dyn Fn((&f64, &f64)) -> f64| {
        a.iter().zip(b).map(of).sum::<f64>()
    };
    let square_a: f64 = a.iter().map(|a| (a - mean_a) * (a - mean_a)).sum();
    let square_b: f64 = b.iter().map(|b| (b - mean_b) * (b - mean_b)).sum();
    along(a, b, &product) / (square_a * square_b).sqrt()
}

#[test]
fn rings_of_a_measured_site_follow_the_measured_index() {
    let table = String::from_utf8(project_file(SITE)).unwrap();
    let rows = table.lines().filter(|line| line.starts_with(['1', '2']));
    let measured: Vec<f64> = rows
        .map(|row| row.rsplit(',').next().unwrap().parse().unwrap())
        .collect();
    let follow = |given: &[(&str, Value)]| {
        correlation(&grown(&site(), 0, given).unwrap().widths(), &measured)
    };
    let stated = [
        ("temperature", Value::Pair([8.0, 10.0])),
        ("moisture", Value::Pair([0.05, 0.45])),
        ("window", Value::Pair([-4.0, 12.0])),
        ("reserve", Value::Number(0.0)),
    ];
    let (tuned, default) = (follow(&stated), follow(&[]));
    println!(
        "correlation {tuned:.3} with T1 8, T2 10, M1 .05, M2 .45, months -4 to 12, no reserve; {default:.3} with the defaults"
    );
    assert!(tuned > 0.8 && default > 0.6);
}

#[test]
fn rings_have_the_mean_width_that_is_asked_for() {
    for slowdown in [0.0, 0.4, 1.0] {
        let given = [
            ("ring_width", Value::Number(1.7)),
            ("slowdown", Value::Number(slowdown)),
            ("from", Value::Whole(1901)),
            ("to", Value::Whole(2000)),
        ];
        let rings = grown(&oxford(), 0, &given).unwrap();
        let widths = rings.widths();
        assert_eq!((rings.first_year, rings.years()), (1901, 100));
        assert!((widths.iter().sum::<f64>() - 170.0).abs() < 1e-9);
        let [first, last] = [&widths[..10], &widths[90..]].map(|ten| ten.iter().sum::<f64>());
        // The mean radius grows as age^(1 - slowdown / 2).
        let power = 1.0 - slowdown / 2.0;
        let expected = pow(10.0, power) / (pow(100.0, power) - pow(90.0, power));
        assert!(
            (first / last / expected - 1.0).abs() < 0.15,
            "{slowdown}: {first} {last}"
        );
    }
    let area = |growths: &[f64]| {
        Thickening {
            ring_width: 1.0,
            slowdown: 1.0,
        }
        .areas(growths)
    };
    let even = area(&[2.0; 4]);
    assert!(
        even.iter()
            .zip(1..)
            .all(|(area, n)| (area - 4.0 * PI * f64::from(n)).abs() < 1e-12)
    );
}

#[test]
fn months_of_a_window_are_counted_from_its_year() {
    // Month m of year y grows by 100 y + m.
    let months: Vec<f64> = (0..4)
        .flat_map(|year| (1..=12).map(move |month| f64::from(100 * year + month)))
        .collect();
    let sums = |first, last, latitude| Window { first, last }.sums(&months, latitude);
    assert_eq!(sums(1, 1, 50.0), [1.0, 101.0, 201.0, 301.0]);
    // September to December of the year before, as a mean year's for the first.
    let means = [9.0, 10.0, 11.0, 12.0].map(|month| month + 150.0);
    assert_eq!(sums(-4, -1, 50.0), [means.iter().sum(), 42.0, 442.0, 842.0]);
    // South of the equator a year begins in July, and the last has no end.
    assert_eq!(sums(1, 1, -30.0), [7.0, 107.0, 207.0, 307.0]);
    assert_eq!(sums(12, 12, -30.0), [106.0, 206.0, 306.0]);
    assert_eq!(sums(-6, -1, -30.0)[0], 21.0);
}

#[test]
fn light_and_growth_turn_with_the_hemisphere() {
    let (north, south) = (light(40.0), light(-40.0));
    for month in 0..12 {
        assert!(
            (north[month] - south[(month + 6) % 12]).abs() < 0.06,
            "{month}"
        );
    }
    assert!(light(0.0).iter().all(|light| *light > 0.9));
    for latitude in [-90.0, 90.0, 66.6, 0.0] {
        let all = [light(latitude), day_factors(latitude)].concat();
        assert!(
            all.iter().all(|value| value.is_finite() && *value >= 0.0),
            "{latitude}"
        );
    }
    // The weather of Oxford half a year later, as far south: its years are those of the north.
    let oxford = oxford();
    let mut turned = (*oxford).clone();
    turned.latitude = -oxford.latitude;
    turned.months.rotate_right(6);
    let given = [("sunshine", Value::Toggle(false))];
    let north = grown(&oxford, 0, &given).unwrap().widths();
    let south = grown(&Arc::new(turned), 0, &given).unwrap().widths();
    assert_eq!(south.len(), north.len() - 1);
    let follow = correlation(&north[5..167], &south[5..167]);
    assert!(follow > 0.97, "{follow}");
}

#[test]
fn sunshine_of_a_month_that_was_not_measured_is_that_of_a_mean_one() {
    let mut climate = (*tokyo()).clone();
    let thresholds = Thresholds {
        temperature: [4.0, 14.0],
        moisture: [0.02, 0.3],
    };
    let measured = growth(&climate, &thresholds, true);
    let june = |climate: &Climate| {
        climate
            .months
            .iter()
            .skip(5)
            .step_by(12)
            .filter_map(|month| month.sunshine)
            .collect::<Vec<_>>()
    };
    let all = june(&climate);
    climate.months[12 + 5].sunshine = None;
    let rest = june(&climate);
    assert_eq!(rest.len() + 1, all.len());
    let without = growth(&climate, &thresholds, true);
    assert!(
        without
            .iter()
            .zip(&measured)
            .filter(|(a, b)| a != b)
            .count()
            == 1
    );
    climate.months[12 + 5].sunshine = Some(rest.iter().sum::<f64>() / rest.len() as f64);
    let filled = growth(&climate, &thresholds, true);
    assert!((filled[12 + 5] - without[12 + 5]).abs() < 1e-12);
    climate
        .months
        .iter_mut()
        .for_each(|month| month.sunshine = None);
    assert_eq!(
        growth(&climate, &thresholds, true),
        growth(&climate, &thresholds, false)
    );
}

#[test]
fn reserves_carry_a_share_of_the_year_before() {
    assert_eq!(with_reserves(&[1.0, 2.0, 0.0], 0.25), [1.0, 1.75, 0.4375]);
    assert_eq!(with_reserves(&[1.0, 2.0, 0.0], 0.0), [1.0, 2.0, 0.0]);
}

/// A climate of one kind of year.
fn always(latitude: f64, temperature: [f64; 2], rain: f64, years: usize) -> Arc<Climate> {
    let month = |month: usize| {
        let [winter, summer] = temperature;
        let share = (1.0 - libm::cos(2.0 * PI * month as f64 / 12.0)) / 2.0;
        Month {
            temperature: winter + (summer - winter) * share,
            rain,
            sunshine: None,
        }
    };
    Arc::new(Climate {
        latitude,
        first_year: 1900,
        months: (0..12 * years).map(|index| month(index % 12)).collect(),
    })
}

#[test]
fn hard_places_give_sound_rings_or_say_why_not() {
    let deserts = [
        always(70.0, [-40.0, 6.0], 20.0, 60),
        always(25.0, [15.0, 38.0], 2.0, 60),
        always(0.0, [26.0, 27.0], 400.0, 60),
        always(51.0, [0.0, 18.0], 50.0, 1),
    ];
    for (number, climate) in deserts.iter().enumerate() {
        for species in ["oak", "douglas_fir"] {
            let rings = grown(climate, 1, &[("species", Value::Choice(species))]).unwrap();
            assert!(rings.is_sound(), "{number}");
        }
    }
    let ice = grown(&always(80.0, [-50.0, -5.0], 10.0, 30), 0, &[]).unwrap_err();
    assert_eq!(
        ice.message,
        "in this weather nothing grows: it is too cold or too dry in every month"
    );
    let short = grown(&always(-40.0, [5.0, 20.0], 60.0, 1), 0, &[]).unwrap_err();
    assert_eq!(
        short.message,
        "the weather is too short: the window of its only year ends in the next"
    );
    // A year in which nothing grows leaves a trace of a hundredth.
    let mut lean = (*always(50.0, [0.0, 18.0], 60.0, 9)).clone();
    lean.months[48..60]
        .iter_mut()
        .for_each(|month| month.temperature = -20.0);
    let lean = Arc::new(lean);
    let without_reserves = ("reserve", Value::Number(0.0));
    let rings = grown(&lean, 0, std::slice::from_ref(&without_reserves)).unwrap();
    let only = [("from", Value::Whole(1904)), ("to", Value::Whole(1904))];
    let bare = grown(&lean, 0, &[&only[..], &[without_reserves]].concat()).unwrap_err();
    assert_eq!(bare.message, ice.message);
    let widths = rings.widths();
    assert!(
        rings.is_sound() && widths[4] > 0.0 && widths[4] < 0.03 * widths[3],
        "{widths:?}"
    );
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |name, value| grown(&oxford(), 0, &[(name, value)]).unwrap_err();
    let message = |name, value| refused(name, value).message;
    assert_eq!(
        message("temperature", Value::Pair([9.0, 9.0])),
        "growth has to begin below where it is not held back: 9, 9"
    );
    assert_eq!(
        message("window", Value::Pair([0.0, 9.0])),
        "expected months from -12 to -1 or from 1 to 12, found 0"
    );
    assert_eq!(
        message("window", Value::Pair([1.5, 9.0])),
        "expected months from -12 to -1 or from 1 to 12, found 1.5"
    );
    assert_eq!(
        message("window", Value::Pair([9.0, 1.0])),
        "the window ends before it begins: 9 to 1"
    );
    assert_eq!(
        message("from", Value::Whole(1850)),
        "the weather gives no ring of the year 1850"
    );
    assert_eq!(
        refused("to", Value::Whole(2021)).hint.unwrap(),
        "it gives those of 1853 to 2020"
    );
}
