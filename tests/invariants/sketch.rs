//! Rooms by chance: walls, blocks and lamps, in round numbers, so that what fails can be read and drawn.

use crate::common::meter::{at, on_walls};
use crate::common::scenes::{SceneBuilder, glowing, grey};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{DirectionalLight, Light, PointLight, Scene};
use glam::{Affine3A, Mat3A, Vec2, Vec3, Vec3A};
use proptest::collection::vec;
use proptest::prelude::*;
use std::fmt::{Display, Formatter};

/// A room from the origin to `size`, what stands in it and what shines.
#[derive(Clone, Debug)]
pub struct Sketch {
    pub shell: Shell,
    /// Quarters of a metre.
    pub size: [u8; 3],
    /// Albedos in tenths: −x, +x, −y, +y, −z, +z.
    pub walls: [u8; 6],
    pub blocks: Vec<Block>,
    pub lamps: Vec<Lamp>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shell {
    Closed,
    /// No ceiling and no +x wall.
    Open,
}

/// A box on the floor.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Where its middle is, in eighths of the room.
    pub at: [u8; 2],
    /// Eighths of the room.
    pub size: [u8; 3],
    /// Turned about the vertical by the angle whose half has this tangent, in quarters.
    pub turn: u8,
    /// Tenths.
    pub albedo: u8,
}

#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    pub kind: Kind,
    /// Where it is, in eighths of the room's width and depth, below the ceiling.
    pub at: [u8; 2],
    /// How bright.
    pub strength: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A rectangle that blocks nothing and shines down.
    Panel,
    /// A glowing square that blocks and reflects, and shines down.
    Glow,
    /// A point.
    Spark,
    /// A sphere.
    Bulb,
    /// A single direction, from above and −x.
    Sun,
}

/// Closed or open rooms.
pub fn sketches(shells: &'static [Shell], kinds: &'static [Kind]) -> impl Strategy<Value = Sketch> {
    let size = [6..=12_u8, 6..=12, 6..=12];
    let walls = [0..=7_u8, 0..=7, 0..=7, 0..=7, 0..=7, 0..=7];
    let shell = proptest::sample::select(shells);
    (shell, size, walls, vec(blocks(), 0..=2), vec(lamps(kinds), 1..=3))
        .prop_map(|(shell, size, walls, blocks, lamps)| Sketch { shell, size, walls, blocks, lamps })
}

fn blocks() -> impl Strategy<Value = Block> {
    ([2..=6_u8, 2..=6], [1..=3_u8, 1..=4, 1..=3], 0..=4_u8, 0..=9_u8).prop_map(|(at, size, turn, albedo)| Block {
        at,
        size,
        turn,
        albedo,
    })
}

fn lamps(kinds: &'static [Kind]) -> impl Strategy<Value = Lamp> {
    (proptest::sample::select(kinds), [2..=6_u8, 2..=6], 1..=4_u8).prop_map(|(kind, at, strength)| Lamp {
        kind,
        at,
        strength,
    })
}

impl Sketch {
    /// Far corner [m].
    pub fn far(&self) -> Vec3 {
        Vec3::from_array(self.size.map(f32::from)) * 0.25
    }

    /// The scene. Every side of everything has texels, but the lamps.
    pub fn scene(&self) -> Scene {
        self.with_lamps(&self.lamps)
    }

    /// The scene under other lamps.
    pub fn with_lamps(&self, lamps: &[Lamp]) -> Scene {
        let far = self.far();
        let walls = self.walls.map(|tenths| grey(f32::from(tenths) / 10.0));
        let mut builder = SceneBuilder::default().room(Vec3::ZERO, far, walls);
        for (number, block) in self.blocks.iter().enumerate() {
            for (side, corner, edges) in BLOCK_SIDES {
                let name = format!("block {number}, {side}");
                builder = builder.quad(&name, corner, edges, grey(f32::from(block.albedo) / 10.0));
            }
        }
        for (number, lamp) in lamps.iter().enumerate() {
            builder = lamp.add(builder, number, far);
        }
        let mut scene = builder.build();
        let sides = scene.instances[6..].chunks_mut(BLOCK_SIDES.len());
        for (block, sides) in self.blocks.iter().zip(sides) {
            sides.iter_mut().for_each(|side| side.world_from_local = block.placement(far));
        }
        for (number, lamp) in lamps.iter().enumerate() {
            scene.lights.extend(lamp.light(number, far));
        }
        if self.shell == Shell::Open {
            scene.instances.retain(|instance| instance.name != "+y" && instance.name != "+x");
        }
        assert_eq!(scene.validate(), []);
        scene
    }

    /// Points on the six sides of the room, whether there are walls or not.
    pub fn points(&self) -> Vec<MeterPoint> {
        match self.shell {
            Shell::Closed => on_walls(Vec3::ZERO, self.far(), 2),
            // On the floor only, which every lamp shines on.
            Shell::Open => (0..9)
                .map(|cell| Vec3::new((cell % 3) as f32 + 0.5, 0.0, (cell / 3) as f32 + 0.5) / 3.0 * self.far())
                .map(|place| at(place, Vec3::Y))
                .collect(),
        }
    }
}

