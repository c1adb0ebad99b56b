//! A workshop: files in memory, one engine, and the short log of what it did.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use yosegi::engine::{Cancel, Engine, Event, Options, Render, RenderedMap, ReusedFrom, RunError};
use yosegi::graph::{Graph, Settings, load};
use yosegi::world::{Memory, World};

/// An engine with its world.
pub(crate) struct Workshop {
    pub(crate) files: Memory,
    pub(crate) engine: Engine,
    /// The folder of the recipe.
    pub(crate) folder: PathBuf,
    pub(crate) size: Option<[u32; 2]>,
}

/// What a run said and how it ended.
pub(crate) struct Run {
    pub(crate) events: Vec<Event>,
    pub(crate) result: Result<Vec<RenderedMap>, RunError>,
}

impl Workshop {
    /// A workshop with the project's assets beside its recipe, which lies in `folder`.
    pub(crate) fn new(folder: &str, options: Options) -> Workshop {
        let files = Memory::default();
        for asset in [
            "spruce_log/Gran_1_pith.json",
            "spruce_log/Gran_1_knots.json",
            "spruce_bar/spruce_bar.png",
            "measured_tree/tree.csv",
            "weather/oxforddata.txt",
            "spot/spot.obj",
            "bowl/bowl.stl",
            "teapot/teapot.txt",
            "outlines/fischmarktplatz.geojson",
            "outlines/sechselaeutenplatz.geojson",
        ] {
            files.insert(Path::new(folder).join(asset), asset_bytes(asset));
        }
        Workshop {
            engine: Engine::new(Arc::new(files.clone()), options).unwrap(),
            files,
            folder: folder.into(),
            size: None,
        }
    }

    /// Another engine on the same files, as another process has it.
    pub(crate) fn another(&self, options: Options) -> Workshop {
        self.another_on(Arc::new(self.files.clone()), options)
    }

    /// As [`Workshop::another`], with a world that stands before the files.
    pub(crate) fn another_on(&self, world: Arc<dyn World>, options: Options) -> Workshop {
        Workshop {
            engine: Engine::new(world, options).unwrap(),
            files: self.files.clone(),
            folder: self.folder.clone(),
            size: self.size,
        }
    }

    pub(crate) fn graph(&self, recipe: &str) -> Graph {
        // A world of its own, so that recipes are no files of the workshop.
        let world = Memory::default();
        let path = self.folder.join("recipe.ron");
        world.insert(&path, recipe);
        for name in ["cherry.ron", "hinoki_trunk.ron"] {
            let compound = fs::read(Path::new("graphs/nodes").join(name)).unwrap();
            world.insert(self.folder.join("nodes").join(name), compound);
        }
        load(&world, &path, &Settings::default())
            .unwrap_or_else(|wrong| panic!("{}", yosegi::diagnostics::render_all(&wrong)))
            .graph
    }

    /// Renders some outputs of a recipe, all if none are named; `hear` is told what happens.
    pub(crate) fn render(
        &self,
        recipe: &str,
        only: &[&str],
        cancel: Cancel,
        hear: &(dyn Fn(&Event) + Sync),
    ) -> Run {
        self.render_graph(&self.graph(recipe), only, cancel, hear)
    }

    /// As [`Workshop::render`], of a recipe that is read already.
    pub(crate) fn render_graph(
        &self,
        graph: &Graph,
        only: &[&str],
        cancel: Cancel,
        hear: &(dyn Fn(&Event) + Sync),
    ) -> Run {
        let events = Mutex::new(vec![]);
        let listener = |event: Event| {
            hear(&event);
            events.lock().unwrap().push(event);
        };
        let result = self.engine.render(&Render {
            graph,
            folder: self.folder.join("out"),
            only: only.iter().map(|name| (*name).to_owned()).collect(),
            pixels: self.size,
            listener: &listener,
            cancel,
        });
        Run {
            events: events.into_inner().unwrap(),
            result,
        }
    }

    /// Renders a recipe that must not fail; gives the log.
    pub(crate) fn run(&self, recipe: &str) -> String {
        let run = self.render(recipe, &[], Cancel::new(), &|_| {});
        if let Err(error) = &run.result {
            panic!("{}", yosegi::diagnostics::render_all(error.diagnostics()));
        }
        run.log()
    }

    /// The bytes of a map.
    pub(crate) fn map(&self, name: &str) -> Vec<u8> {
        self.files
            .read(&self.folder.join("out").join(name))
            .unwrap()
    }

    /// The names of the maps that are there.
    pub(crate) fn maps(&self) -> Vec<String> {
        let out = self.folder.join("out");
        let name = |path: &PathBuf| Some(path.strip_prefix(&out).ok()?.display().to_string());
        self.files.paths().iter().filter_map(name).collect()
    }
}

impl Run {
    /// One line for each event worth telling, sorted; times and progress are left out.
    pub(crate) fn log(&self) -> String {
        let mut lines: Vec<String> = self.events.iter().filter_map(short).collect();
        lines.sort();
        lines.join("\n")
    }
}

fn short(event: &Event) -> Option<String> {
    Some(match event {
        Event::StructureProgress { .. } => return None,
        Event::StructureBuilt { node, .. } => format!("built {node}"),
        Event::StructureReused {
            node,
            from: ReusedFrom::Memory,
        } => format!("reused {node} (memory)"),
        Event::StructureReused {
            node,
            from: ReusedFrom::Disk,
        } => format!("reused {node} (disk)"),
        Event::FieldTiles {
            output,
            node,
            computed,
            reused,
        } => {
            format!("tiles of {output}: {node} computed {computed}, reused {reused}")
        }
        Event::MapWritten { path, .. } => format!("written {}", name(path)),
        Event::MapUpToDate { path, .. } => format!("up to date {}", name(path)),
        Event::MapRestored { path, .. } => format!("restored {}", name(path)),
        Event::Warning { node, message, .. } => format!("warning of {node}: {message}"),
        Event::MapStale { path, .. } => format!("stale {}", name(path)),
        Event::StoreFailed { reason } => format!("store failed: {reason}"),
        Event::CacheVerified { compared } => format!("compared {compared}"),
        Event::Cancelled => "cancelled".to_owned(),
        Event::Progress { .. } | Event::OutputDone { .. } => return None,
    })
}

fn name(path: &Path) -> String {
    path.file_name().unwrap().display().to_string()
}

/// A file of the project's assets.
pub(crate) fn asset_bytes(name: &str) -> Vec<u8> {
    fs::read(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("assets")
            .join(name),
    )
    .unwrap()
}
