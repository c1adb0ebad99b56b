//! Growth of a tree along a curved skeleton: the model in double precision, and the kernel that
//! evaluates it for columns of positions.

mod branches;
mod heights;
mod kernel;
pub(super) mod log_file;
mod model;
mod near;
mod power;
mod rings;
mod steps;
mod trunk;

pub use kernel::GrowthKernel;
pub use model::{
    BranchTerms, GrowingBranch, GrowthModel, GrowthSettings, Reach, Terms, growth_time,
};
