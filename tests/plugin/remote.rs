//! Baking from another process: an HTTP client beside a running app.

use super::*;
use bevy::remote::RemotePlugin;
use bevy::remote::http::RemoteHttpPlugin;
use serde_json::{Value, json};
use std::net::TcpListener;

/// An app with a server, and where that listens.
struct Served {
    app: App,
    port: u16,
}

impl Served {
    fn new(kiln_first: bool) -> Self {
        // Free a moment ago; nobody else on this machine asks for a port by number.
        let port = TcpListener::bind(("127.0.0.1", 0)).unwrap().local_addr().unwrap().port();
        let mut app = App::new();
        app.add_plugins(WindowlessPlugins { asset_folder: data("") });
        let server = (RemotePlugin::default(), RemoteHttpPlugin::default().with_port(port));
        if kiln_first {
            app.add_plugins(KilnPlugin).add_plugins(server);
        } else {
            app.add_plugins(server).add_plugins(KilnPlugin);
        }
        app.finish();
        app.cleanup();
        app.world_mut().run_system_once(spawn_lit_floor).unwrap();
        app.update();
        Self { app, port }
    }

    /// The whole answer to a request.
    fn ask(&mut self, method: &str, params: Value) -> Value {
        let body = json!({ "jsonrpc": "2.0", "id": 1, "method": method, "params": params }).to_string();
        let url = format!("http://127.0.0.1:{}", self.port);
        let client = std::thread::spawn(move || {
            let start = Instant::now();
            loop {
                match minreq::post(&url).with_body(body.as_str()).with_timeout(PATIENCE.as_secs()).send() {
                    Ok(response) => return response.as_str().unwrap().to_owned(),
                    // The server starts on a thread of its own.
                    Err(error) => assert!(start.elapsed() < PATIENCE, "{error}"),
                }
                std::thread::sleep(Duration::from_millis(10));
            }
        });
        run_until(&mut self.app, "the answer", |_| client.is_finished());
        serde_json::from_str(&client.join().unwrap()).unwrap()
    }

