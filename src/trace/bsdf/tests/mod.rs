//! Scattering: samples follow their density, no light is made, and swapping the two directions changes nothing.

mod albedo;
mod lambert;
