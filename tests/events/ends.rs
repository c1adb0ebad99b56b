//! Runs that end early: cancelled, with failing nodes, or over a limit.

use super::*;

#[test]
fn a_cancelled_run_leaves_no_map_and_the_next_one_completes() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            threads: Some(1),
            tile: 8,
            ..stored()
        },
    );
    let cancel = Cancel::new();
    let run = workshop.render(BOARD, &[], cancel.clone(), &|event| {
        if matches!(event, Event::Progress { .. }) {
            cancel.cancel();
        }
    });
    assert_eq!(run.result, Err(RunError::Cancelled));
    assert_eq!(run.events.last(), Some(&Event::Cancelled));
    assert_eq!(workshop.maps(), [""; 0]);
    workshop.run(BOARD);
    let fresh = without_store();
    fresh.run(BOARD);
    assert_eq!(
        workshop.map("board_base_color.png"),
        fresh.map("board_base_color.png")
    );
}

#[test]
fn a_run_that_is_cancelled_before_it_starts_builds_nothing() {
    let workshop = without_store();
    let cancel = Cancel::new();
    cancel.cancel();
    let run = workshop.render(BOARD, &[], cancel, &|_| {});
    assert_eq!(run.result, Err(RunError::Cancelled));
    assert_snapshot!(run.log(), @"cancelled");
}

#[test]
fn outputs_that_were_done_before_a_cancel_stay() {
    let workshop = without_store();
    let cancel = Cancel::new();
    let run = workshop.render(PAIR, &[], cancel.clone(), &|event| {
        if matches!(event, Event::OutputDone { .. }) {
            cancel.cancel();
        }
    });
    assert_eq!(run.result, Err(RunError::Cancelled));
    assert_eq!(workshop.maps(), ["pale_base_color.png"]);
}

/// `PAIR` with a cut that spans no plane in the output `deep`.
fn half_broken() -> String {
    edit(
        PAIR,
        "cut: plain_sawn, origin: (0, 0, 600), offset: 20",
        "origin: (0, 0, 600), across: (1, 0, 0), along: (1, 0, 0)",
    )
}

