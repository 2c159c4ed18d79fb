//! Values of options from text.

use crate::args::Bounces;
use bevy::camera::visibility::RenderLayers;
use bevy_kiln::plugin::EmissiveUnit;
use bevy_kiln::trace::Effect;
use glam::Vec3;
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Duration;

pub(crate) fn emissive(text: &str) -> Result<EmissiveUnit, String> {
    let unknown = || "use nits, displayed or displayed=EV100, such as displayed=9.7".to_owned();
    match text {
        "nits" => Ok(EmissiveUnit::Nits),
        "displayed" => Ok(EmissiveUnit::default()),
        _ => {
            let ev100 = text.strip_prefix("displayed=").ok_or_else(unknown)?;
            Ok(EmissiveUnit::AsDisplayed { ev100: finite(ev100).ok_or_else(unknown)? })
        }
    }
}

pub(crate) fn point(text: &str) -> Result<Vec3, String> {
    let parts: Option<Vec<f32>> = text.split(',').map(|part| finite(part.trim())).collect();
    match parts.as_deref() {
        Some(&[x, y, z]) => Ok(Vec3::new(x, y, z)),
        _ => Err("give three numbers with commas between, such as 1,2.5,-3".to_owned()),
    }
}

pub(crate) fn sky(text: &str) -> Result<Vec3, String> {
    let sky = point(text)?;
    if sky.min_element() < 0.0 { Err("a sky cannot shine less than 0".to_owned()) } else { Ok(sky) }
}

pub(crate) fn max_bounces(text: &str) -> Result<Bounces, String> {
    if text == "none" {
        return Ok(Bounces(None));
    }
    text.parse().map(|bounces| Bounces(Some(bounces))).map_err(|_| "give a whole number, or none for no cap".to_owned())
}

pub(crate) fn count(text: &str) -> Result<NonZeroU32, String> {
    text.parse().map_err(|_| format!("give a whole number from 1 to {}", u32::MAX))
}

pub(crate) fn error(text: &str) -> Result<f64, String> {
    let number = |text: &str| text.trim().parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    let share = match text.strip_suffix('%') {
        Some(percent) => number(percent).map(|percent| percent / 100.0),
        // A plain 2 could be meant as 2 % or as twice the value.
        None => number(text).filter(|share| *share < 1.0),
    };
    share.ok_or_else(|| "give a share of the value, such as 2% or 0.02".to_owned())
}

pub(crate) fn time(text: &str) -> Result<Duration, String> {
    let unknown = || "give a time with its unit, such as 90s, 5m or 1.5h".to_owned();
    let (number, unit) = text.split_at(text.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(unknown)?);
    let seconds = match unit {
        "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(unknown()),
    };
    let number: f64 = number.trim().parse().map_err(|_| unknown())?;
    Duration::try_from_secs_f64(number * seconds).ok().filter(|time| !time.is_zero()).ok_or_else(unknown)
}

pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "give a whole number of 1 or more, or leave it out for all cores".to_owned())
}

pub(crate) fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("give a whole number from 0 to {}", u64::MAX))
}

pub(crate) fn clamp(text: &str) -> Result<f32, String> {
    let most = finite(text).filter(|&most| most > 0.0);
    most.ok_or_else(|| "give a radiance above 0, or leave it out to clamp nothing".to_owned())
}

pub(crate) fn effect(text: &str) -> Result<Effect, String> {
    Effect::from_name(text).ok_or_else(|| {
        let names: Vec<&str> = Effect::ALL.into_iter().map(Effect::name).collect();
        format!("there is no such effect; there are {}", names.join(", "))
    })
}

/// Bevy keeps a bit for each layer up to the last one, so that there is an end to them here.
const LAST_LAYER: usize = 1023;

pub(crate) fn layers(text: &str) -> Result<RenderLayers, String> {
    let layer = |part: &str| part.trim().parse().ok().filter(|&layer: &usize| layer <= LAST_LAYER);
    let layers: Option<Vec<usize>> = text.split(',').map(layer).collect();
    let layers = layers.ok_or_else(|| format!("give whole numbers from 0 to {LAST_LAYER} with commas between: 0,2"))?;
    Ok(RenderLayers::from_layers(&layers))
}

pub(crate) fn fov(text: &str) -> Result<f32, String> {
    let degrees = finite(text).filter(|&degrees| degrees > 0.0 && degrees < 180.0);
    degrees.ok_or_else(|| "give an angle between 0 and 180 degrees".to_owned())
}

pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |part: &str| part.parse().ok().filter(|side| (1..=16384).contains(side));
    let sides = text.split_once(['x', 'X', '×']).and_then(|(width, height)| Some((side(width)?, side(height)?)));
    sides.ok_or_else(|| "give two whole numbers from 1 to 16384, such as 640x480".to_owned())
}

fn finite(text: &str) -> Option<f32> {
    text.parse().ok().filter(|number: &f32| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_what_is_none() {
        assert_eq!(emissive("displayed=3"), Ok(EmissiveUnit::AsDisplayed { ev100: 3.0 }));
        assert_eq!(emissive("displayed"), Ok(EmissiveUnit::AsDisplayed { ev100: 9.7 }));
        assert!(emissive("lux").is_err() && emissive("displayed=nan").is_err());
        assert_eq!(point("1, -2,3e1"), Ok(Vec3::new(1.0, -2.0, 30.0)));
        assert!(point("1,2").is_err() && point("1,2,inf").is_err() && sky("0,-1,0").is_err());
        assert_eq!(max_bounces("none").map(|b| b.0), Ok(None));
        assert_eq!(max_bounces("0").map(|b| b.0), Ok(Some(0)));
        assert!(max_bounces("-1").is_err());
        assert!(count("0").is_err() && count("7").is_ok_and(|n| n.get() == 7) && threads("0").is_err());
        assert_eq!((error("2%"), error("0.5 %"), error("0.02")), (Ok(0.02), Ok(0.005), Ok(0.02)));
        assert!(["2", "-2%", "0%", "nan%", "", "%"].into_iter().all(|text| error(text).is_err()));
        let seconds = |text| time(text).map(|time| time.as_secs_f64());
        assert_eq!((seconds("90s"), seconds("5m"), seconds("1.5h")), (Ok(90.0), Ok(300.0), Ok(5400.0)));
        assert!(["5", "m", "-5m", "0s", "5 parsecs", "1e99h"].into_iter().all(|text| time(text).is_err()));
        assert!(seed("-1").is_err() && seed("18446744073709551615") == Ok(u64::MAX));
        assert_eq!(size("640x480"), Ok((640, 480)));
        assert!(size("0x1").is_err() && size("640").is_err());
        assert_eq!(effect("cut-outs"), Ok(Effect::CutOuts));
        assert!(effect("magic").is_err_and(|error| error.contains("clear-panes")));
        assert!(clamp("0").is_err() && clamp("3") == Ok(3.0));
        assert_eq!(layers("0, 2"), Ok(RenderLayers::from_layers(&[2, 0])));
        assert!(["", "-1", "1024", "0;2", "0,,2"].into_iter().all(|text| layers(text).is_err()));
        assert!(fov("180").is_err() && fov("45").is_ok());
    }
}
