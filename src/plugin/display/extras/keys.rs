//! The custom properties whose names begin with `kiln_`, read from their JSON. What is misspelt or of the wrong kind
//! becomes an [`ExtrasFault`]; properties of other names are somebody else's.

use super::Owner;
use crate::plugin::LightBaking;
use bevy::prelude::*;
use serde_json::{Map, Value};
use std::fmt::{Display, Formatter};

/// What the names of all properties that are read here begin with.
const PREFIX: &str = "kiln_";

/// All that there are.
const KEYS: [&str; 5] = ["kiln_receive", "kiln_density", "kiln_block", "kiln_volume", "kiln_mode"];

/// The light modes as they are written.
const MODES: [(&str, LightBaking); 4] = [
    ("baked", LightBaking::Baked),
    ("mixed_direct", LightBaking::MixedDirect),
    ("mixed_indirect", LightBaking::MixedIndirect),
    ("real_time", LightBaking::RealTime),
];

/// What is written on an entity; on all that was read, be there anything or not.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub(crate) struct KilnExtras {
    /// Whether it is to have a lightmap.
    pub(crate) receive: Option<bool>,
    /// Texels per metre.
    pub(crate) density: Option<f32>,
    /// Whether it only blocks and reflects.
    pub(crate) block: Option<bool>,
    /// Whether it is the box of an irradiance volume.
    pub(crate) volume: Option<bool>,
    /// How much of a light is baked.
    pub(crate) mode: Option<LightBaking>,
    /// What cannot be read.
    pub(crate) faults: Vec<ExtrasFault>,
}

/// A custom property that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ExtrasFault {
    key: String,
    why: Why,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Why {
    /// There is none of this name.
    Unknown,
    /// Its value is of the wrong kind.
    Value { found: String, wanted: &'static str },
    /// It is of no use on a mesh or a material.
    Misplaced,
}

impl Display for ExtrasFault {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { key, why } = self;
        match why {
            Why::Unknown => {
                write!(f, "has a custom property {key}, which there is not; there are {}", KEYS.join(", "))
            }
            Why::Value { found, wanted } => {
                write!(f, "has {found} as its custom property {key}, which is therefore ignored; give it {wanted}")
            }
            Why::Misplaced => write!(
                f,
                "has a custom property {key} on its mesh or material, where it is ignored; put it on the object"
            ),
        }
    }
}

impl KilnExtras {
    /// Reads the JSON of one thing.
    pub(super) fn parse(text: &str, owner: Owner) -> Self {
        let written: Map<String, Value> = serde_json::from_str(text).unwrap_or_default();
        let mut out = Self::default();
        for (key, value) in written.iter().filter(|(key, _)| key.starts_with(PREFIX)) {
            if let Err(why) = out.take(key, value, owner) {
                out.faults.push(ExtrasFault { key: key.clone(), why });
            }
        }
        out
    }

    fn take(&mut self, key: &str, value: &Value, owner: Owner) -> Result<(), Why> {
        let wrong = |wanted| Why::Value { found: value.to_string(), wanted };
        let switch = || truth(value).ok_or_else(|| wrong("true or false"));
        match key {
            "kiln_receive" => self.receive = Some(switch()?),
            "kiln_block" => self.block = Some(switch()?),
            "kiln_density" => {
                let wanted = "texels per metre: a number above 0";
                self.density = Some(number(value).filter(|&density| density > 0.0).ok_or_else(|| wrong(wanted))?);
            }
            "kiln_volume" | "kiln_mode" if owner != Owner::Thing => return Err(Why::Misplaced),
            "kiln_volume" => self.volume = Some(switch()?),
            "kiln_mode" => {
                let wanted = "\"baked\", \"mixed_direct\", \"mixed_indirect\" or \"real_time\"";
                self.mode = Some(mode(value).ok_or_else(|| wrong(wanted))?);
            }
            _ => return Err(Why::Unknown),
        }
        Ok(())
    }

    /// What is written here, and what is not from elsewhere.
    pub(super) fn or(mut self, other: Self) -> Self {
        let faults = [std::mem::take(&mut self.faults), other.faults.clone()].concat();
        let rest = other.without(&self);
        Self {
            receive: self.receive.or(rest.receive),
            density: self.density.or(rest.density),
            block: self.block.or(rest.block),
            volume: self.volume.or(rest.volume),
            mode: self.mode.or(rest.mode),
            faults,
        }
    }

    /// What is written here on matters of which the other says nothing. Receiving and blocking are one matter.
    pub(super) fn without(self, other: &Self) -> Self {
        let has_role = other.receive.is_some() || other.block.is_some();
        Self {
            receive: self.receive.filter(|_| !has_role),
            density: self.density.filter(|_| other.density.is_none()),
            block: self.block.filter(|_| !has_role),
            volume: self.volume.filter(|_| other.volume.is_none()),
            mode: self.mode.filter(|_| other.mode.is_none()),
            faults: self.faults,
        }
    }
}

