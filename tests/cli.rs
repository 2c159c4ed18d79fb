//! The `kiln` command from outside: exit codes, sentences about bad input, tables and JSON.
#![cfg(feature = "cli")]

#[path = "support/glb.rs"]
mod glb;
#[path = "cli/inputs.rs"]
mod inputs;
#[path = "cli/punctual.rs"]
mod punctual;
#[path = "cli/room.rs"]
mod room;
#[path = "cli/skies.rs"]
mod skies;
#[path = "cli/study.rs"]
mod study;

use bevy_kiln::artefact::Manifest;
use glb::Glb;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use temp_dir::TempDir;

fn data(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file)
}

fn kiln() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kiln"));
    command.env_remove("RUST_BACKTRACE");
    command
}

fn run(arguments: &[&str]) -> Output {
    kiln().args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A bake of a few paths into `folder`.
fn bake(scene: &Path, folder: &Path) -> Output {
    let mut command = kiln();
    command.arg("bake").arg(scene).arg("-o").arg(folder);
    command.args(["--layout", "shared", "--size", "32", "--spp", "16", "--emissive", "nits", "--json"]);
    command.output().unwrap()
}

/// Holds a failure against its exit code and its sentence; a stack trace is no sentence.
fn assert_fails(output: &Output, code: i32, sentence: &str) {
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{stderr}");
    assert!(stderr.contains(sentence), "{stderr:?} does not contain {sentence:?}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    assert!(stderr.lines().all(|line| !line.trim_start().starts_with("1: ")), "{stderr}");
}

/// Spoils the Cornell box and bakes it.
fn bake_spoilt(spoil: impl FnOnce(&mut Glb)) -> (TempDir, Output) {
    let folder = temp_dir::TempDir::new().unwrap();
    let mut glb = Glb::read(&data("cornell.glb"));
    spoil(&mut glb);
    let scene = folder.path().join("spoilt.glb");
    glb.write(&scene);
    let output = bake(&scene, &folder.path().join("out"));
    (folder, output)
}

fn last_json(output: &Output) -> Value {
    let stdout = text(&output.stdout);
    serde_json::from_str(stdout.lines().last().unwrap()).unwrap_or_else(|error| panic!("{error} in {stdout:?}"))
}

fn warnings(output: &Output) -> Vec<String> {
    let json = last_json(output);
    json["warnings"].as_array().unwrap().iter().map(|warning| warning.as_str().unwrap().to_owned()).collect()
}

fn assert_left_out(spoilt: &(TempDir, Output), sentence: &str) {
    let (folder, output) = spoilt;
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let warnings = warnings(output);
    assert_eq!(warnings.iter().filter(|warning| warning.contains(sentence)).count(), 1, "{sentence}: {warnings:?}");
    assert!(text(&output.stderr).contains(sentence));
    assert!(folder.path().join("out/kiln.ron").is_file());
}

#[test]
fn a_sound_bake_writes_a_whole_folder_and_ends_with_its_json() {
    let folder = temp_dir::TempDir::new().unwrap();
    let output = bake(&data("cornell.glb"), &folder.path().join("out"));
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let json = last_json(&output);
    for key in ["texels", "samples", "rays", "cpu_seconds", "wall_seconds", "clamped"] {
        assert!(json[key].is_number(), "{key} in {json}");
    }
    for key in ["mean", "p95", "max"] {
        assert!(json["relative_stderr"][key].is_number(), "{key} in {json}");
    }
    assert!(json.as_object().unwrap().contains_key("energy_balance"));
    let texels = json["texels"].as_u64().unwrap();
    assert_eq!(json["samples"].as_u64(), Some(16 * texels));
    let files: Vec<&str> = json["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    assert!(files.len() >= 3 && files.iter().all(|file| Path::new(file).is_file()), "{files:?}");
    let stderr = text(&output.stderr);
    for part in ["plan", "report", "samples per second", "energy balance"] {
        assert!(stderr.contains(part), "{part} in {stderr}");
    }
    // The lamp has no second UV set, and that is all that is wrong with the box.
    let warnings = warnings(&output);
    assert!(warnings.len() == 1 && warnings[0].contains("light.light\" has no UV1"), "{warnings:?}");
}

/// Volumes where they are asked for: a texture of three dimensions each, which the manifest names.
#[test]
fn volumes_are_written_beside_the_lightmap() {
    let folder = temp_dir::TempDir::new().unwrap();
    let out = folder.path().join("out");
    let (scene, out_name) = (data("cornell.glb"), out.to_str().unwrap());
    let common = ["bake", scene.to_str().unwrap(), "-o", out_name, "--spp", "16", "--density", "2", "--json"];
    let without = run(&common);
    assert_eq!(without.status.code(), Some(0), "{}", text(&without.stderr));
    assert_eq!(last_json(&without)["volumes"].as_array().map(Vec::len), Some(0));
    let with = run(&[&common[..], &["--volumes=0.5"]].concat());
    assert_eq!(with.status.code(), Some(0), "{}", text(&with.stderr));
    let json = last_json(&with);
    let volume = &json["volumes"][0];
    assert_eq!((volume["id"].as_str(), &volume["probes"]), (Some("volume/0"), &serde_json::json!([12, 11, 12])));
    let manifest = Manifest::from_ron(&std::fs::read_to_string(out.join("kiln.ron")).unwrap()).unwrap();
    assert_eq!(manifest.volumes.len(), 1);
    let file = std::fs::read(out.join(&manifest.volumes[0].file)).unwrap();
    let header = ktx2::Reader::new(&file[..]).unwrap().header();
    assert_eq!([header.pixel_width, header.pixel_height, header.pixel_depth], [12, 22, 36]);
    let refused = run(&[&common[..], &["--volumes=-1"]].concat());
    assert_fails(&refused, 2, "a spacing of -1 m cannot be");
}

#[test]
fn without_json_a_person_reads_the_plan_and_the_report_on_standard_output() {
    let folder = temp_dir::TempDir::new().unwrap();
    let scene = data("cornell.glb");
    let mut command = kiln();
    command.arg("bake").arg(scene).arg("-o").arg(folder.path()).args(["--density", "2", "--spp", "16"]);
    let output = command.output().unwrap();
    let stdout = text(&output.stdout);
    let plan = stdout.find("plan").unwrap_or_else(|| panic!("{stdout}"));
    assert!(stdout.find("report").is_some_and(|report| report > plan), "{stdout}");
    assert!(!stdout.contains('{'), "{stdout}");
}

#[test]
fn a_plan_has_the_shape_that_the_contract_says() {
    let output = run(&["plan", data("cornell.glb").to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let json = last_json(&output);
    let effects = json["effects"].as_array().unwrap();
    assert!(!effects.is_empty());
    for effect in effects {
        assert!(effect["effect"].is_string() && effect["on"].is_boolean() && effect["reason"].is_string(), "{effect}");
    }
    for key in ["texels", "pages", "memory_bytes"] {
        assert!(json[key].as_u64().is_some_and(|number| number > 0), "{key} in {json}");
    }
    for prediction in json["predicted"].as_array().unwrap() {
        assert!(prediction["error"].is_number() && prediction["seconds"].is_number(), "{prediction}");
    }
    assert!(json["warnings"].is_array());
}

#[test]
fn the_order_of_meshes_and_nodes_in_the_file_does_not_matter() {
    let (folder, output) = bake_spoilt(|_| {});
    let (shuffled_folder, shuffled) = bake_spoilt(|glb| {
        let meshes = glb.json["meshes"].as_array_mut().unwrap();
        meshes.reverse();
        let last = meshes.len() as u64 - 1;
        for node in glb.json["nodes"].as_array_mut().unwrap() {
            if let Some(mesh) = node["mesh"].as_u64() {
                node["mesh"] = (last - mesh).into();
            }
        }
        glb.json["scenes"][0]["nodes"].as_array_mut().unwrap().reverse();
    });
    assert!(output.status.success() && shuffled.status.success(), "{}", text(&shuffled.stderr));
    let texture = |folder: &TempDir| std::fs::read(folder.path().join("out/lightmap_0.ktx2")).unwrap();
    assert!(texture(&folder) == texture(&shuffled_folder));
    assert_eq!(last_json(&output)["rays"], last_json(&shuffled)["rays"]);
}

#[test]
fn scenes_that_cannot_be_opened() {
    let folder = temp_dir::TempDir::new().unwrap();
    let out = folder.path().join("out");
    assert_fails(&bake(Path::new("no/such.glb"), &out), 1, "there is no file no/such.glb");
    assert_fails(&bake(&data("README.md"), &out), 1, "README.md is no scene");
    let whole = std::fs::read(data("cornell.glb")).unwrap();
    let half = folder.path().join("half.glb");
    std::fs::write(&half, &whole[..whole.len() / 2]).unwrap();
    assert_fails(&bake(&half, &out), 1, "half.glb cannot be loaded");
    assert!(!out.exists(), "nothing may be written");
}

#[test]
fn a_mesh_without_uv1_is_named() {
    let spoilt = bake_spoilt(|glb| {
        glb.primitive("floor")["attributes"].as_object_mut().unwrap().remove("TEXCOORD_1");
    });
    assert_left_out(&spoilt, "floor.white\" has no UV1");
}

#[test]
fn a_position_that_is_no_number_is_named() {
    let spoilt = bake_spoilt(|glb| {
        let positions = glb.primitive("floor")["attributes"]["POSITION"].as_u64().unwrap();
        glb.accessor(positions)[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    });
    assert_left_out(&spoilt, "floor.white\" has a position that is not a finite number (vertex 0)");
}

#[test]
fn an_index_out_of_range_is_named() {
    let spoilt = bake_spoilt(|glb| {
        let indices = glb.primitive("floor")["indices"].as_u64().unwrap();
        glb.accessor(indices)[..4].copy_from_slice(&99_u32.to_le_bytes());
    });
    assert_left_out(&spoilt, "floor.white\" has index 99 but only 4 vertices");
}

#[test]
fn a_light_without_area_is_named_and_leaves_the_scene_dark() {
    let (folder, output) = bake_spoilt(|glb| {
        let positions = glb.primitive("light")["attributes"]["POSITION"].as_u64().unwrap();
        glb.accessor(positions).fill(0);
    });
    assert_fails(&output, 1, "the scene has no light");
    assert!(text(&output.stderr).contains("light.light\" has no triangle with an area"), "{}", text(&output.stderr));
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_scene_of_bevys_own_kind_is_read_and_its_light_without_area_is_named() {
    let folder = temp_dir::TempDir::new().unwrap();
    let scene = folder.path().join("lamp.scn.ron");
    let measure = |width: &str| {
        let lamp = r#"(resources: {}, entities: { 4294967295: (components: {
            "bevy_ecs::name::Name": "lamp",
            "bevy_transform::components::transform::Transform":
                (translation: (0.0, 0.5, 0.0), rotation: (-0.70710677, 0.0, 0.0, 0.70710677), scale: (1.0, 1.0, 1.0)),
            "bevy_light::rect_light::RectLight": (
                color: LinearRgba((red: 1.0, green: 1.0, blue: 1.0, alpha: 1.0)),
                intensity: 100.0, range: 20.0, width: WIDTH, height: 1.0),
        }) })"#;
        std::fs::write(&scene, lamp.replace("WIDTH", width)).unwrap();
        let points = folder.path().join("points.csv");
        std::fs::write(&points, "x,y,z,nx,ny,nz\n0,0,0,0,1,0\n").unwrap();
        let mut command = kiln();
        command.arg("irradiance").arg(&scene).arg("--points").arg(&points).arg("--no-range");
        command.args(["--spp", "4096"]).output().unwrap()
    };
    let output = measure("1.0");
    let stdout = text(&output.stdout);
    let row: Vec<f64> = stdout.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    // A square of radiance 100/π and half-side 1/2 at distance 1/2: E = 4 L · (1/√2) · atan(1/√2) (Lambert).
    let expected = 400.0 / std::f64::consts::PI * 0.5_f64.sqrt() * 0.5_f64.sqrt().atan();
    assert!((row[6] - expected).abs() + 4.0 * row[9] <= 0.01 * expected, "{} is not {expected}", row[6]);
    let output = measure("0.0");
    assert!(text(&output.stderr).contains("light \"lamp\" has no area"), "{}", text(&output.stderr));
}

#[test]
fn the_layers_that_are_asked_for_take_part() {
    let folder = temp_dir::TempDir::new().unwrap();
    let scene = folder.path().join("lamps.scn.ron");
    let lamp = |number: u32, layers: &str| {
        let components = r#""bevy_ecs::name::Name": "lamp NUMBER",
            "bevy_transform::components::transform::Transform":
                (translation: (0.0, 1.0, 0.0), rotation: (0.0, 0.0, 0.0, 1.0), scale: (1.0, 1.0, 1.0)),
            "bevy_light::point_light::PointLight": (
                color: LinearRgba((red: 1.0, green: 1.0, blue: 1.0, alpha: 1.0)), intensity: 100.0, range: 50.0),"#;
        let components = components.replace("NUMBER", &number.to_string());
        format!("{}: (components: {{ {components} {layers} }}),", u32::MAX - number)
    };
    let second = r#""bevy_camera::visibility::render_layers::RenderLayers": ([4]),"#;
    let lamps = [lamp(0, ""), lamp(2, second)].concat();
    std::fs::write(&scene, format!("(resources: {{}}, entities: {{ {lamps} }})")).unwrap();
    let points = folder.path().join("points.csv");
    std::fs::write(&points, "x,y,z,nx,ny,nz\n0,0,0,0,1,0\n").unwrap();
    let measure = |layers: &[&str]| {
        let mut command = kiln();
        command.arg("irradiance").arg(&scene).arg("--points").arg(&points).args(["--no-range", "--spp", "16"]);
        let output = command.args(layers).output().unwrap();
        let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
        let row = stdout.lines().nth(1).unwrap_or_else(|| panic!("{stderr}")).to_owned();
        (row.split(',').nth(6).unwrap().parse::<f64>().unwrap(), stderr)
    };
    // A point light of 100 lm at 1 m, head on.
    let one = 100.0 / (4.0 * std::f64::consts::PI);
    let left_out = |name: &str| format!("\"{name}\" is on render layers that are not baked");
    for (layers, expected, without) in [
        (&[][..], one, Some("lamp 2")),
        (&["--layers", "2"], one, Some("lamp 0")),
        (&["--layers", "0,2"], 2.0 * one, None),
    ] {
        let (found, stderr) = measure(layers);
        assert!((found - expected).abs() <= 1e-4 * expected, "{layers:?}: {found} is not {expected}");
        for name in ["lamp 0", "lamp 2"] {
            assert_eq!(stderr.contains(&left_out(name)), without == Some(name), "{layers:?}: {stderr}");
        }
    }
}

#[test]
fn a_scene_without_light_is_refused() {
    let (folder, output) = bake_spoilt(|glb| {
        for material in glb.json["materials"].as_array_mut().unwrap() {
            material.as_object_mut().unwrap().remove("emissiveFactor");
        }
    });
    assert_fails(&output, 1, "the scene has no light");
    assert!(!folder.path().join("out").exists());
}

#[test]
fn wrong_arguments_and_what_is_not_there_yet() {
    let scene = data("cornell.glb");
    let scene = scene.to_str().unwrap();
    for (arguments, sentence) in [
        (&["bake", scene][..], "--output"),
        (&["bake", scene, "-o", "x", "--density", "0"], "--density"),
        (&["bake", scene, "-o", "x", "--layout", "shared"], "--size"),
        (&["bake", scene, "-o", "x", "--size", "64"], "--layout shared"),
        (&["bake", scene, "-o", "x", "--format", "jpg"], "use rgb9e5, rgba16f, bc6h or exr"),
        (&["bake", scene, "-o", "x", "--emissive", "lumens"], "use nits"),
        (&["bake", scene, "-o", "x", "--resume"], "`--resume` is not there yet"),
        (&["bake", scene, "-o", "x", "--shard", "1/2"], "`--shard` is not there yet"),
        (&["render", scene, "-o", "a.png", "--error", "1%"], "`--error` is not there yet"),
        (&["render", scene, "-o", "a.gif"], "a.gif is no picture"),
        (&["merge", "a", "--b"], "`kiln merge` is not there yet"),
        (&["study", scene], "--output"),
        (&["study", scene, "-o", "x", "--time", "5"], "give a time with its unit"),
    ] {
        assert_fails(&run(arguments), 2, sentence);
    }
}

#[test]
fn a_light_meter_answers_in_the_order_of_its_rows() {
    let folder = temp_dir::TempDir::new().unwrap();
    let points = folder.path().join("points.csv");
    // Other order of columns, a column of the asker's own, and one of the answer's that is to be replaced.
    std::fs::write(&points, "name,nx,ny,nz,x,y,z,e_r\nfar,0,1,0,1.4,0,0.9,7\nunder,0,2,0,0,0,0,8\n").unwrap();
    let mut command = kiln();
    command.arg("irradiance").arg(data("form_factor.glb")).arg("--points").arg(&points);
    command.args(["--emissive", "nits", "--spp", "256"]);
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let stdout = text(&output.stdout);
    let lines: Vec<&str> = stdout.lines().collect();
    assert_eq!(lines[0], "name,nx,ny,nz,x,y,z,e_r,e_g,e_b,se_r,se_g,se_b,samples");
    assert_eq!(lines.len(), 3);
    let row = |line: usize| lines[line].split(',').collect::<Vec<_>>();
    let (far, under) = (row(1), row(2));
    assert_eq!((far[0], under[0], under[13]), ("far", "under", "256"));
    let irradiance = |row: &[&str]| row[7].parse::<f64>().unwrap();
    assert!(irradiance(&far) > 0.0 && irradiance(&under) > irradiance(&far), "{stdout}");
    let digits = |number: &str| number.trim_start_matches(['0', '.']).chars().filter(char::is_ascii_digit).count();
    assert_eq!(digits(under[7]), 9, "{}", under[7]);
    // Written into a file it is the same, and nothing else is left beside it.
    let answer = folder.path().join("answer.csv");
    assert!(command.arg("-o").arg(&answer).output().unwrap().status.success());
    assert_eq!(std::fs::read_to_string(&answer).unwrap(), stdout);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn bad_tables_are_refused_by_row() {
    let folder = temp_dir::TempDir::new().unwrap();
    let points = folder.path().join("points.csv");
    for (table, sentence) in [
        ("x,y,z,nx,ny\n0,0,0,0,1\n", "no column \"nz\""),
        ("x,y,z,nx,ny,nz\n0,0,0,0,1,0\n0,zero,0,0,1,0\n", "row 2: y is \"zero\""),
        ("x,y,z,nx,ny,nz\nNaN,0,0,0,1,0\n", "row 1: x is \"NaN\""),
        ("x,y,z,nx,ny,nz\n0,0,0,0,0,0\n", "row 1: its normal"),
        ("x,y,z,nx,ny,nz\n0,0,0\n", "row 1 cannot be read"),
        ("x,y,z,nx,ny,nz\n", "no points"),
    ] {
        std::fs::write(&points, table).unwrap();
        let mut command = kiln();
        command.arg("irradiance").arg(data("form_factor.glb")).arg("--points").arg(&points);
        assert_fails(&command.output().unwrap(), 1, sentence);
    }
}

#[test]
fn a_picture_is_written_and_a_missing_camera_is_named() {
    let folder = temp_dir::TempDir::new().unwrap();
    let picture = folder.path().join("picture.png");
    let scene = data("cornell.glb");
    let mut command = kiln();
    command.arg("render").arg(&scene).arg("-o").arg(&picture).args(["--size", "8x6", "--spp", "16"]);
    assert_fails(&command.output().unwrap(), 1, "the scene has no camera; give --eye");
    let output = command.args(["--eye", "2.7,2.7,-8", "--target", "2.7,2.7,0"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_in_good_order() {
    use std::io::{BufRead, BufReader};
    let folder = temp_dir::TempDir::new().unwrap();
    let out = folder.path().join("out");
    let mut command = kiln();
    command.arg("bake").arg(data("cornell.glb")).arg("-o").arg(&out).args(["--spp", "4000000"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // Once the plan is out the handler is in place, and the bake would take hours.
    let mut line = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_fails(&output, 130, "stopped");
    assert!(!out.exists());
}
