//! What a request says, and what it gets wrong.

use crate::plugin::{
    BakeGoal, BakeId, BakeLightmaps, BakeScope, BakeView, BakeVolumes, LightmapFormat, LightmapLayout,
};
use bevy::remote::error_codes::INVALID_PARAMS;
use bevy::remote::{BrpError, BrpResult};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::time::Duration;

/// A bake in another process's words. What is left out is as [`NextBake`](crate::plugin::NextBake) has it.
#[derive(Deserialize, Default, Debug, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub(super) struct BakeParams {
    /// Error of every texel, 0.02 is 2 %. At most one of this, `spp` and `time`.
    error: Option<f64>,
    /// Paths per texel.
    spp: Option<u32>,
    /// Time that tracing may take [s].
    time: Option<f64>,
    /// Texels per metre.
    density: Option<f32>,
    /// Size of one atlas for the whole scene, laid out in UV1 by its artist [texels].
    shared: Option<u32>,
    max_page_size: Option<u32>,
    max_bounces: Option<u32>,
    clamp: Option<f32>,
    seed: Option<u64>,
    threads: Option<u32>,
    scope: Option<Scope>,
    view: Option<View>,
    format: Option<Format>,
    volumes: Option<Volumes>,
    /// Side of a cell of volumes that nobody has placed [m].
    volume_spacing: Option<f32>,
}

#[derive(Deserialize, Clone, Copy, Debug, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Scope {
    Changes,
    Everything,
}

#[derive(Deserialize, Clone, Copy, Debug, PartialEq)]
#[serde(rename_all = "snake_case")]
enum View {
    Live,
    WhenDone,
}

#[derive(Deserialize, Clone, Copy, Debug, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Format {
    Rgb9e5,
    Rgba16f,
}

#[derive(Deserialize, Clone, Copy, Debug, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Volumes {
    WhereCalledFor,
    Always,
    Never,
}

impl BakeParams {
    /// The bake that this asks for where these settings are the rest. Whether its numbers can be baked is the baker's
    /// to say.
    pub(super) fn over(&self, rest: BakeLightmaps) -> BrpResult<BakeLightmaps> {
        let goal =
            match (self.error, self.spp, self.time) {
                (None, None, None) => rest.goal,
                (Some(error), None, None) => BakeGoal::Error(error),
                (None, Some(paths), None) => BakeGoal::Samples(paths),
                (None, None, Some(seconds)) => BakeGoal::Time(Duration::try_from_secs_f64(seconds).map_err(|_| {
                    invalid(format!("time is {seconds}, which is no time; give it in seconds, 0 or more"))
                })?),
                _ => return Err(invalid("error, spp and time are three goals; give one of them".to_owned())),
            };
        let scope = self.scope.map(|scope| match scope {
            Scope::Changes => BakeScope::Changes,
            Scope::Everything => BakeScope::Everything,
        });
        let view = self.view.map(|view| match view {
            View::Live => BakeView::Live,
            View::WhenDone => BakeView::WhenDone,
        });
        let format = self.format.map(|format| match format {
            Format::Rgb9e5 => LightmapFormat::Rgb9e5,
            Format::Rgba16f => LightmapFormat::Rgba16f,
        });
        let volumes = self.volumes.map(|volumes| match volumes {
            Volumes::WhereCalledFor => BakeVolumes::WhereCalledFor,
            Volumes::Always => BakeVolumes::Always,
            Volumes::Never => BakeVolumes::Never,
        });
        Ok(BakeLightmaps {
            goal,
            density: self.density.unwrap_or(rest.density),
            layout: self.shared.map_or(rest.layout, |size| LightmapLayout::Shared { size }),
            max_page_size: self.max_page_size.unwrap_or(rest.max_page_size),
            max_bounces: self.max_bounces.or(rest.max_bounces),
            clamp: self.clamp.or(rest.clamp),
            seed: self.seed.unwrap_or(rest.seed),
            threads: self.threads.unwrap_or(rest.threads),
            scope: scope.unwrap_or(rest.scope),
            view: view.unwrap_or(rest.view),
            format: format.unwrap_or(rest.format),
            volumes: volumes.unwrap_or(rest.volumes),
            volume_spacing: self.volume_spacing.or(rest.volume_spacing),
            ..rest
        })
    }
}

/// Whose progress is asked for.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub(super) struct ProgressParams {
    #[serde(deserialize_with = "number")]
    pub(super) job: Option<BakeId>,
}

fn number<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Option<BakeId>, D::Error> {
    Ok(Option::<u64>::deserialize(from)?.map(BakeId))
}

/// Parameters by name; none at all is an empty set of them.
pub(super) fn read<T: DeserializeOwned>(params: Option<Value>) -> BrpResult<T> {
    let params = match params {
        None | Some(Value::Null) => Value::Object(Map::new()),
        Some(params @ Value::Object(_)) => params,
        Some(_) => return Err(invalid("give parameters by name, as an object".to_owned())),
    };
    serde_json::from_value(params).map_err(|error| invalid(error.to_string()))
}

fn invalid(message: String) -> BrpError {
    BrpError { code: INVALID_PARAMS, message, data: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn bake(params: Value) -> BrpResult<BakeLightmaps> {
        read::<BakeParams>(Some(params))?.over(BakeLightmaps { seed: 9, ..Default::default() })
    }

    #[test]
    fn what_is_left_out_stays_as_it_was() {
        let rest = BakeLightmaps { seed: 9, ..Default::default() };
        assert_eq!(bake(json!({})).unwrap(), rest);
        assert_eq!(read::<BakeParams>(None).unwrap(), BakeParams::default());
        let asked = bake(json!({"spp": 4, "density": 2.5, "shared": 64, "scope": "everything", "view": "when_done"}));
        let expected = BakeLightmaps {
            goal: BakeGoal::Samples(4),
            density: 2.5,
            layout: LightmapLayout::Shared { size: 64 },
            scope: BakeScope::Everything,
            view: BakeView::WhenDone,
            ..rest
        };
        assert_eq!(asked.unwrap(), expected);
        let volumes = bake(json!({"volumes": "never", "volume_spacing": 0.5})).unwrap();
        assert_eq!((volumes.volumes, volumes.volume_spacing), (BakeVolumes::Never, Some(0.5)));
        assert_eq!(bake(json!({"time": 1.5})).unwrap().goal, BakeGoal::Time(Duration::from_millis(1500)));
        assert_eq!(bake(json!({"error": 0.1})).unwrap().goal, BakeGoal::Error(0.1));
    }

    #[test]
    fn what_is_wrong_is_said_in_words() {
        for (params, word) in [
            (json!({"error": 0.1, "spp": 4}), "one of them"),
            (json!({"time": -1.0}), "seconds"),
            (json!({"spp": -4}), "u32"),
            (json!({"colour": "red"}), "colour"),
            (json!({"scope": "half"}), "everything"),
            (json!([1, 2]), "by name"),
        ] {
            let error = bake(params.clone()).unwrap_err();
            assert!(error.code == INVALID_PARAMS && error.message.contains(word), "{params}: {error:?}");
        }
    }
}
