//! What the store knows of an output: which maps it leads to, and whether they can be put in place.

use super::build::Built;
use super::event::{self, Event};
use super::plan::{Plan, ancestors};
use super::render::{Output, Render, WantedMap};
use super::store::{Family, MapRecord, Store};
use super::{Engine, RESULTS, content, files};
use crate::key::{Key, KeyHasher};
use crate::value::MapFormat;
use crate::world::Listed;
use petgraph::graph::NodeIndex;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};

/// A map that need not be painted.
pub(super) struct KnownMap {
    pub(super) map: WantedMap,
    pub(super) path: PathBuf,
    record: MapRecord,
    /// Whether the file is as it should be; otherwise the store has a copy.
    pub(super) is_there: bool,
}

/// What the store remembers of an output.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct OutputRecord {
    pub(super) maps: Vec<WantedMap>,
    /// The plan keys of nodes with what they warned of.
    pub(super) warnings: Vec<(Key, String)>,
}

impl OutputRecord {
    /// Whether it can be one of the output `name`: whoever may write into the store must not choose which
    /// files are written.
    fn is_sound(&self, name: &str) -> bool {
        let is_name = |text: &str| {
            let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
            !text.is_empty() && text.chars().all(plain)
        };
        let is_sound = |map: &WantedMap| {
            let mut formats = MapFormat::ALL.into_iter();
            let is_named = |format| files::file_name(name, &map.channel, format) == map.file_name;
            let is_table = map.channel == files::TABLE && files::table_name(name) == map.file_name;
            is_table || is_name(&map.channel) && formats.any(is_named)
        };
        let mut warnings = self.warnings.iter();
        self.maps.iter().all(is_sound) && warnings.all(|(_, text)| content::is_plain(text))
    }
}

/// An output of which nothing need be painted.
pub(super) struct KnownOutput {
    pub(super) maps: Vec<KnownMap>,
    warnings: Vec<(Key, String)>,
}

impl Engine {
    /// What the store knows of a map whose file is `path`; changes nothing.
    pub(super) fn known_map(&self, map: &WantedMap, path: PathBuf) -> Option<KnownMap> {
        let store = self.store.as_ref()?;
        let record = store.map(&map.key)?;
        let is_there = store.matches(&record, &map.key, &path);
        (is_there || store.holds(&record)).then(|| KnownMap {
            map: map.clone(),
            path,
            record,
            is_there,
        })
    }

    /// What a plan for the output `name` has led to.
    pub(super) fn planned(&self, name: &str, plan: &Key) -> Option<OutputRecord> {
        let bytes = self.store.as_ref()?.get(Family::Plan, plan)?;
        let record: Option<OutputRecord> = postcard::from_bytes(&bytes).ok();
        record.filter(|record| record.is_sound(name))
    }

    /// What the output `name` is before anything has run: `node` is the plan key of its node.
    pub(super) fn output_key(&self, name: &str, node: Key, pixels: Option<[u32; 2]>) -> Key {
        let mut key = KeyHasher::new("output", RESULTS);
        key.key(node).text(name);
        key.whole(i64::from(self.options.filtering));
        pixels.iter().flatten().for_each(|side| {
            key.whole(i64::from(*side));
        });
        key.finish()
    }
}

impl Output<'_> {
    pub(super) fn plan_key(&self) -> Key {
        let node = self.plan.keys[&self.index];
        self.engine
            .output_key(self.name(), node, self.request.pixels)
    }

    /// The maps, if the store knows them all and they are in place or can be put there; changes nothing.
    pub(super) fn known(&self) -> Option<KnownOutput> {
        if self.verification.is_some() {
            return None;
        }
        let OutputRecord { maps, warnings } = self.engine.planned(self.name(), &self.plan_key())?;
        let world = &*self.engine.world;
        if !maps
            .iter()
            .all(|map| self.protected.allows(world, &self.path(map)))
        {
            return None;
        }
        let maps: Option<Vec<_>> = maps.iter().map(|map| self.known_map(map)).collect();
        maps.map(|maps| KnownOutput { maps, warnings })
    }

    /// What the nodes that the output depends on warned of.
    pub(super) fn warnings(&self, built: &Built) -> Vec<(Key, String)> {
        let nodes = ancestors(self.request.graph, &[self.index]).into_iter();
        let said = |node: NodeIndex| {
            let key = self.plan.keys[&node];
            let warnings = built.warnings(node).iter();
            warnings.map(move |message| (key, message.clone()))
        };
        nodes.flat_map(said).collect()
    }

    pub(super) fn known_map(&self, map: &WantedMap) -> Option<KnownMap> {
        self.engine.known_map(map, self.path(map))
    }

    /// Copies the map from the store if it is not there, and says so; false if that is not possible.
    pub(super) fn put_in_place(&self, known: &KnownMap) -> bool {
        let store = self.engine.store.as_ref();
        let durable = self.engine.options.durable;
        let restore = |store: &Store| store.restore(&known.record, &known.path, durable);
        let is_in_place = known.is_there || store.is_some_and(restore);
        if is_in_place {
            self.request.listener.hear(self.event(known));
        }
        is_in_place
    }

    fn event(&self, known: &KnownMap) -> Event {
        let (output, channel) = (self.name().to_owned(), known.map.channel.clone());
        let (path, [not_finite, clamped]) = (known.path.clone(), known.record.faults);
        let first_not_finite = known.record.first_not_finite;
        if known.is_there {
            Event::MapUpToDate {
                output,
                channel,
                path,
                not_finite,
                first_not_finite,
                clamped,
            }
        } else {
            Event::MapRestored {
                output,
                channel,
                path,
                not_finite,
                first_not_finite,
                clamped,
            }
        }
    }

    /// Names the files among those in the folder that the output has left behind: they are not `written`.
    pub(super) fn tell_stale(&self, folder: &[Listed], written: &HashSet<&str>) {
        let world = &*self.engine.world;
        for (channel, path) in files::stale(world, folder, self.name(), written) {
            self.request.listener.hear(Event::MapStale {
                output: self.name().to_owned(),
                channel,
                path,
            });
        }
    }

    pub(super) fn path(&self, map: &WantedMap) -> PathBuf {
        map_path(&self.request.folder, map)
    }
}

/// Says again what the nodes of known outputs warned of that need not be built any more.
pub(super) fn repeat_warnings<'k>(
    known: impl Iterator<Item = &'k KnownOutput>,
    request: &Render<'_>,
    plan: &Plan<'_>,
    built: &Built,
) {
    let mut repeated = BTreeSet::new();
    for (key, message) in known.flat_map(|known| &known.warnings) {
        let Some(node) = plan.order.iter().find(|node| plan.keys[node] == *key) else {
            continue;
        };
        if !built.has(*node) && repeated.insert((key, message)) {
            let node = &request.graph.nodes[*node];
            request.listener.hear(event::warning(node, message));
        }
    }
}

/// The file of a map in a folder.
pub(super) fn map_path(folder: &Path, map: &WantedMap) -> PathBuf {
    folder.join(&map.file_name)
}
