//! Warnings of nodes come with every run, also with one in which nothing is built.

use super::*;

/// A tree with a branch on a branch, which is left out.
const TREE: &str = "# unit: mm
id,parent,x,y,z,radius
1,0,0,0,0,40
2,1,0,0,600,30
3,2,0,0,1200,20
4,2,200,0,700,8
5,4,400,0,800,6
6,4,400,90,800,2
";

/// Two outputs: one shows the tree, one has nothing to do with it.
const RECIPE: &str = r##"(
    nodes: {
        "tree": skeleton_from_file(tree: "tree.csv"),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3),
        "wood": material(base_color: "#c8a06e", height: "= 0.01 mm/year * time"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
        "plain": material(base_color: "#808080"),
        "board": slice_cut(of: "plain", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    },
    outputs: {
        "relief": maps(of: "plank", pixels: (24, 20), channels: [height], format: exr_half),
        "flat": maps(of: "board", pixels: (24, 20)),
    },
)"##;

const WARNING: &str = "1 branch of a branch is left out: a branch is straight and begins on the trunk; \
                       the first is in line 8";

fn warnings(workshop: &Workshop, recipe: &str) -> Vec<String> {
    let run = workshop.render(recipe, &[], Cancel::new(), &|_| {});
    assert_eq!(run.result.unwrap().len(), 2);
    let told = |event: &Event| match event {
        Event::Warning {
            node,
            file,
            line,
            column,
            message,
        } => {
            let file = file.display();
            Some(format!("{file}:{line}:{column}: {node}: {message}"))
        }
        _ => None,
    };
    run.events.iter().filter_map(told).collect()
}

#[test]
fn warnings_come_with_every_run() {
    let with_store = || Options {
        store: Some("store".into()),
        ..options()
    };
    let workshop = Workshop::new("recipes", with_store());
    workshop.files.insert("recipes/tree.csv", TREE.as_bytes());
    let expected = [format!("recipes/recipe.ron:3:9: tree: {WARNING}")];
    assert_eq!(warnings(&workshop, RECIPE), expected);
    // Nothing is built: the maps are in their place.
    assert_eq!(warnings(&workshop, RECIPE), expected);
    // Another process, which has the skeleton from the store because the output is another one.
    let other = workshop.another(with_store());
    let edited = RECIPE.replace("0.01 mm/year * time", "0.02 mm/year * time");
    assert_eq!(warnings(&other, &edited), expected);
    // A new name, under which nothing runs again.
    let renamed = edited.replace("\"tree\"", "\"oak\"");
    assert_eq!(
        warnings(&other, &renamed),
        [format!("recipes/recipe.ron:3:9: oak: {WARNING}")]
    );
    // A file that gives no cause leaves none behind.
    workshop.files.insert(
        "recipes/tree.csv",
        TREE.replace("6,4,400,90,800,2\n", "").into_bytes(),
    );
    assert_eq!(warnings(&workshop, RECIPE), [""; 0]);
}
