//! What a bake knows of its texels, drawn on the surfaces that have them: density, charts, error, validity, and direct
//! and indirect light apart.
//!
//! Each surface gets a twin: a child with the same mesh, drawn a little nearer. The surfaces themselves stay as they
//! are. Twins are gone whenever a snapshot for a bake or a plan is taken, and when what they show is cleared.

mod colours;
mod legend;
mod material;
mod split;
mod truth;
mod twins;

pub use legend::{KilnLegend, Swatch};
pub use truth::{CompareWithTruth, KilnComparison, StopComparing};

use super::KilnSystems;
use super::baking::LastBake;
use super::{BakeGoal, BakeId, BakeStatus, KilnWork};
use bevy::prelude::*;
use colours::Asked;
use split::Split;

/// What is drawn on surfaces with a lightmap in place of their material, of the bake that is on show.
///
/// Set the resource, or trigger it as an event. It is `None` again when a bake begins; a game that reads the world with
/// [`extract_scene`](super::extract_scene) sets it first.
///
/// Colours go through the tone mapping of cameras with `Hdr`; others show them as in [`KilnLegend`].
#[derive(Resource, Event, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Resource, Event, Default, Debug, PartialEq, Clone)]
pub enum KilnOverlay {
    /// Nothing: surfaces as they are.
    #[default]
    None,
    /// A checkerboard of texels, by how many there are per metre over those asked for.
    TexelDensity,
    /// A colour for each chart.
    Charts,
    /// How well a texel is known over what was asked for: its 95 % interval before repair. A bake to a number of
    /// paths is held against 2 %.
    Error,
    /// Which texels were measured, which lie inside of bodies, which are filled in, which overlap.
    Validity,
    /// Direct light of what is baked, on white. A bake does not hold it apart, so it is baked again in coarse, beside
    /// the running game, when this is first asked for.
    DirectOnly,
    /// The rest.
    IndirectOnly,
}

impl KilnOverlay {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::None,
        Self::TexelDensity,
        Self::Charts,
        Self::Error,
        Self::Validity,
        Self::DirectOnly,
        Self::IndirectOnly,
    ];

    fn is_light(self) -> bool {
        matches!(self, Self::DirectOnly | Self::IndirectOnly)
    }
}

/// Draws [`KilnOverlay`] and compares frames with the truth ([`CompareWithTruth`]). Opt in; [`KilnPanel`](super::KilnPanel) brings it along where it is built.
#[derive(Clone, Copy, Debug, Default)]
pub struct KilnOverlays;

impl Plugin for KilnOverlays {
    fn build(&self, app: &mut App) {
        material::plugin(app);
        truth::plugin(app);
        app.init_resource::<KilnOverlay>()
            .init_resource::<KilnLegend>()
            .init_resource::<Drawn>()
            .register_type::<KilnOverlay>()
            .add_observer(|asked: On<KilnOverlay>, mut overlay: ResMut<KilnOverlay>| *overlay = *asked.event())
            .add_systems(PreUpdate, follow.after(KilnSystems::Display))
            .add_systems(Last, (give_back, split).chain().before(KilnSystems::Snapshot));
    }
}

/// What is drawn.
#[derive(Resource, Default)]
struct Drawn {
    what: Option<(BakeId, KilnOverlay)>,
    twins: Vec<Entity>,
    split: Option<Split>,
}

/// Error of a bake that asks for none.
const USUAL_ERROR: f64 = 0.02;

/// Draws what is asked for, if it is not drawn yet.
fn follow(world: &mut World) {
    let is_baking = world.resource::<BakeStatus>().running().is_some_and(|running| running.work == KilnWork::Bake);
    if is_baking {
        world.resource_mut::<KilnOverlay>().set_if_neq(KilnOverlay::None);
    }
    let overlay = *world.resource::<KilnOverlay>();
    let last = LastBake::of(world);
    let wanted = last.as_ref().filter(|_| overlay != KilnOverlay::None).map(|last| (last.id(), overlay));
    let mut drawn = world.remove_resource::<Drawn>().unwrap_or_default();
    if let Some(over) = drawn.split.as_ref().and_then(Split::look) {
        drawn.split = Some(over);
    }
    drawn.split = drawn.split.filter(|split| !is_baking && last.as_ref().is_some_and(|last| last.id() == split.of()));
    if drawn.what != wanted {
        twins::despawn(world, &mut drawn.twins);
        drawn.what = None;
    }
    let legend = match last {
        None if overlay == KilnOverlay::None => KilnLegend::default(),
        None => KilnLegend::note("Nothing is baked yet"),
        Some(last) => draw(world, &mut drawn, &last, overlay),
    };
    world.resource_mut::<KilnLegend>().set_if_neq(legend);
    world.insert_resource(drawn);
}

fn draw(world: &mut World, drawn: &mut Drawn, last: &LastBake, overlay: KilnOverlay) -> KilnLegend {
    let wanted = (last.id(), overlay);
    let asked = asked(last);
    let direct = match &drawn.split {
        _ if !overlay.is_light() => None,
        Some(Split::Done { direct, .. }) => Some(direct.clone()),
        Some(Split::Failed { reason, .. }) => {
            return KilnLegend::note(format!("Direct light cannot be told apart: {reason}"));
        }
        Some(Split::Running(_)) | None => {
            let paths = split::PATHS;
            return KilnLegend::note(format!("Bakes direct light by itself, with {paths} paths for each texel …"));
        }
    };
    if drawn.what.is_none() && overlay != KilnOverlay::None {
        drawn.twins = match direct {
            Some(direct) => twins::of_light(world, last, overlay, &direct),
            None => twins::of_colours(world, last, overlay, asked),
        };
        drawn.what = Some(wanted);
    }
    KilnLegend::of(overlay, asked)
}

fn asked(last: &LastBake) -> Asked {
    let (settings, intervals) = (last.settings(), &last.lightmap.report.intervals);
    let error = match settings.goal {
        BakeGoal::Error(error) => error,
        BakeGoal::Time(_) | BakeGoal::Samples(_) => intervals.target.unwrap_or(USUAL_ERROR),
    };
    Asked { density: settings.density, error, floor: intervals.floor }
}

/// Takes everything off before a snapshot. What is asked for is drawn again in the next frame, but not after that of a
/// bake.
fn give_back(world: &mut World) {
    if world.resource::<BakeStatus>().running().is_some_and(|running| running.is_waiting) {
        take_off(world);
    }
}

fn take_off(world: &mut World) {
    let mut twins = std::mem::take(&mut world.resource_mut::<Drawn>().twins);
    twins::despawn(world, &mut twins);
    world.resource_mut::<Drawn>().what = None;
}

/// Has direct light baked by itself where it is asked for.
fn split(world: &mut World) {
    let is_called_for = world.resource::<KilnOverlay>().is_light() && world.resource::<Drawn>().split.is_none();
    let is_free = world.resource::<BakeStatus>().running().is_none();
    if is_called_for
        && is_free
        && let Some(last) = LastBake::of(world)
    {
        take_off(world);
        let split = Split::start(world, last);
        world.resource_mut::<Drawn>().split = Some(split);
    }
}
