//! The kinds of nodes, in families: one file each, and one line each in the table below.

mod average;
mod cells;
pub mod cut;
pub mod field;
pub mod noise;
pub mod output;
pub mod partition;
mod picture;
mod random;
pub mod region;
pub mod rings;
pub mod shape;
pub mod stone;
pub mod surface;
pub mod view;
pub mod wood;

use crate::node::Kind;

/// Every kind there is, in the order of the manual.
pub static KINDS: &[&Kind] = &[
    &wood::skeleton::KIND,
    &wood::skeleton_from_file::KIND,
    &wood::growth_field::KIND,
    &wood::straight_growth_field::KIND,
    &rings::ring_series::KIND,
    &wood::virtual_energy::KIND,
    &wood::fibre_field::KIND,
    &surface::material::KIND,
    &shape::mesh_from_file::KIND,
    &shape::patches_from_file::KIND,
    &shape::nurbs_surface::KIND,
    &shape::mesh_from_patches::KIND,
    &cut::slice_cut::KIND,
    &cut::rotary_cut::KIND,
    &cut::mesh_cut::KIND,
    &cut::patch_cut::KIND,
    &output::maps::KIND,
    &surface::mix::KIND,
    &wood::colour_pattern::KIND,
    &wood::pattern_lookup::KIND,
    &wood::sample_pattern::KIND,
    &noise::solid_noise::KIND,
    &noise::plane_noise::KIND,
    &noise::distort::KIND,
    &field::position::KIND,
    &field::combine::KIND,
    &field::separate::KIND,
    &field::math::KIND,
    &field::vector_math::KIND,
    &field::remap::KIND,
    &field::threshold::KIND,
    &field::ramp::KIND,
    &field::adjust_colour::KIND,
    &field::transform::KIND,
    &field::transform_field::KIND,
    &field::sample_at::KIND,
    &field::image_from_file::KIND,
    &surface::blend::KIND,
    &rings::weather::KIND,
    &rings::growth_model::KIND,
    &shape::block::KIND,
    &shape::log::KIND,
    &shape::subdivide::KIND,
    &stone::stones::KIND,
    &view::KIND,
    &rings::ring_plot::KIND,
    &output::ring_table::KIND,
    &output::packing_table::KIND,
    &field::direction_field::KIND,
    &partition::square_packing::KIND,
    &partition::cell_fields::KIND,
    &partition::cell_value::KIND,
    &partition::per_cell::KIND,
    &partition::region_cells::KIND,
    &partition::voronoi_split::KIND,
    &partition::split_cells::KIND,
    &surface::inlay::KIND,
    &region::region::KIND,
    &region::region_shape::KIND,
    &region::region_from_file::KIND,
    &region::region_from_mesh::KIND,
    &region::combine_regions::KIND,
    &region::grow_region::KIND,
    &region::region_field::KIND,
    &partition::inset_cells::KIND,
    &partition::cell_attribute::KIND,
    &partition::cell_table::KIND,
];

/// The kind called `name`.
pub fn kind(name: &str) -> Option<&'static Kind> {
    KINDS.iter().copied().find(|kind| kind.name == name)
}
