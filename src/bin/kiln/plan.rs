//! `kiln plan`.

use crate::args::PlanArgs;
use crate::failure::Failure;
use crate::scene;
use crate::talk::{Talk, warn};
use bevy_kiln::bake::{BakePlan, CancelToken};
use serde_json::json;

pub(crate) fn run(args: &PlanArgs, cancel: &CancelToken) -> Result<(), Failure> {
    let settings = scene::bake_settings(&args.scene, &args.layout, &args.goal)?;
    let extraction = scene::open(&args.scene, cancel)?;
    let mut warnings: Vec<String> = extraction.warnings.iter().map(ToString::to_string).collect();
    // First of all, as they may be why there is no plan.
    warn(&warnings);
    let plan = BakePlan::for_scene(&extraction.scene, &settings, &(), cancel)?;
    let planned: Vec<String> = plan.warnings.iter().map(ToString::to_string).collect();
    warn(&planned);
    warnings.extend(planned);
    Talk::beside(args.json).plan(&plan);
    if args.json {
        Talk::Out.say(summary(&plan, &warnings));
    }
    Ok(())
}

fn summary(plan: &BakePlan, warnings: &[String]) -> serde_json::Value {
    let effects = plan.effects.iter().map(|effect| {
        json!({
            "effect": effect.effect.name(),
            "on": effect.on,
            "reason": effect.reason,
            "cost_share": effect.cost_share,
        })
    });
    let predicted =
        plan.predicted.iter().map(|prediction| json!({ "error": prediction.error, "seconds": prediction.seconds }));
    json!({
        "effects": effects.collect::<Vec<_>>(),
        "texels": plan.texels,
        "pages": plan.pages,
        "memory_bytes": plan.memory_bytes,
        "predicted": predicted.collect::<Vec<_>>(),
        "warnings": warnings,
    })
}
