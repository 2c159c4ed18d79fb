//! How far a bake is from a reference: a folder that `--format exr` wrote from the same scene at the same density, with
//! many more samples. Owns reading the reference's measured layer and the comparison; judges nothing.

use crate::bake::{Lightmap, TexelState};
use crate::math::luminance;
use exr::prelude::{ReadChannels, ReadLayers, read};
use glam::DVec3;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// How far a bake is from its reference: root mean square error by Rec. 709 luminance over the reference's mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceError {
    /// Of what was measured.
    pub before: f64,
    /// Of what is shown, after all repair.
    pub after: f64,
    /// Measured texels that were compared.
    pub texels: u64,
}

/// Why there is nothing to compare with.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ReferenceFault {
    /// A page of the reference cannot be read.
    #[error("the reference {} cannot be read ({reason}); bake it with --format exr", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the reader said.
        reason: String,
    },
    /// The reference has other texels.
    #[error(
        "the reference {} has other texels than this bake; bake it from the same scene at the same density and layout",
        path.display()
    )]
    OtherLayout {
        /// The file.
        path: PathBuf,
    },
}

/// Compares a bake with the reference in the folder `dir`.
pub fn compare_with_reference(lightmap: &Lightmap, dir: &Path) -> Result<ReferenceError, ReferenceFault> {
    let (mut sums, mut light, mut texels) = ([0.0; 2], 0.0, 0);
    for (index, page) in lightmap.pages.iter().enumerate() {
        let path = dir.join(format!("lightmap_{index}.exr"));
        let reference = measured(&path)?;
        let is_same =
            |(state, measured): (&TexelState, &Option<DVec3>)| (*state == TexelState::Measured) == measured.is_some();
        let size = [page.width as usize, page.height as usize];
        if reference.size != size || !page.state.iter().zip(&reference.raw).all(is_same) {
            return Err(ReferenceFault::OtherLayout { path });
        }
        for (texel, truth) in reference.raw.iter().enumerate() {
            let Some(truth) = truth else { continue };
            for (sum, found) in sums.iter_mut().zip([page.raw[texel], page.radiance[texel]]) {
                *sum += luminance(found.as_dvec3() - *truth).powi(2);
            }
            light += luminance(*truth);
            texels += 1;
        }
    }
    let count = f64::max(texels as f64, 1.0);
    let [before, after] = sums.map(|sum| if light > 0.0 { (sum / count).sqrt() / (light / count) } else { 0.0 });
    Ok(ReferenceError { before, after, texels })
}

/// What a reference measured, row by row; `None` where a texel was not.
struct Reference {
    size: [usize; 2],
    raw: Vec<Option<DVec3>>,
}

fn measured(path: &Path) -> Result<Reference, ReferenceFault> {
    let unreadable = |reason: String| ReferenceFault::Unreadable { path: path.to_owned(), reason };
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(|error| unreadable(error.to_string()))?;
    let layer = image.layer_data;
    let channel = |name: &str| -> Result<Vec<f32>, ReferenceFault> {
        let found = layer.channel_data.list.iter().find(|channel| channel.name.eq(name));
        let found = found.ok_or_else(|| unreadable(format!("it has no channel {name}")))?;
        Ok(found.sample_data.values_as_f32().collect())
    };
    let [red, green, blue, coverage] = [channel("raw.R")?, channel("raw.G")?, channel("raw.B")?, channel("A")?];
    let texel = |index: usize| {
        let light = DVec3::new(red[index].into(), green[index].into(), blue[index].into());
        (coverage[index] > 0.0).then_some(light)
    };
    Ok(Reference { size: [layer.size.0, layer.size.1], raw: (0..red.len()).map(texel).collect() })
}

#[cfg(test)]
mod tests {
    use super::super::test_pages::{lightmap, page};
    use super::super::{OutputFormat, write_lightmap};
    use super::*;
    use glam::Vec3;

    #[test]
    fn errors_are_relative_to_the_mean_of_the_reference() {
        let folder = temp_dir::TempDir::new().unwrap();
        let mut truth = page(6, 4);
        truth.coverage.fill(1.0);
        truth.raw.fill(Vec3::splat(2.0));
        write_lightmap(&lightmap(vec![truth.clone()]), "truth", folder.path(), OutputFormat::Exr).unwrap();
        let mut noisy = truth;
        noisy.raw.fill(Vec3::splat(2.4));
        noisy.radiance.fill(Vec3::splat(1.9));
        let error = compare_with_reference(&lightmap(vec![noisy.clone()]), folder.path()).unwrap();
        assert!((error.before - 0.2).abs() < 1e-6 && (error.after - 0.05).abs() < 1e-6, "{error:?}");
        assert_eq!(error.texels, 24);

        let other = compare_with_reference(&lightmap(vec![page(4, 6)]), folder.path());
        assert!(matches!(other, Err(ReferenceFault::OtherLayout { .. })), "{other:?}");
        noisy.state[3] = TexelState::Hidden;
        let other = compare_with_reference(&lightmap(vec![noisy.clone()]), folder.path());
        assert!(matches!(other, Err(ReferenceFault::OtherLayout { .. })), "{other:?}");
        let missing = compare_with_reference(&lightmap(vec![noisy]), &folder.path().join("nowhere"));
        assert!(matches!(missing, Err(ReferenceFault::Unreadable { .. })), "{missing:?}");
    }
}
