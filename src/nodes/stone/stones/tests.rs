//! Tests of stones.
