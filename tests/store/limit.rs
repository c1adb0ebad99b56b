//! The limit of the store: what was used longest ago goes, whatever the clock says.

use super::*;
