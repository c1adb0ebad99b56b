//! Following recipes on a real disk: what is rendered after each way of saving, and what is told.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod desk;
mod files;
mod mistakes;
mod notices;
mod odd;
mod overtaken;
mod runs;
mod saves;
mod session;
mod soak;
