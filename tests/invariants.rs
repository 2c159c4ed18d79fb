//! What must hold of light in any scene, without a reference: sums of lights, scale of power, reciprocity, energy
//! balance; and that neither order, nor names, nor how a surface is cut makes a difference. Scenes come by chance and
//! are shrunk to the smallest that fails, which is printed as a short list.
//!
//! Each law is a function from a scene and a [`Fault`] to a verdict. One test runs it on scenes as they are; another
//! plants a fault and asks that the law be found broken.

mod common;

#[path = "invariants/balance.rs"]
mod balance;
#[path = "invariants/chance.rs"]
mod chance;
#[path = "invariants/cuts.rs"]
mod cuts;
#[path = "invariants/judge.rs"]
mod judge;
#[path = "invariants/names.rs"]
mod names;
#[path = "invariants/power.rs"]
mod power;
#[path = "invariants/reciprocity.rs"]
mod reciprocity;
#[path = "invariants/sketch.rs"]
mod sketch;

/// What is done to a result, or to how it is made, to see that a law finds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// Nothing.
    None,
    /// The first lamp is there twice.
    LampTwice,
    /// Paths end after the first bounce.
    BounceMissing,
    /// One side is a hundredth brighter.
    OnePercent,
    /// One side is a twenty-fifth brighter.
    MoreLight,
    /// Random numbers go by an object's place in the list.
    KeyOfTurn,
    /// A piece is left out.
    PieceMissing,
}