    fn result(&mut self, method: &str, params: Value) -> Value {
        let answer = self.ask(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// Asks how far a job is until it is in this state.
    fn wait_for(&mut self, job: &Value, state: &str) -> Value {
        let start = Instant::now();
        loop {
            let progress = self.result("kiln.progress", json!({ "job": job }));
            if progress["state"] == state {
                return progress;
            }
            assert_ne!(progress["state"], "failed", "{progress}");
            assert!(start.elapsed() < PATIENCE, "waited in vain for {state}: {progress}");
        }
    }
}

fn small_params() -> Value {
    json!({ "spp": 16, "shared": 32, "format": "rgba16f" })
}

fn long_params() -> Value {
    json!({ "spp": 1 << 24, "shared": 32, "format": "rgba16f", "threads": 1 })
}

#[test]
fn another_process_plans_bakes_and_clears_in_whatever_order_plugins_come() {
    for kiln_first in [true, false] {
        let mut served = Served::new(kiln_first);
        assert_eq!(served.result("kiln.progress", Value::Null), json!({ "state": "idle" }));

        let planned = served.result("kiln.plan", json!({ "error": 0.05, "shared": 32 }));
        assert_eq!(planned, json!({ "job": 1 }));
        let plan = served.wait_for(&planned["job"], "planned");
        assert!(plan["texels"].as_u64().unwrap() > 0 && plan["memory_bytes"].as_u64().unwrap() > 0, "{plan}");
        assert!(plan["predicted"].as_array().unwrap().iter().all(|price| price["seconds"].as_f64().is_some()));
        let lights = |effect: &Value| effect["effect"] == "area-lights" && effect["on"] == true;
        assert!(plan["effects"].as_array().unwrap().iter().any(lights), "{plan}");

        let baking = served.result("kiln.bake", small_params());
        assert_eq!(baking, json!({ "job": 2 }));
        let baked = served.wait_for(&baking["job"], "baked");
        let texels = baked["texels"].as_u64().unwrap();
        assert_eq!((baked["entities"].as_u64(), baked["samples"].as_u64()), (Some(1), Some(16 * texels)));
        assert_eq!(count::<Lightmap>(served.app.world_mut()), 1);
        assert_eq!(served.result("kiln.progress", Value::Null)["job"], 2, "the latest");

        assert_eq!(served.result("kiln.clear", Value::Null), Value::Null);
        served.app.update();
        assert_eq!(count::<Lightmap>(served.app.world_mut()), 0);
    }
}

#[test]
fn a_bake_is_held_goes_on_and_is_stopped() {
    let mut served = Served::new(true);
    let job = served.result("kiln.bake", long_params())["job"].clone();
    assert_eq!(served.result("kiln.pause", Value::Null)["job"], job);
    served.wait_for(&job, "paused");
    assert_eq!(served.result("kiln.resume", Value::Null)["job"], job);
    let progress = served.wait_for(&job, "baking");
    assert!(progress["fraction"].is_number() && progress["seconds"].is_number(), "{progress}");
    assert_eq!(served.result("kiln.cancel", Value::Null)["job"], job);
    let ended = served.wait_for(&job, "cancelled");
    assert!(ended["reason"].is_string());
}

#[test]
fn what_is_wrong_has_a_number_and_a_sentence() {
    let mut served = Served::new(true);
    for (method, params, code, words) in [
        ("kiln.bake", json!({ "error": 0.1, "spp": 3 }), -32602, "give one of them"),
        ("kiln.bake", json!({ "colour": 1 }), -32602, "colour"),
        ("kiln.plan", json!([0.1]), -32602, "by name"),
        ("kiln.progress", json!({ "job": 7 }), -23602, "no job 7"),
        ("kiln.cancel", Value::Null, -23602, "no job is running"),
        ("kiln.pause", Value::Null, -23602, "no job is running"),
        ("kiln.roast", Value::Null, -32601, "kiln.roast"),
    ] {
        let error = served.ask(method, params)["error"].clone();
        assert_eq!(error["code"], code, "{error}");
        assert!(error["message"].as_str().unwrap().contains(words), "{error}");
    }
    let job = served.result("kiln.bake", long_params())["job"].clone();
    let refused = served.ask("kiln.bake", small_params())["error"].clone();
    assert_eq!(refused["code"], -23601);
    assert!(refused["message"].as_str().unwrap().contains("kiln.cancel"), "{refused}");
    served.result("kiln.cancel", Value::Null);
    served.wait_for(&job, "cancelled");
    // What only the baker finds wrong comes as the outcome of the job.
    let job = served.result("kiln.bake", json!({ "density": -1.0 }))["job"].clone();
    let start = Instant::now();
    let failed = loop {
        let progress = served.result("kiln.progress", json!({ "job": job }));
        if progress["state"] == "failed" {
            break progress;
        }
        assert!(start.elapsed() < PATIENCE, "{progress}");
    };
    assert!(failed["reason"].as_str().unwrap().contains("density"), "{failed}");
}

#[test]
fn bevys_own_method_triggers_the_same() {
    let mut served = Served::new(true);
    let path = |event: &str| format!("bevy_kiln::plugin::baking::events::{event}");
    served.result("world.trigger_event", json!({ "event": path("PlanBake") }));
    served.wait_for(&json!(1), "planned");
    let value = json!({ "threads": 1, "goal": { "Samples": 1 << 24 } });
    served.result("world.trigger_event", json!({ "event": path("BakeLightmaps"), "value": value }));
    for (event, state) in [("PauseBake", "paused"), ("ResumeBake", "baking"), ("CancelBake", "cancelled")] {
        served.result("world.trigger_event", json!({ "event": path(event) }));
        served.wait_for(&json!(2), state);
    }
}
