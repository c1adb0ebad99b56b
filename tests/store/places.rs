//! Folders and disks that the store cannot rely on.

use super::*;
