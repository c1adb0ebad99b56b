//! Options that several commands have: threads, store, sizes and limits.

use super::{Exit, bytes, report};
use clap::{Args, ValueEnum};
use fearless_simd::Level;
use std::path::PathBuf;
use std::sync::Arc;
use yosegi::engine::{Engine, Options};
use yosegi::world::Disk;

/// What the engine may use.
#[derive(Args)]
pub(super) struct EngineArguments {
    /// Number of threads [default: all processors].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// Vector instructions to use, at most; the result is the same.
    #[arg(long)]
    simd: Option<Simd>,
}

/// Levels of vector instructions.
#[derive(Clone, Copy, ValueEnum)]
pub(super) enum Simd {
    Baseline,
    #[value(name = "sse4.2")]
    Sse42,
    Avx2,
    Avx512,
}

impl EngineArguments {
    /// The level to use.
    ///
    /// # Errors
    /// If this machine does not have it.
    pub(super) fn level(&self) -> Result<Option<Level>, String> {
        let Some(simd) = self.simd else {
            return Ok(None);
        };
        simd.level().map(Some).ok_or_else(|| {
            let name = simd
                .to_possible_value()
                .map(|value| value.get_name().to_owned());
            format!(
                "this machine has no {}; leave `--simd` out",
                name.unwrap_or_default()
            )
        })
    }
}

impl Simd {
    #[cfg(target_arch = "x86_64")]
    fn level(self) -> Option<Level> {
        let best = Level::new();
        match self {
            Simd::Baseline => Some(Level::baseline()),
            Simd::Sse42 => best.as_sse4_2().map(Level::Sse4_2),
            Simd::Avx2 => best.as_avx2().map(Level::Avx2),
            Simd::Avx512 => best.as_avx512().map(Level::Avx512),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn level(self) -> Option<Level> {
        matches!(self, Simd::Baseline).then(Level::baseline)
    }
}

/// The store of earlier results.
#[derive(Args)]
pub(super) struct StoreArguments {
    /// Neither look into the store of earlier results nor add to it.
    #[arg(long)]
    no_cache: bool,
    /// Folder of the store [default: yosegi in the user's cache folder].
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    limit: LimitArguments,
}

/// How large the store may be.
#[derive(Args)]
pub(super) struct LimitArguments {
    /// Most bytes of the store: a number, or one with KiB, MiB, GiB or TiB; the entries used longest ago go first.
    #[arg(long = "cache-size", value_name = "SIZE", default_value = "2GiB", value_parser = bytes::parse)]
    pub(super) bytes: u64,
}

/// The size of the maps, and its limit.
#[derive(Args)]
pub(super) struct SizeArguments {
    /// Size of the maps in pixels, instead of what the recipe states.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(super) size: Option<[u32; 2]>,
    /// Most pixels that a map may have.
    #[arg(long, value_name = "N", default_value_t = 1 << 30)]
    pub(super) max_pixels: u64,
}

impl StoreArguments {
    /// The folder of the store; `None` if there is to be none.
    pub(super) fn folder(&self) -> Option<PathBuf> {
        match (&self.cache, self.no_cache) {
            (Some(folder), _) => Some(folder.clone()),
            (None, true) => None,
            (None, false) => default_store(),
        }
    }
}

/// How an engine works for one call.
pub(super) fn once(size: &SizeArguments, store: &StoreArguments) -> Options {
    Options {
        // One run has no use for columns of another: each output has samples of its own.
        memory: 0,
        store: store.folder(),
        store_limit: store.limit.bytes,
        largest_output: size.max_pixels,
        ..Options::default()
    }
}

/// Starts an engine; says what keeps it from starting.
///
/// # Errors
/// The exit code that follows.
pub(super) fn start(options: Options) -> Result<Engine, Exit> {
    Engine::new(Arc::new(Disk), options).map_err(|error| {
        report::problem(&format!("cannot start threads: {error}"));
        Exit::Files
    })
}

/// The user's cache folder, by the conventions of the system.
pub(super) fn default_store() -> Option<PathBuf> {
    let variable = |name: &str| {
        std::env::var_os(name)
            .filter(|it| !it.is_empty())
            .map(PathBuf::from)
    };
    let folder = variable("XDG_CACHE_HOME")
        .filter(|folder| folder.is_absolute())
        .or_else(|| variable("LOCALAPPDATA"))
        .or_else(|| variable("HOME").map(|home| home.join(".cache")))?;
    Some(folder.join("yosegi"))
}

/// A number of bytes: `64MiB`, `1.5 GiB`, `0`.
fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| match text.trim().parse() {
        Ok(side) if (1..=65_536).contains(&side) => Ok(side),
        _ => Err(format!(
            "expected a whole number from 1 to 65536, found `{text}`"
        )),
    };
    let (width, height) = text
        .split_once(['x', 'X'])
        .ok_or("expected WxH, for example 1024x512")?;
    Ok([side(width)?, side(height)?])
}
