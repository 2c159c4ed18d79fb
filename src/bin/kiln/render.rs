//! `kiln render`.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::progress::Show;
use crate::scene;
use crate::talk::{Talk, warn};
use bevy_kiln::bake::{CancelToken, PictureSettings, render_picture};
use bevy_kiln::output::{Look, write_picture};
use bevy_kiln::scene::{Camera, Scene};

pub(crate) fn run(args: &RenderArgs, cancel: &CancelToken) -> Result<(), Failure> {
    // An hour's work must not end at a wrong letter in a file name.
    let extension = args.output.extension().map(|extension| extension.to_ascii_lowercase());
    if !extension.is_some_and(|extension| extension == "png" || extension == "exr") {
        let path = args.output.display();
        return Err(Failure::Arguments(format!("{path} is no picture that can be written; end it in .png or .exr")));
    }
    let extraction = scene::open_without_lightmaps(&args.scene, cancel)?;
    warn(&extraction.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
    let camera = camera(args, &extraction.scene)?;
    let (width, height) = args.size;
    let settings = PictureSettings {
        transport: scene::transport(&args.scene),
        width,
        height,
        samples_per_pixel: args.spp.get(),
        threads: args.scene.threads,
    };
    let show = Show::new();
    let result = render_picture(&extraction.scene, &camera, &settings, &show, cancel);
    show.end();
    let picture = result?;
    if cancel.is_cancelled() {
        return Err(Failure::Stopped);
    }
    warn(&picture.report.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
    write_picture(&picture, &args.output, Look { ev100: args.ev100, tone: args.tonemapping.into() })
        .map_err(Failure::failed)?;
    Talk::Out.report("pixels", &picture.report);
    Talk::Out.say(format_args!("wrote {}", args.output.display()));
    Ok(())
}

fn camera(args: &RenderArgs, scene: &Scene) -> Result<Camera, Failure> {
    if let (Some(eye), Some(target)) = (args.eye, args.target) {
        if eye == target {
            return Err(Failure::Arguments("--eye and --target are the same point; look at another".to_owned()));
        }
        return Ok(Camera::look_at("command line", eye, target, args.fov.to_radians()));
    }
    let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    let found = match &args.camera {
        None => scene.cameras.first(),
        Some(name) => scene.cameras.iter().find(|camera| camera.name == *name),
    };
    found.cloned().ok_or_else(|| match (&args.camera, names.is_empty()) {
        (_, true) => Failure::Failed("the scene has no camera; give --eye X,Y,Z and --target X,Y,Z".to_owned()),
        (name, false) => {
            let name = name.as_deref().unwrap_or_default();
            Failure::Failed(format!("the scene has no camera \"{name}\"; it has \"{}\"", names.join("\", \"")))
        }
    })
}
