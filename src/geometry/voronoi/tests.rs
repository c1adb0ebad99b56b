//! Tests of Voronoi cells.
