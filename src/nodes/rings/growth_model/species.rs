//! Species: how tall and how thick trees grow, and how much their rings differ from year to year.
//!
//! Allometries are fits of `1 / H = 1 / (A D^h) + 1 / H*` (Ogawa) to the trees of the Biomass And Allometry Database
//! (Falster et al. 2015, CC0) with H* held at a usual greatest height, by least squares of the heights' logarithms; for
//! Zelkova all three are fitted, for todo fir h = 1. Oak has that of mizunara; Douglas fir, bristlecone pine and teak
//! are not in the database, and have that of conifers and broadleaves in general.
//!
//! Mean sensitivity and autocorrelation are medians of measured series of the International Tree-Ring Data Bank:
//! oak (ZAL, Czech Republic), silver fir (wa082), Douglas fir (nm580, El Malpais), bristlecone pine (ca533), teak
//! (th001). Other conifers have those of silver fir, other broadleaves those of oak. Between single trees of a site
//! they differ: the standard deviation is 13 % of the mean sensitivity and 0.11 of the autocorrelation for the 24 oaks.
//! Mean ring widths are those of the same series, for spruce that of the log in `assets/spruce_log`, and for others
//! usual ones (own choice).

use super::variation::Band;

/// Extended allometry: `1 / H = 1 / (A D^h) + 1 / H*`, D the diameter in cm and H the height in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allometry {
    /// A in m / cm^h.
    pub factor: f64,
    /// h.
    pub exponent: f64,
    /// H* in m.
    pub most: f64,
}

impl Allometry {
    /// The height in m of a tree with a diameter in cm, Shibasaki & Aoyama, eq. (2).
    pub fn height(&self, diameter: f64) -> f64 {
        let free = self.factor * libm::pow(diameter, self.exponent);
        free * self.most / (free + self.most)
    }
}

/// What is usual for trees of a species.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Species {
    /// The name in recipes.
    pub name: &'static str,
    /// Height by diameter.
    pub allometry: Allometry,
    /// Mean ring width in mm.
    pub ring_width: f64,
    /// How even the rings are.
    pub band: Band,
}

/// Conifers and broadleaves in general.
pub const CONIFER: Allometry = allometry(1.2, 1.0, 35.0);
const BROADLEAF: Allometry = allometry(1.5, 0.9, 25.0);

const fn allometry(factor: f64, exponent: f64, most: f64) -> Allometry {
    Allometry {
        factor,
        exponent,
        most,
    }
}

const OAK: Band = band(0.24, 0.45);
const SILVER_FIR: Band = band(0.22, 0.38);

const fn band(sensitivity: f64, autocorrelation: f64) -> Band {
    Band {
        sensitivity,
        autocorrelation,
    }
}

const fn species(name: &'static str, allometry: Allometry, ring_width: f64, band: Band) -> Species {
    Species {
        name,
        allometry,
        ring_width,
        band,
    }
}

/// Every species, conifers first.
pub const SPECIES: [Species; 15] = [
    species("sugi", allometry(0.57, 1.22, 50.0), 3.0, SILVER_FIR),
    species("hinoki", allometry(1.55, 0.93, 35.0), 2.0, SILVER_FIR),
    species("spruce", allometry(0.68, 1.29, 50.0), 2.6, SILVER_FIR),
    species("larch", allometry(0.93, 1.14, 40.0), 2.4, SILVER_FIR),
    species("red_pine", allometry(2.16, 0.74, 35.0), 2.0, SILVER_FIR),
    species("todo_fir", allometry(1.03, 1.0, 46.1), 1.5, SILVER_FIR),
    species("douglas_fir", CONIFER, 0.55, band(0.56, 0.28)),
    species("bristlecone_pine", CONIFER, 0.4, band(0.32, 0.42)),
    species("oak", allometry(1.85, 0.94, 30.0), 2.6, OAK),
    species("mizunara", allometry(1.85, 0.94, 30.0), 2.0, OAK),
    species("konara", allometry(1.70, 1.14, 25.0), 2.6, OAK),
    species("beech", allometry(1.84, 0.93, 35.0), 2.0, OAK),
    species("zelkova", allometry(1.92, 1.05, 35.0), 2.4, OAK),
    species("sugar_maple", allometry(2.91, 0.88, 32.0), 1.8, OAK),
    species("teak", BROADLEAF, 1.65, band(0.27, 0.50)),
];

/// The names of all species.
pub const NAMES: [&str; SPECIES.len()] = {
    let mut names = [""; SPECIES.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = SPECIES[index].name;
        index += 1;
    }
    names
};

/// The species called `name`.
pub fn species_of(name: &str) -> Option<&'static Species> {
    SPECIES.iter().find(|species| species.name == name)
}
