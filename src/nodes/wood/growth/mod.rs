//! Growth of a tree along a curved skeleton: the model in double precision, and the kernel that
//! evaluates it for columns of positions.

mod branches;
mod clock;
mod heights;
mod kernel;
mod line;
pub(super) mod log_file;
mod model;
mod near;
mod power;
mod rings;
mod steps;
mod straight;
mod straight_columns;
mod trunk;

pub(super) use heights::Heights;
pub use kernel::GrowthKernel;
pub(super) use kernel::RUN;
pub use line::TrunkLine;
pub use model::{
    BranchTerms, GrowingBranch, GrowthModel, GrowthSettings, Reach, Terms, growth_time,
};
pub(super) use rings::RingTable;
pub use straight::{Region, Seen, StraightTrunk, Way};
pub(super) use straight_columns::RegionKernel;
