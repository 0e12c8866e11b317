//! `noslip run --substep`: steps that are made in parts, and the offer of it.

use crate::program::{FAILING, Folder, SCENE, keys};
use serde_json::Value;

/// What a program prints, but for the time it took.
fn timeless(mut run: Value) -> Value {
    run["wall_seconds"].take();
    run
}

#[test]
fn a_step_that_is_refused_is_made_in_parts() {
    made_in_parts(&["dla", "dla4", "gauss8"], |_| "--method gauss16 --step 0.058".to_owned());
}

#[test]
#[ignore = "slow"]
fn a_step_that_is_refused_is_made_in_parts_in_full() {
    made_in_parts(&["dla", "dla4", "gauss8", "energy4"], |method| format!("--method {method} --step 0.0029"));
}

/// The run ends at the same place as with short steps.
fn made_in_parts(methods: &[&str], short: impl Fn(&str) -> String) {
    let folder = Folder::new();
    folder.write("large.toml", FAILING);
    for method in methods {
        let right = folder.json(&format!("run large.toml {} --json", short(method)));
        let run = folder.json(&format!("run large.toml --method {method} --substep --json"));
        let keys = keys(&run);
        assert!(keys.contains(&"substeps") && !keys.contains(&"failure"), "{run}");
        assert_eq!(self::keys(&run["substeps"]), ["divided", "parts", "most"]);
        let [divided, parts, most] = ["divided", "parts", "most"].map(|key| run["substeps"][key].as_u64().unwrap());
        assert!(0 < divided && divided <= 10 && 2 * divided <= parts && 2 <= most && most <= parts, "{run}");
        for key in ["heading", "speed", "turn_rate"] {
            let [found, right] = [&run, &right].map(|run| run["final"][key].as_f64().unwrap());
            assert!((found - right).abs() < 2e-3, "{method}: {key} {found} {right}");
        }
        assert!(run["constraint"]["max"].as_f64().unwrap() < 1e-14, "{run}");

        let text = folder.done(&format!("run large.toml --method {method} --substep"));
        let line = text.lines().find(|line| line.starts_with("substeps")).unwrap();
        assert!(
            line.ends_with(&format!(
                "{divided} of 10 steps divided, into {parts} parts in all and {most} parts at most"
            )),
            "{line}"
        );
    }
}

/// Where no step is divided, no bit is another.
#[test]
fn what_holds_is_left_alone() {
    let folder = Folder::new();
    let plain = timeless(folder.json("run turnaround --method gauss8 --json"));
    let mut run = timeless(folder.json("run turnaround --method gauss8 --substep --json"));
    let substeps = run.as_object_mut().unwrap().shift_remove("substeps").unwrap();
    assert_eq!((substeps["divided"].as_u64(), substeps["parts"].as_u64()), (Some(0), Some(0)));
    assert_eq!(run, plain);
    let text = folder.done("run turnaround --method gauss8 --substep");
    assert!(text.contains("none of 600 steps was divided") || text.contains("steps was divided"), "{text}");
}

/// A refusal offers it, to who makes a run; a comparison stays without.
#[test]
fn a_refusal_offers_it() {
    let folder = Folder::new();
    folder.write("large.toml", FAILING);
    let outcome = folder.line("run large.toml --json");
    let run: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(outcome.code, 1);
    assert!(run["failure"]["hint"].as_str().unwrap().ends_with("or divide such steps into parts (--substep)"), "{run}");
    assert!(outcome.stderr.contains("or divide such steps into parts (--substep)"), "{}", outcome.stderr);
    let compared = folder.line("compare large.toml --methods dla");
    assert!(!compared.stderr.contains("--substep") && compared.stderr.contains("shorten"), "{}", compared.stderr);
    // What no shorter step mends gets no such offer, and is refused with it as without.
    for flag in ["", " --substep"] {
        let refused = folder.line(&format!("run planimeter --method energy4{flag}"));
        assert_eq!(refused.code, 1);
        assert!(refused.stderr.contains("refused") && !refused.stderr.contains("--substep"), "{}", refused.stderr);
    }
    assert_eq!(folder.line("compare large.toml --substep").code, 2);
}

#[test]
fn it_goes_with_checkpoints_events_and_tolerances() {
    let folder = Folder::new();
    folder.write("large.toml", FAILING);
    let whole = timeless(folder.json("run large.toml --substep --json --checkpoint all.save --checkpoint-every 3"));
    assert_eq!(timeless(folder.json("run large.toml --substep --json")), whole);
    assert_eq!(timeless(folder.json("run large.toml --substep --json --resume all.save")), whole);
    // A run that may divide none is another.
    let other = folder.line("run large.toml --json --resume all.save");
    assert!(other.code == 2 && other.stderr.contains("substep"), "{}", other.stderr);

    folder.write("scene.toml", SCENE);
    let short = folder.json("run large.toml --method gauss8 --step 0.029 --event speed=0 --json");
    let long = folder.json("run large.toml --method gauss8 --step 29 --substep --event speed=0 --json");
    let times = |run: &Value| -> Vec<f64> {
        run["events"].as_array().unwrap().iter().map(|event| event["t"].as_f64().unwrap()).collect()
    };
    assert_eq!((times(&short).len(), times(&long).len()), (1, 1), "{long}");
    assert!((times(&short)[0] - times(&long)[0]).abs() < 1e-2, "{long}");
    let until = folder.json("run large.toml --method gauss8 --step 29 --substep --until speed=0 --json");
    assert!((until["final"]["t"].as_f64().unwrap() - times(&short)[0]).abs() < 1e-2, "{until}");
    assert!(until["final"]["speed"].as_f64().unwrap().abs() < 1e-12, "{until}");

    let near = folder.json("run scene.toml --substep --tolerance 1e-4 --json");
    assert!(near["substeps"].is_object() && near["step"].as_f64().unwrap() < 0.5, "{near}");
}
