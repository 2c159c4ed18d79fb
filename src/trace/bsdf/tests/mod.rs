//! Scattering: samples follow their density, no light is made, and swapping the two directions changes nothing. Every
//! checker is shown faults that it must reject.

mod albedo;
mod deltas;
mod density;
mod extremes;
mod furnace;
mod glass;
mod lambert;
mod look;
mod page;
mod reciprocity;
mod round_trip;
mod subject;
