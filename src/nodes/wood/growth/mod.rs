//! Growth of a tree along a curved skeleton: the model in double precision, and the kernel that
//! evaluates it for columns of positions.

mod branches;
mod heights;
mod kernel;
pub(super) mod log_file;
mod model;
mod near;
mod power;
mod trunk;

pub(super) use heights::Heights;
pub use kernel::GrowthKernel;
pub use model::{
    BranchTerms, GrowingBranch, GrowthModel, GrowthSettings, Reach, Terms, growth_time,
};
