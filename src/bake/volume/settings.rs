//! What volumes are asked for, and which grids of probes that makes.

use super::grid::Grid;
use super::{automatic, nesting};
use crate::artefact::StableId;
use crate::bake::workers::Workers;
use crate::bake::{BakeError, BakeSettings, Goal, LaterBounces};
use crate::scene::Scene;
use crate::trace::{Tracer, Transport};
use glam::{Quat, Vec3};
use std::num::NonZeroUsize;

/// What volumes are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSettings {
    /// How light is followed.
    pub transport: Transport,
    /// When a probe has been sampled enough: by its error, that of a face of its cube as the root of the mean square
    /// over all six, or by its paths. [`Goal::Time`] is refused.
    pub goal: Goal,
    /// How light is found that has met more than one surface.
    pub later_bounces: LaterBounces,
    /// Texels per metre of the coarse lightmap at which paths end where [`LaterBounces::Reused`] asks for it; fewer in a
    /// large scene.
    pub density: f32,
    /// Where they are.
    pub boxes: VolumeBoxes,
    /// Threads that trace; `None` for all cores.
    pub threads: Option<NonZeroUsize>,
}

impl Default for VolumeSettings {
    fn default() -> Self {
        Self {
            transport: Transport::default(),
            goal: Goal::Error(0.05),
            later_bounces: LaterBounces::Reused,
            density: 4.0,
            boxes: VolumeBoxes::default(),
            threads: None,
        }
    }
}

/// Where volumes are.
#[derive(Clone, Debug, PartialEq)]
pub enum VolumeBoxes {
    /// Around all that receives lightmaps, and three metres up at least; cut into up to [`MOST_VOLUMES`] where walls
    /// part rooms.
    Automatic {
        /// Side of a cell [m]; `None` for 0.25 m, or as much more as keeps it to about 32 768 probes.
        spacing: Option<f32>,
    },
    /// Where somebody put them. Of those that overlap the smallest counts.
    Given(Vec<VolumeBox>),
}

impl Default for VolumeBoxes {
    fn default() -> Self {
        Self::Automatic { spacing: None }
    }
}

/// The box of a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeBox {
    /// Whose it is.
    pub id: StableId,
    /// Its middle [m].
    pub centre: Vec3,
    /// From its own axes to the world's.
    pub rotation: Quat,
    /// Its sides [m].
    pub size: Vec3,
    /// Side of a cell [m]; `None` for a 32nd of the longest side of the box, and 0.25 m at least.
    pub spacing: Option<f32>,
}

impl VolumeSettings {
    /// What goes with a lightmap: two and a half times its error, since a probe's is that of six faces and what is lit by
    /// several of them errs less; or four times its paths, since they come from a sphere.
    ///
    /// Paths end at a coarse lightmap in any case: its bias is far below what a cube of six faces is off by.
    pub fn beside(lightmap: &BakeSettings) -> Self {
        let goal = match lightmap.goal {
            Goal::Error(error) => Goal::Error((2.5 * error).min(1.0)),
            Goal::Samples(count) => Goal::Samples(count.saturating_mul(4)),
            Goal::Time(_) => Self::default().goal,
        };
        Self { transport: lightmap.transport, goal, threads: lightmap.threads, ..Self::default() }
    }

    /// Refuses what cannot be met.
    ///
    /// # Errors
    ///
    /// [`BakeError::Settings`].
    pub fn validate(&self) -> Result<(), BakeError> {
        let refuse = |reason: String| Err(BakeError::Settings { setting: "volume", reason });
        self.goal.validate()?;
        if !(self.density > 0.0 && self.density.is_finite()) {
            return refuse(format!("a density of {} texels per metre cannot be; ask for 4 or so", self.density));
        }
        if let Goal::Time(_) = self.goal {
            return refuse("volumes are baked to an error or by paths; ask for one of these".into());
        }
        let is_length = |length: f32| length > 0.0 && length.is_finite();
        match &self.boxes {
            VolumeBoxes::Automatic { spacing: Some(spacing) } if !is_length(*spacing) => {
                refuse(format!("a spacing of {spacing} m cannot be; ask for 0.5 or so"))
            }
            VolumeBoxes::Automatic { .. } => Ok(()),
            VolumeBoxes::Given(boxes) => boxes.iter().try_for_each(|of| {
                let is_box = of.centre.is_finite() && of.size.to_array().into_iter().all(is_length);
                if is_box && of.rotation.is_normalized() && of.spacing.is_none_or(is_length) {
                    return Ok(());
                }
                refuse(format!(
                    "\"{}\" has a size, a place or a spacing that no box can have; give its Transform a scale above 0",
                    of.id
                ))
            }),
        }
    }

    /// The grids of all boxes, with their names and falloffs.
    pub(super) fn grids(
        &self,
        scene: &Scene,
        tracer: &Tracer,
        workers: &Workers,
    ) -> Result<Vec<(StableId, Grid, f32)>, BakeError> {
        match &self.boxes {
            VolumeBoxes::Automatic { spacing } => {
                let found = automatic::boxes(scene, *spacing, tracer, workers)?.into_iter().enumerate();
                Ok(found.map(|(number, grid)| (StableId::new(format!("volume/{number}")), grid, 0.0)).collect())
            }
            VolumeBoxes::Given(boxes) => {
                let grids: Vec<Grid> = boxes.iter().map(VolumeBox::grid).collect();
                let falloffs = nesting::falloffs(&grids);
                let named = boxes.iter().map(|of| of.id.clone()).zip(grids).zip(falloffs);
                Ok(named.map(|((id, grid), falloff)| (id, grid, falloff)).collect())
            }
        }
    }
}

impl VolumeBox {
    fn grid(&self) -> Grid {
        let spacing = self.spacing.unwrap_or((self.size.max_element() / 32.0).max(0.25));
        Grid::new(self.centre, self.rotation, self.size, spacing)
    }
}
