//! Where a recipe ends: what is written.
