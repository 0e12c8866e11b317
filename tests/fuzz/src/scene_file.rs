//! Any bytes: they are a scene, or an error that says where; a scene comes back from its own text, number by number.

#![no_main]

use libfuzzer_sys::fuzz_target;
use scene::Scene;

const METHODS: &[&str] = &["dla", "dla-alpha", "gauss8", "rk4"];

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match Scene::parse(text, "fuzz.toml", METHODS) {
        Ok(scene) => {
            let written = scene.to_toml().expect("a scene of finite numbers can be written");
            let back = Scene::parse(&written, "fuzz.toml", METHODS);
            assert_eq!(back.as_ref(), Ok(&scene), "{written}");
            assert!(scene.run.steps() >= 1 && scene.run.actual_step() > 0.0);
        }
        Err(error) => assert!(error.to_string().contains("fuzz.toml"), "{error}"),
    }
});
