//! Virtual energy: charges along a tree, the surfaces of equal energy around them, and the kernel that
//! evaluates both for columns of positions.

mod axis;
mod axis_columns;
mod charges;
mod kernel;
mod model;
mod potential;
mod wave;
mod wave_columns;

pub use axis::Axis;
pub(super) use charges::random_burls;
pub use charges::{BurlSettings, bark_radius, branch_rods, swelling_charge};
pub use kernel::EnergyKernel;
pub use model::{Burl, EnergyModel, EnergyTerms, Reference, Rod};
pub use wave::Wave;
