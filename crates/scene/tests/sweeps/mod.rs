//! Sweeps: the numbers of members, what is drawn, and what is wrong with a file.

use approx::assert_abs_diff_eq;
use scene::{Scene, SceneEffect, Sweep};

const METHODS: [&str; 2] = ["dla", "gauss16"];

const SWEEP: &str = r#"
scene = "bowl"
method = "gauss16"
step = 1.0
duration = 50.0
[grid]
"start.speed" = [-1.0, 0.5]
sleigh.offset = { from = 0.1, to = 0.3, count = 3 }
[random]
count = 4
seed = 7
"start.turn_rate" = { uniform = [0.1, 0.2] }
effects.0.stiffness.1 = { normal = [0.5, 0.01] }
"#;

fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "sweep.toml", &METHODS).unwrap()
}

#[test]
fn members_are_made_from_their_numbers() {
    let sweep = sweep(SWEEP);
    assert_eq!(sweep.count(), 2 * 3 * 4);
    let keys: Vec<_> = sweep.keys().collect();
    assert_eq!(keys, ["sleigh.offset", "start.speed", "effects.0.stiffness.1", "start.turn_rate"]);
    assert_eq!((sweep.scene.run.method.as_str(), sweep.scene.run.steps()), ("gauss16", 50));
    // The last key of the grid varies fastest, samples within a point.
    let grid = |member: u64| sweep.values(member)[..2].to_vec();
    for (member, offset, speed) in [(0, 0.1, -1.0), (3, 0.1, -1.0), (4, 0.1, 0.5), (8, 0.2, -1.0), (23, 0.3, 0.5)] {
        assert_abs_diff_eq!(grid(member)[..], [offset, speed], epsilon = 1e-15);
    }
    for member in 0..sweep.count() {
        let Scene { sleigh, start, effects, .. } = sweep.member(member, &METHODS).unwrap();
        let SceneEffect::Bowl { stiffness, .. } = effects[0] else { panic!("a bowl") };
        let found = [sleigh.offset(), start.speed, stiffness[1], start.turn_rate];
        assert_eq!(found.map(f64::to_bits)[..], sweep.values(member).iter().map(|x| x.to_bits()).collect::<Vec<_>>());
        assert!((0.1..0.2).contains(&start.turn_rate) && (0.4..0.6).contains(&stiffness[1]));
    }
}

#[test]
fn samples_depend_on_seed_member_and_key_alone() {
    let (one, same) = (sweep(SWEEP), sweep(SWEEP));
    let other = sweep(&SWEEP.replace("seed = 7", "seed = 8"));
    let drawn = |sweep: &Sweep, member: u64| sweep.values(member)[2].to_bits();
    assert!((0..24).all(|member| drawn(&one, member) == drawn(&same, member)));
    assert!((0..24).all(|member| drawn(&one, member) != drawn(&other, member)));
    assert!((1..24).all(|member| drawn(&one, member) != drawn(&one, 0)));
    // Mean and variance of a uniform distribution from 0 to 1, each within four deviations of the estimates.
    let text = "scene = \"turnaround\"\n[random]\ncount = 4000\nstart.x = { uniform = [0.0, 1.0] }\n";
    let sweep = sweep(text);
    let x: Vec<f64> = (0..4000).map(|member| sweep.values(member)[0]).collect();
    let mean = x.iter().sum::<f64>() / 4000.0;
    let variance = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 4000.0;
    assert_abs_diff_eq!(mean, 0.5, epsilon = 4.0 * (1.0 / 12.0 / 4000.0f64).sqrt());
    assert_abs_diff_eq!(variance, 1.0 / 12.0, epsilon = 4.0 * (1.0 / 180.0 / 4000.0f64).sqrt());
}

#[test]
fn a_member_without_a_scene_is_an_error_and_its_neighbours_are_not() {
    let sweep = sweep("scene = \"turnaround\"\n[grid]\nsleigh.mass = [-1.0, 1.0, 2.0]\n");
    assert!(sweep.member(1, &METHODS).is_ok() && sweep.member(2, &METHODS).is_ok());
    let error = sweep.member(0, &METHODS).unwrap_err().to_string();
    assert!(error.contains("mass"), "{error}");
}

#[test]
fn what_is_wrong_is_named() {
    let cases = [
        ("", "`scene`"),
        ("scene = 1", "`scene`"),
        ("scene = \"bowl\"\nmethods = \"dla\"", "`methods`"),
        ("scene = \"nowhere\"", "nowhere"),
        ("scene = \"bowl\"\nmethod = \"euler\"", "euler"),
        ("scene = \"bowl\"\n[grid]\nstart.speed = \"fast\"", "`start.speed`"),
        ("scene = \"bowl\"\n[grid]\nstart.speed = []", "`start.speed`"),
        ("scene = \"bowl\"\n[grid]\nstart.speed = { from = 0, to = 1 }", "`start.speed`"),
        ("scene = \"bowl\"\n[grid]\neffects.3.stiffness.0 = [1.0]", "`effects.3.stiffness.0`"),
        ("scene = \"bowl\"\n[grid]\nstart.sped = [1.0]", "`start.sped`"),
        ("scene = \"bowl\"\n[grid]\nrun.step = [1.0]", "`run.step`"),
        ("scene = \"bowl\"\n[random]\nstart.speed = { uniform = [0.0] }", "`start.speed`"),
        ("scene = \"bowl\"\n[random]\nstart.speed = { log_uniform = [-1.0, 1.0] }", "`start.speed`"),
        ("scene = \"bowl\"\n[random]\ncount = 0", "`random.count`"),
        ("scene = \"bowl\"\n[output]\nevery = -1", "`every`"),
        ("scene = ", "sweep.toml"),
    ];
    for (text, named) in cases {
        let error = Sweep::parse(text, "sweep.toml", &METHODS).unwrap_err().to_string();
        assert!(error.contains(named), "{text:?}: {error}");
    }
}