/// Blender's older properties have no kind for true and false; there people write 0 and 1.
fn truth(value: &Value) -> Option<bool> {
    let number = value.as_f64();
    value.as_bool().or((number == Some(0.0)).then_some(false)).or((number == Some(1.0)).then_some(true))
}

#[expect(clippy::cast_possible_truncation, reason = "a density has a few digits, and what is too great is not finite")]
fn number(value: &Value) -> Option<f32> {
    value.as_f64().map(|number| number as f32).filter(|number| number.is_finite())
}

/// A mode by its name, in any case, with any or no sign between its words.
fn mode(value: &Value) -> Option<LightBaking> {
    let plain = |text: &str| -> String {
        text.chars().filter(char::is_ascii_alphanumeric).map(|letter| letter.to_ascii_lowercase()).collect()
    };
    let asked = plain(value.as_str()?);
    MODES.into_iter().find(|(name, _)| plain(name) == asked).map(|(_, mode)| mode)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> KilnExtras {
        KilnExtras::parse(text, Owner::Thing)
    }

    #[test]
    fn every_key_is_read() {
        let all = r#"{"kiln_receive": true, "kiln_density": 8, "kiln_block": 0, "kiln_volume": 1.0,
            "kiln_mode": "Mixed Indirect", "colour": [1, 2], "kilns": 3}"#;
        let expected = KilnExtras {
            receive: Some(true),
            density: Some(8.0),
            block: Some(false),
            volume: Some(true),
            mode: Some(LightBaking::MixedIndirect),
            faults: Vec::new(),
        };
        assert_eq!(parse(all), expected);
        for (name, mode) in [("Baked", LightBaking::Baked), ("RealTime", LightBaking::RealTime)] {
            assert_eq!(parse(&format!(r#"{{"kiln_mode": "{name}"}}"#)).mode, Some(mode));
        }
        // The names in Rust are names here.
        for (_, mode) in MODES {
            assert_eq!(parse(&format!(r#"{{"kiln_mode": "{mode:?}"}}"#)).mode, Some(mode));
        }
    }

    #[test]
    fn what_cannot_be_read_is_named_and_changes_nothing() {
        for (text, sentence) in [
            (
                r#"{"kiln_recieve": true}"#,
                "has a custom property kiln_recieve, which there is not; there are kiln_receive, kiln_density, \
                 kiln_block, kiln_volume, kiln_mode",
            ),
            (
                r#"{"kiln_receive": "yes"}"#,
                "has \"yes\" as its custom property kiln_receive, which is therefore ignored; give it true or false",
            ),
            (
                r#"{"kiln_density": -2}"#,
                "has -2 as its custom property kiln_density, which is therefore ignored; give it texels per metre: a \
                 number above 0",
            ),
            (
                r#"{"kiln_mode": "mixed"}"#,
                "has \"mixed\" as its custom property kiln_mode, which is therefore ignored; give it \"baked\", \
                 \"mixed_direct\", \"mixed_indirect\" or \"real_time\"",
            ),
        ] {
            let found = parse(text);
            assert_eq!(found.faults.iter().map(ToString::to_string).collect::<Vec<_>>(), [sentence]);
            assert_eq!(KilnExtras { faults: Vec::new(), ..found }, KilnExtras::default());
        }
        for text in [r#"{"kiln_block": 2}"#, r#"{"kiln_density": 1e99}"#, r#"{"kiln_density": null}"#] {
            assert_eq!(parse(text).faults.len(), 1, "{text}");
        }
        let on_mesh = KilnExtras::parse(r#"{"kiln_mode": "baked", "kiln_density": 2}"#, Owner::Mesh);
        assert!(on_mesh.faults[0].to_string().contains("put it on the object") && on_mesh.density == Some(2.0));
    }

    #[test]
    fn what_is_no_object_holds_nothing() {
        for text in ["", "3", "[]", "null", "\"kiln_receive\""] {
            assert_eq!(parse(text), KilnExtras::default());
        }
    }

    #[test]
    fn the_single_thing_has_the_last_word_and_a_role_is_one_matter() {
        let object = parse(r#"{"kiln_block": true}"#);
        let mesh = KilnExtras::parse(r#"{"kiln_receive": true, "kiln_density": 4}"#, Owner::Mesh);
        let both = object.clone().or(mesh.clone());
        assert_eq!((both.receive, both.block, both.density), (None, Some(true), Some(4.0)));
        assert_eq!(mesh.without(&object), parse(r#"{"kiln_density": 4}"#));
    }
}
