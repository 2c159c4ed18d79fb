//! A bake on screen while it is made: hears texels on the baker's threads, encodes them there, and hands the main thread
//! whole textures to copy, a few times a second at most.
//!
//! Bevy uploads a texture as a whole when it changes, so large ones are shown less often: a copy takes no more than a
//! hundredth or so of the time between two.

use super::events::{BakeView, LightmapFormat};
use super::write_back::texel_format;
use crate::bake::{Lightmap, LiveSink, Page, Progress, ProgressSink};
use crate::output::{TexelFormat, texel_bytes};
use bevy::prelude::*;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time between two looks of a texture of up to [`SMALL`] bytes; larger ones take longer in proportion.
const BETWEEN_LOOKS: Duration = Duration::from_millis(200);
const SMALL: usize = 4 << 20;

/// What a bake shows of itself while it runs, and how far it is.
pub(super) struct LiveView {
    view: BakeView,
    format: TexelFormat,
    viewpoint: Option<Vec3>,
    heard: Mutex<Heard>,
}

#[derive(Default)]
struct Heard {
    progress: Option<Progress>,
    coarse: Option<Arc<Lightmap>>,
    textures: Vec<Texture>,
}

/// A page as its texture holds it.
#[derive(Default)]
struct Texture {
    bytes: Vec<u8>,
    has_news: bool,
    last_look: Option<Instant>,
}

impl LiveView {
    /// A view from this place, in textures of this format.
    pub(super) fn new(viewpoint: Option<Vec3>, format: LightmapFormat, view: BakeView) -> Self {
        Self { view, format: texel_format(format), viewpoint, heard: Mutex::default() }
    }

    /// How far the bake is, if there is news.
    pub(super) fn progress(&self) -> Option<Progress> {
        self.heard().progress.take()
    }

    /// The whole map in coarse, once it is there.
    pub(super) fn coarse(&self) -> Option<Arc<Lightmap>> {
        self.heard().coarse.take()
    }

    /// Textures that are due to be shown: number of the page, and its bytes.
    pub(super) fn due(&self, now: Instant) -> Vec<(usize, Vec<u8>)> {
        let mut heard = self.heard();
        let due = heard.textures.iter_mut().enumerate().filter(|(_, texture)| {
            let pause = BETWEEN_LOOKS.mul_f64((texture.bytes.len() as f64 / SMALL as f64).max(1.0));
            texture.has_news && texture.last_look.is_none_or(|last| now.duration_since(last) >= pause)
        });
        due.map(|(page, texture)| {
            (texture.has_news, texture.last_look) = (false, Some(now));
            (page, texture.bytes.clone())
        })
        .collect()
    }

    fn heard(&self) -> MutexGuard<'_, Heard> {
        self.heard.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ProgressSink for LiveView {
    fn report(&self, progress: Progress) {
        self.heard().progress = Some(progress);
    }

    fn live(&self) -> Option<&dyn LiveSink> {
        match self.view {
            BakeView::Live => Some(self),
            BakeView::WhenDone => None,
        }
    }
}

impl LiveSink for LiveView {
    fn viewpoint(&self) -> Option<Vec3> {
        self.viewpoint
    }

    fn preview(&self, coarse: Lightmap) {
        let texture = |page: &Page| Texture { bytes: texel_bytes(page, self.format).bytes, ..Texture::default() };
        let textures = coarse.pages.iter().map(texture).collect();
        let mut heard = self.heard();
        heard.textures = textures;
        heard.coarse = Some(Arc::new(coarse));
    }

    fn measured(&self, page: u32, texels: &[(u32, Vec3)]) {
        let of_texels = Page {
            width: texels.len() as u32,
            height: 1,
            radiance: texels.iter().map(|&(_, radiance)| radiance).collect(),
            coverage: vec![1.0; texels.len()],
            ..Page::default()
        };
        let encoded = texel_bytes(&of_texels, self.format).bytes;
        let Some(size) = encoded.len().checked_div(texels.len()) else { return };
        let mut heard = self.heard();
        let Some(texture) = heard.textures.get_mut(page as usize) else { return };
        for (&(index, _), bytes) in texels.iter().zip(encoded.chunks_exact(size)) {
            let at = index as usize * size;
            if let Some(place) = texture.bytes.get_mut(at..at + size) {
                place.copy_from_slice(bytes);
            }
        }
        texture.has_news = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(radiance: f32) -> Page {
        Page {
            width: 4,
            height: 2,
            radiance: vec![Vec3::splat(radiance); 8],
            coverage: vec![1.0; 8],
            ..Page::default()
        }
    }

    fn lightmap(pages: Vec<Page>) -> Lightmap {
        Lightmap {
            pages,
            placements: Vec::new(),
            meshes: Vec::new(),
            baked_lights: Vec::new(),
            report: Default::default(),
        }
    }

    #[test]
    fn texels_go_where_they_belong_and_are_shown_now_and_then() {
        for format in [LightmapFormat::Rgb9e5, LightmapFormat::Rgba16f] {
            let view = LiveView::new(None, format, BakeView::Live);
            let start = Instant::now();
            view.measured(0, &[(1, Vec3::ONE)]);
            assert!(view.coarse().is_none() && view.due(start).is_empty(), "nothing before the whole");
            view.preview(lightmap(vec![page(0.5), page(0.25)]));
            assert!(view.coarse().is_some() && view.coarse().is_none());
            assert!(view.due(start).is_empty(), "the coarse map is shown by itself");

            view.measured(1, &[(6, Vec3::new(2.0, 1.0, 0.5)), (0, Vec3::ZERO), (99, Vec3::ONE)]);
            let mut expected = page(0.25);
            (expected.radiance[6], expected.radiance[0]) = (Vec3::new(2.0, 1.0, 0.5), Vec3::ZERO);
            let bytes = texel_bytes(&expected, texel_format(format)).bytes;
            assert_eq!(view.due(start), [(1, bytes)]);
            assert!(view.due(start).is_empty(), "no news");
            view.measured(1, &[(2, Vec3::ONE)]);
            assert!(view.due(start + BETWEEN_LOOKS / 2).is_empty(), "too soon");
            assert_eq!(view.due(start + BETWEEN_LOOKS).len(), 1);
        }
    }
}
