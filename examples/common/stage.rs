//! What one example shows. The examples that open a scene, bake it and look on differ in this alone.

use bevy::app::App;
use bevy::color::Color;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy_kiln::prelude::BakeVolumes;

/// A scene and how it is looked at.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// The example's name.
    pub name: &'static str,
    /// The scene, below the folder of assets. It has a camera, where the view begins.
    pub file: &'static str,
    /// From that camera to the point that the view turns about [m].
    pub distance: f32,
    /// Radiance of the sky, linear Rec. 709 [cd/m²].
    pub sky: [f32; 3],
    /// What is seen of it.
    pub background: Color,
    /// The camera's exposure value at ISO 100.
    pub ev100: f32,
    /// What becomes of what is brighter than the screen.
    pub tonemapping: Tonemapping,
    /// Which irradiance volumes are baked as well.
    pub volumes: BakeVolumes,
    /// Width and height of a picture [pixels].
    pub size: [u32; 2],
    /// Width and height of the window that a person looks at [pixels].
    pub window: [u32; 2],
    /// Keys of its own, as the screen explains them.
    pub keys: &'static str,
    /// What is in the app besides.
    pub besides: fn(&mut App),
}

impl Stage {
    /// A scene in a dark void, its colours as they are, so that the screen can be held against a path-traced picture.
    pub const PLAIN: Self = Self {
        name: "",
        file: "",
        distance: 3.5,
        sky: [0.0; 3],
        background: Color::BLACK,
        ev100: 9.7,
        tonemapping: Tonemapping::None,
        volumes: BakeVolumes::WhereCalledFor,
        size: [1280, 720],
        window: [1280, 720],
        keys: "",
        besides: |_| {},
    };
}
