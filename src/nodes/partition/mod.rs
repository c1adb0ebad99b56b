//! Planes divided into cells.

mod ground;
