//! Bevy's `StandardMaterial` as one way to scatter light.
//!
//! With t = specular_transmission · (1 − metallic) the surface is (1 − t) parts of a microfacet coat over a diffuse
//! base and t parts of glass, a clear coat over all (`pbr_functions.wgsl`, `calculate_F0`, `calculate_diffuse_color`).
//! Unlike on screen, the diffuse base gets only what the coat leaves, the same both ways: times (1 − E(μo))
//! (1 − E(μi)) / (1 − E_average) per channel (Kelemen and Szirmay-Kalos 2001). So no albedo is above 1.
//!
//! The diffuser knows one index on both sides. Beside bent glass, on one surface, it does not follow the index squared.

use super::albedo::AlbedoTables;
use super::clearcoat::Clearcoat;
use super::dielectric::Dielectric;
use super::diffuse_transmission::DiffuseTransmission;
use super::fresnel::Schlick;
use super::look::{Look, is_worth};
use super::specular::{Seen, Specular};
use super::thin::Pane;
use super::{BsdfSample, Lambert, Proposal, Response};
use crate::scene::Interior;
use glam::{Vec2, Vec3};

/// What a `StandardMaterial` says at one point, textures looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::trace) struct StandardParameters {
    pub(in crate::trace) base_colour: Vec3,
    pub(in crate::trace) metallic: f32,
    pub(in crate::trace) perceptual_roughness: f32,
    pub(in crate::trace) reflectance: f32,
    pub(in crate::trace) specular_tint: Vec3,
    pub(in crate::trace) specular_transmission: f32,
    /// Index of refraction on the far side over that on the near one.
    pub(in crate::trace) eta: f32,
    pub(in crate::trace) interior: Interior,
    pub(in crate::trace) diffuse_transmission: f32,
    pub(in crate::trace) clearcoat: f32,
    pub(in crate::trace) clearcoat_perceptual_roughness: f32,
}

/// The lobes of a `StandardMaterial`.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Standard<'a> {
    coat: Clearcoat<'a>,
    specular: Specular<'a>,
    /// What the specular lobe leaves on average; nothing below it if that is nothing.
    average_left: Vec3,
    diffuse: Lambert,
    diffuser: DiffuseTransmission,
    glass: Glass<'a>,
    /// The part that is glass.
    clear: f32,
}