/// The sides of a block in its own frame, but its bottom: from −½ to ½ across and from 0 to 1 upwards.
const BLOCK_SIDES: [(&str, Vec3, [Vec3; 2]); 5] = [
    ("-x", Vec3::new(-0.5, 0.0, -0.5), [Vec3::Z, Vec3::Y]),
    ("+x", Vec3::new(0.5, 0.0, -0.5), [Vec3::Y, Vec3::Z]),
    ("-z", Vec3::new(-0.5, 0.0, -0.5), [Vec3::Y, Vec3::X]),
    ("+z", Vec3::new(-0.5, 0.0, 0.5), [Vec3::X, Vec3::Y]),
    ("+y", Vec3::new(-0.5, 1.0, -0.5), [Vec3::Z, Vec3::X]),
];

impl Block {
    fn placement(&self, far: Vec3) -> Affine3A {
        let tangent = f32::from(self.turn) / 4.0;
        let scale = 1.0 / (1.0 + tangent * tangent);
        let (sine, cosine) = (2.0 * tangent * scale, (1.0 - tangent * tangent) * scale);
        let turned = Mat3A::from_cols(Vec3A::new(cosine, 0.0, -sine), Vec3A::Y, Vec3A::new(sine, 0.0, cosine));
        let size = Vec3A::from_array(self.size.map(f32::from)) / 8.0 * Vec3A::from(far);
        let [x, z] = self.at.map(|eighths| f32::from(eighths) / 8.0);
        let translation = Vec3A::new(x * far.x, 0.0, z * far.z);
        Affine3A { matrix3: turned * Mat3A::from_diagonal(size.into()), translation }
    }
}

impl Lamp {
    /// Its middle: 7/8 of the way up.
    fn place(&self, far: Vec3) -> Vec3 {
        let [x, z] = self.at.map(|eighths| f32::from(eighths) / 8.0);
        Vec3::new(x, 0.875, z) * far
    }

    /// Radiance [cd/m²], intensity [cd] or illuminance [lx].
    fn brightness(&self) -> Vec3 {
        f32::from(self.strength) * Vec3::new(1.0, 0.75, 0.5)
    }

    fn add(&self, builder: SceneBuilder, number: usize, far: Vec3) -> SceneBuilder {
        let (name, place) = (format!("lamp {number}"), self.place(far));
        match self.kind {
            Kind::Panel => builder.rect_light(&name, place, Vec3::NEG_Y, SIZE, self.brightness()),
            Kind::Glow => {
                let mut material = glowing(0.5, 1.0);
                material.emitted_radiance = self.brightness();
                let corner = place - 0.5 * Vec3::new(SIZE.x, 0.0, SIZE.y);
                builder.quad(&name, corner, [Vec3::X * SIZE.x, Vec3::Z * SIZE.y], material)
            }
            Kind::Spark | Kind::Bulb | Kind::Sun => builder,
        }
    }

    fn light(&self, number: usize, far: Vec3) -> Option<Light> {
        let name = format!("lamp {number}");
        let bulb = |radius: f32| {
            Light::Point(PointLight {
                id: StableId::new(name.clone()),
                name: name.clone(),
                position: self.place(far),
                intensity: self.brightness(),
                radius,
                range: None,
            })
        };
        match self.kind {
            Kind::Panel | Kind::Glow => None,
            Kind::Spark => Some(bulb(0.0)),
            Kind::Bulb => Some(bulb(0.1)),
            Kind::Sun => Some(Light::Directional(DirectionalLight {
                id: StableId::new(name.clone()),
                name: name.clone(),
                direction: Vec3::new(0.28, -0.96, 0.0),
                illuminance: self.brightness(),
                angular_diameter: 0.0,
            })),
        }
    }

    /// All that it gives off, in green [lm].
    pub fn flux(&self) -> f64 {
        let strength = f64::from(self.brightness().y);
        match self.kind {
            Kind::Panel | Kind::Glow => std::f64::consts::PI * strength * f64::from(SIZE.element_product()),
            Kind::Spark | Kind::Bulb => 4.0 * std::f64::consts::PI * strength,
            Kind::Sun => f64::NAN,
        }
    }
}

/// Of lamps that are rectangles [m].
const SIZE: Vec2 = Vec2::new(0.5, 0.25);

impl Display for Sketch {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "- a room, {:?}, {} m, albedos {:?}/10", self.shell, self.far(), self.walls)?;
        for Block { at, size, turn, albedo } in &self.blocks {
            writeln!(f, "- a block at {at:?}/8, {size:?}/8 of the room, turned {turn}, albedo {albedo}/10")?;
        }
        for Lamp { kind, at, strength } in &self.lamps {
            writeln!(f, "- a {kind:?} of {strength} at {at:?}/8")?;
        }
        Ok(())
    }
}

/// Every kind of lamp.
pub const ALL: &[Kind] = &[Kind::Panel, Kind::Glow, Kind::Spark, Kind::Bulb, Kind::Sun];

/// Those that shine in a closed room.
pub const INDOORS: &[Kind] = &[Kind::Panel, Kind::Glow, Kind::Spark, Kind::Bulb];
