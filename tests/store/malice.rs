//! A store that someone else has filled, with entries that are whole by their checksums.

use super::*;