/// What a clear surface is made of.
#[derive(Clone, Copy, Debug)]
enum Glass<'a> {
    Pane(Pane<'a>),
    Body(Dielectric<'a>),
}

/// The chance of each lobe; together 1.
#[derive(Clone, Copy, Debug)]
struct Chances {
    coat: f32,
    specular: f32,
    diffuse: f32,
    diffuser: f32,
    glass: f32,
}

/// Which lobe a sample comes from.
#[derive(Clone, Copy, Debug)]
enum Lobe {
    Coat,
    Specular,
    Diffuse,
    Diffuser,
    Glass,
}

impl<'a> Standard<'a> {
    /// The lobes at one point.
    pub(in crate::trace) fn new(at: &StandardParameters, tables: &'a AlbedoTables) -> Self {
        let dielectric = 0.16 * at.reflectance * at.reflectance * at.specular_tint;
        let specular =
            Specular::new(Schlick::new(dielectric.lerp(at.base_colour, at.metallic)), at.perceptual_roughness, tables);
        let diffuse = at.base_colour * (1.0 - at.metallic);
        let glass = match at.interior {
            Interior::ThinWalled => {
                Glass::Pane(Pane::new(Schlick::new(dielectric), at.base_colour, at.perceptual_roughness, tables))
            }
            Interior::Volume { .. } => {
                Glass::Body(Dielectric::new(at.eta, at.base_colour, at.perceptual_roughness, tables))
            }
        };
        Self {
            coat: Clearcoat::new(at.clearcoat, at.clearcoat_perceptual_roughness, tables),
            specular,
            average_left: (Vec3::ONE - specular.average_albedo()).max(Vec3::splat(1e-6)),
            diffuse: Lambert { albedo: diffuse * (1.0 - at.diffuse_transmission) },
            diffuser: DiffuseTransmission { albedo: diffuse * at.diffuse_transmission },
            glass,
            clear: at.specular_transmission * (1.0 - at.metallic),
        }
    }

    /// The share that crosses unscattered at this cosine to the normal: of a smooth pane. Not part of the rest.
    #[inline]
    pub(in crate::trace) fn straight(&self, cos: f32) -> Vec3 {
        match &self.glass {
            Glass::Pane(pane) if self.clear > 0.0 => self.clear * (1.0 - self.coat.albedo(cos)) * pane.straight(cos),
            _ => Vec3::ZERO,
        }
    }

    #[inline]
    pub(super) fn sample(&self, wo: Vec3, [u, v, u_choice]: [f32; 3]) -> Option<BsdfSample> {
        let view = View::new(self, wo)?;
        let (lobe, chance, u_choice) = view.chances.choose(u_choice);
        let u = [u, v, u_choice];
        let proposal = match lobe {
            Lobe::Coat => self.coat.propose(wo, u)?,
            Lobe::Specular => self.specular.propose(wo, u, &view.specular)?,
            Lobe::Diffuse => Proposal::Spread(self.diffuse.sample(Vec2::new(u[0], u[1])).wi),
            Lobe::Diffuser => Proposal::Spread(self.diffuser.sample(Vec2::new(u[0], u[1])).wi),
            Lobe::Glass => self.glass.propose(wo, u)?,
        };
        match proposal {
            Proposal::Spread(wi) => self.respond_seen(&view, wi).sample(wi),
            Proposal::Single(sample) => {
                let share = self.share(lobe, &view, sample.wi) / chance;
                Some(BsdfSample { weight: sample.weight * share, ..sample })
            }
        }
    }

    #[inline]
    pub(super) fn respond(&self, wo: Vec3, wi: Vec3) -> Response {
        View::new(self, wo).map_or(Response::default(), |view| self.respond_seen(&view, wi))
    }

    /// An estimate of the light that is scattered over that which arrives, as energy.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Vec3 {
        let [coat, specular, diffuse, diffuser, glass] =
            self.albedos(wo, self.coat.albedo(wo.z), &self.specular.seen(wo.z));
        coat + specular + diffuse + diffuser + glass
    }

    /// Whether there is a lobe that is spread out.
    #[inline]
    pub(super) fn has_smooth(&self) -> bool {
        let opaque = self.diffuse.albedo != Vec3::ZERO || self.specular.is_smooth_lobe();
        self.coat.is_smooth_lobe() || self.transmits() || self.clear < 1.0 && opaque
    }

    /// By how much radiance is more concentrated behind the surface than before it.
    #[inline]
    pub(super) fn concentration(&self) -> f32 {
        match &self.glass {
            Glass::Body(glass) if self.clear > 0.0 => glass.concentration(),
            _ => 1.0,
        }
    }

    /// Whether light from the far side is spread out.
    #[inline]
    pub(super) fn transmits(&self) -> bool {
        self.clear < 1.0 && self.diffuser.albedo != Vec3::ZERO || self.clear > 0.0 && self.glass.is_smooth_lobe()
    }

    /// How what lies below all coats looks; `None` if there is too little of it.
    #[inline]
    pub(super) fn look(&self) -> Option<Look<'a>> {
        let opaque = 1.0 - self.clear;
        let matt = opaque * (self.diffuse.albedo + self.diffuser.albedo) * self.average_left;
        let rest = opaque * (Vec3::ONE - self.average_left) + self.clear;
        is_worth(matt, rest).then_some(Look::under(self.specular, self.coat))
    }

    /// What that scatters, times |cos θi| [1/sr], less its look.
    #[inline]
    pub(super) fn matt(&self, wi: Vec3) -> Vec3 {
        let base = if wi.z > 0.0 { self.diffuse.evaluate(wi) } else { self.diffuser.evaluate(wi) };
        (1.0 - self.clear) * base * Look::under(self.specular, self.coat).from(wi.z.abs()) / self.average_left
    }

    #[inline]
    fn respond_seen(&self, view: &View, wi: Vec3) -> Response {
        let (wo, chances, cos) = (view.wo, &view.chances, wi.z.abs());
        let coat_i = self.coat.albedo(cos);
        let mut pdf = chances.diffuse * self.diffuse.pdf(wi) + chances.diffuser * self.diffuser.pdf(wi);
        let mut value = Vec3::ZERO;
        if self.clear < 1.0 {
            let seen_i = self.specular.seen(cos);
            let specular = self.specular.respond([wo, wi], [&view.specular, &seen_i]);
            let base = if wi.z > 0.0 { self.diffuse.evaluate(wi) } else { self.diffuser.evaluate(wi) };
            let left = |seen: &Seen| (Vec3::ONE - seen.albedo).max(Vec3::ZERO);
            let diffuse = base * left(&view.specular) * left(&seen_i) / self.average_left;
            value += (1.0 - self.clear) * (specular.value + diffuse);
            pdf += chances.specular * specular.pdf;
        }
        if self.clear > 0.0 {
            let glass = self.glass.respond(wo, wi);
            value += self.clear * glass.value;
            pdf += chances.glass * glass.pdf;
        }
        value *= Clearcoat::leaves(view.coat, coat_i);
        if chances.coat > 0.0 {
            let coat = self.coat.respond(wo, wi);
            value += coat.value;
            pdf += chances.coat * coat.pdf;
        }
        Response { value, pdf }
    }

    /// The part of the surface that a lobe without spread belongs to, less what the coat takes.
    #[inline]
    fn share(&self, lobe: Lobe, view: &View, wi: Vec3) -> f32 {
        let leaves = Clearcoat::leaves(view.coat, self.coat.albedo(wi.z.abs()));
        match lobe {
            Lobe::Coat => 1.0,
            Lobe::Specular | Lobe::Diffuse | Lobe::Diffuser => leaves * (1.0 - self.clear),
            Lobe::Glass => leaves * self.clear,
        }
    }

    /// About what each lobe scatters.
    #[inline]
    fn albedos(&self, wo: Vec3, coat: f32, specular: &Seen) -> [Vec3; 5] {
        let leaves = 1.0 - coat;
        let (opaque, clear) = (leaves * (1.0 - self.clear), leaves * self.clear);
        let left = (Vec3::ONE - specular.albedo).max(Vec3::ZERO) * opaque;
        let glass = if clear > 0.0 { clear * self.glass.albedo(wo) } else { Vec3::ZERO };
        [Vec3::splat(coat), opaque * specular.albedo, left * self.diffuse.albedo, left * self.diffuser.albedo, glass]
    }
}

