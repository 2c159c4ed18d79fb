//! The mathematics under the bake: frames, maps from the unit square, solid angles, distributions, statistics,
//! hashing and units. Knows nothing of scenes, rays or files.
//!
//! Points of the unit square are pairs in [0, 1)². Every map of it comes as three functions: the map, its density
//! and its inverse, so that a test can hold each against the other two.

mod ambient_cube;
mod colour;
mod distribution;
mod distribution_2d;
mod form_factor;
mod frame;
mod hash;
mod polygon;
mod portable;
mod special;
mod spherical_rectangle;
mod spherical_triangle;
mod stats;
mod units;
mod warp;

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;

pub use ambient_cube::{AmbientCube, FACES, ambient_cube_weights};
pub use colour::luminance;
pub use distribution::{Discrete, DiscreteSample, DistributionError};
pub use distribution_2d::{Cell, Discrete2d};
pub use form_factor::{
    coaxial_disk, coaxial_disks, corner_parallel_rectangle, corner_perpendicular_rectangle, parallel_rectangles,
    perpendicular_rectangles, sphere_above_horizon,
};
pub use frame::Frame;
pub use hash::{combine, mix64, seed32};
pub use polygon::polygon_irradiance;
pub use portable::{Portable, unit_at};
pub use special::{chi_squared_survival, normal_survival, student_t_survival};
pub use spherical_rectangle::SphericalRectangle;
pub use spherical_triangle::SphericalTriangle;
pub use stats::{Replicates, Welch, Welford, student_t_quantile, student_t_two_sided_95, welch_t_test};
pub use units::{
    emissive_displayed_from_radiance, emissive_radiance_as_displayed, ev100_from_exposure, exposure_from_ev100,
    rect_light_radiance,
};
pub use warp::{
    cosine_hemisphere_pdf, cosine_hemisphere_to_square, disk_pdf, disk_to_square, square_to_cosine_hemisphere,
    square_to_disk, square_to_triangle, square_to_uniform_cone, square_to_uniform_hemisphere, square_to_uniform_sphere,
    triangle_pdf, triangle_to_square, uniform_cone_pdf, uniform_cone_to_square, uniform_hemisphere_pdf,
    uniform_hemisphere_to_square, uniform_sphere_pdf, uniform_sphere_to_square,
};