#[test]
fn a_failing_node_is_named_and_what_is_there_stays() {
    let workshop = with_store();
    workshop.run(PAIR);
    let before = ["deep_base_color.png", "pale_base_color.png"].map(|name| workshop.map(name));
    let run = workshop.render(&half_broken(), &[], Cancel::new(), &|_| {});
    let Err(RunError::Nodes(wrong)) = run.result else {
        panic!("{:?}", run.result);
    };
    let named: Vec<_> = wrong
        .iter()
        .map(|it| (it.code, it.node.as_deref()))
        .collect();
    assert_eq!(named, [(Code::NodeFailed, Some("right"))]);
    assert_eq!(
        ["deep_base_color.png", "pale_base_color.png"].map(|name| workshop.map(name)),
        before
    );
    // A failure is not remembered: the corrected recipe renders at once.
    assert_snapshot!(workshop.run(PAIR), @"
    up to date deep_base_color.png
    up to date pale_base_color.png
    ");
}

#[test]
fn a_failed_node_keeps_only_its_own_outputs_back() {
    let workshop = without_store();
    let run = workshop.render(&half_broken(), &[], Cancel::new(), &|_| {});
    assert!(matches!(run.result, Err(RunError::Nodes(_))));
    assert_eq!(workshop.maps(), ["pale_base_color.png"]);
}

#[test]
fn every_failing_node_is_named_in_the_order_of_the_file() {
    let workshop = without_store();
    let both = edit(
        &half_broken(),
        "quarter_sawn, origin: (0, 0, 600)",
        "quarter_sawn, across: (1, 0, 0), origin: (0, 0, 600)",
    );
    let run = workshop.render(&both, &[], Cancel::new(), &|_| {});
    let Err(RunError::Nodes(wrong)) = run.result else {
        panic!("{:?}", run.result);
    };
    let named: Vec<_> = wrong.iter().map(|it| it.node.as_deref().unwrap()).collect();
    assert_eq!(named, ["left", "right"]);
    assert_eq!(workshop.maps(), [""; 0]);
}

#[test]
fn more_pixels_than_allowed_are_refused_before_anything_is_painted() {
    let workshop = Workshop::new(
        "recipes",
        Options {
            largest_output: 48 * 40 - 1,
            ..options()
        },
    );
    let run = workshop.render(BOARD, &[], Cancel::new(), &|_| {});
    let Err(RunError::Limit(wrong)) = &run.result else {
        panic!("{:?}", run.result);
    };
    assert_eq!(wrong[0].code, Code::TooMuch);
    assert!(!run.log().contains("tiles"), "{}", run.log());
}

/// A chain of 3000 mixes whose amounts vary over the piece.
fn mixes(amount: impl Fn(usize) -> String) -> String {
    let mix = |index: usize| {
        let (before, amount) = (index - 1, amount(index - 1));
        format!("\"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: \"{amount}\"),")
    };
    format!(
        "(nodes: {{
            \"fibre\": solid_noise(size: (5, 5, 150)),
            \"n0\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"fibre.value\"),
            {}
            \"wood\": material(base_color: \"n3000\"),
            \"piece\": slice_cut(of: \"wood\", cut: end_grain, origin: (0, 0, 0), size: (10, 10)),
        }},
        outputs: {{ \"board\": maps(of: \"piece\", pixels: (8, 8), channels: [base_color]) }})",
        (1..=3000).map(mix).collect::<String>()
    )
}

#[test]
fn programs_that_would_take_too_much_are_refused() {
    let same = mixes(|_| "fibre.value".into());
    let of_the_one_before = mixes(|before| format!("= luminance(n{before})"));
    for (recipe, of) in [(same, "operations"), (of_the_one_before, "bytes")] {
        let run = without_store().render(&recipe, &[], Cancel::new(), &|_| {});
        let Err(RunError::Limit(wrong)) = &run.result else {
            panic!("{:?}", run.result);
        };
        assert_eq!(wrong[0].code, Code::TooMuch);
        let found = wrong[0].found.as_deref().unwrap_or_default();
        assert!(found.ends_with(of), "{found}");
        assert!(!run.log().contains("tiles"), "{}", run.log());
    }
    // What cannot vary needs no neighbours.
    let even = mixes(|_| "= 0.5".into());
    let run = without_store().render(&even, &[], Cancel::new(), &|_| {});
    assert!(run.result.is_ok(), "{:?}", run.result);
}

#[test]
fn a_bmp_that_is_too_large_is_refused_before_any_output_is_painted() {
    let mut workshop = without_store();
    let recipe = edit(
        PAIR,
        "maps(of: \"right\", pixels: (48, 40))",
        "maps(of: \"right\", pixels: (48, 40), format: bmp)",
    );
    // The size that the run asks for counts, not the one of the recipe.
    workshop.size = Some([30_000, 30_000]);
    let run = workshop.render(&recipe, &[], Cancel::new(), &|_| {});
    let Err(RunError::Limit(wrong)) = &run.result else {
        panic!("{:?}", run.result);
    };
    assert_snapshot!(yosegi::diagnostics::render_all(wrong), @r#"
    error[too-much]: a BMP of `base_color` with 30000 x 30000 pixels would have 2700000054 bytes; the largest has 2147483647
      --> recipes/recipe.ron:16:61
       |
    16 |         "deep": maps(of: "right", pixels: (48, 40), format: bmp),
       |                                                             ^^^ this format
       |
       = help: lower the resolution, or write PNG or TIFF
    "#);
    assert!(!run.log().contains("tiles"), "{}", run.log());
    assert_eq!(workshop.maps(), [""; 0]);
}

#[test]
fn two_outputs_that_would_write_one_file_are_refused() {
    let recipe = r##"(
        nodes: {
            "wood": material(base_color: "#c8a06e", extras: { "old": 1, "pale_old": 2 }),
            "piece": slice_cut(of: "wood", cut: end_grain, origin: (0, 0, 0), size: (10, 10)),
        },
        outputs: {
            "board": maps(of: "piece", pixels: (8, 8), format: exr_half, channels: [pale_old]),
            "board_pale": maps(of: "piece", pixels: (8, 8), format: exr_half, channels: [old]),
        },
    )"##;
    let workshop = without_store();
    let run = workshop.render(recipe, &[], Cancel::new(), &|_| {});
    let Err(RunError::Nodes(wrong)) = run.result else {
        panic!("{:?}", run.result);
    };
    assert_eq!(wrong[0].node.as_deref(), Some("board_pale"));
    assert!(
        wrong[0].message.contains("`board_pale_old.exr`"),
        "{}",
        wrong[0].message
    );
    assert_eq!(workshop.maps(), [""; 0]);
    // Each alone is fine.
    for name in ["board", "board_pale"] {
        let alone = workshop.render(recipe, &[name], Cancel::new(), &|_| {});
        assert!(alone.result.is_ok());
    }
}