/// What depends on `wo` alone.
#[derive(Clone, Copy, Debug)]
struct View {
    wo: Vec3,
    /// Albedo of the clear coat.
    coat: f32,
    specular: Seen,
    chances: Chances,
}

impl View {
    /// `None` if nothing is scattered.
    #[inline]
    fn new(standard: &Standard, wo: Vec3) -> Option<Self> {
        if wo.z <= 0.0 {
            return None;
        }
        let (coat, specular) = (standard.coat.albedo(wo.z), standard.specular.seen(wo.z));
        let chances = Chances::new(standard.albedos(wo, coat, &specular))?;
        Some(Self { wo, coat, specular, chances })
    }
}

impl Glass<'_> {
    #[inline]
    fn propose(&self, wo: Vec3, u: [f32; 3]) -> Option<Proposal> {
        match self {
            Self::Pane(pane) => pane.propose(wo, u),
            Self::Body(body) => body.propose(wo, u),
        }
    }

    #[inline]
    fn respond(&self, wo: Vec3, wi: Vec3) -> Response {
        match self {
            Self::Pane(pane) => pane.respond(wo, wi),
            Self::Body(body) => body.respond(wo, wi),
        }
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Vec3 {
        match self {
            Self::Pane(pane) => pane.albedo(wo.z),
            Self::Body(body) => body.albedo(wo),
        }
    }

    #[inline]
    fn is_smooth_lobe(&self) -> bool {
        match self {
            Self::Pane(pane) => pane.is_smooth_lobe(),
            Self::Body(body) => body.is_smooth_lobe(),
        }
    }
}

impl Chances {
    /// In proportion to albedos; `None` if all are 0.
    #[inline]
    fn new(albedos: [Vec3; 5]) -> Option<Self> {
        let [coat, specular, diffuse, diffuser, glass] = albedos.map(Vec3::element_sum);
        let sum = coat + specular + diffuse + diffuser + glass;
        let of = |albedo: f32| albedo / sum;
        (sum > 0.0).then(|| Self {
            coat: of(coat),
            specular: of(specular),
            diffuse: of(diffuse),
            diffuser: of(diffuser),
            glass: of(glass),
        })
    }

    /// A lobe, its chance, and what is left of the variate, uniform again.
    #[inline]
    fn choose(&self, u: f32) -> (Lobe, f32, f32) {
        let lobes = [
            (Lobe::Diffuse, self.diffuse),
            (Lobe::Specular, self.specular),
            (Lobe::Coat, self.coat),
            (Lobe::Diffuser, self.diffuser),
            (Lobe::Glass, self.glass),
        ];
        let mut left = u;
        let mut last = (Lobe::Diffuse, self.diffuse, 0.0);
        for (lobe, chance) in lobes.into_iter().filter(|(_, chance)| *chance > 0.0) {
            last = (lobe, chance, (left / chance).clamp(0.0, BELOW_ONE));
            if left < chance {
                break;
            }
            left -= chance;
        }
        last
    }
}

/// The largest number below 1.
const BELOW_ONE: f32 = 1.0 - 0.5 * f32::EPSILON;
