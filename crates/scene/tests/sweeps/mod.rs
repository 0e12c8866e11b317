//! Sweeps: the numbers of members, what is drawn, and what is wrong with a file.

use approx::assert_abs_diff_eq;
use scene::{AnyEffect, AnyScene, Scene, SceneEffect, Sweep};
use sleigh::effects::Bowl;

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
    assert_eq!((sweep.scene.run().method.as_str(), sweep.scene.run().steps()), ("gauss16", 50));
    // The last key of the grid varies fastest, samples within a point.
    let grid = |member: u64| sweep.values(member)[..2].to_vec();
    for (member, offset, speed) in [(0, 0.1, -1.0), (3, 0.1, -1.0), (4, 0.1, 0.5), (8, 0.2, -1.0), (23, 0.3, 0.5)] {
        assert_abs_diff_eq!(grid(member)[..], [offset, speed], epsilon = 1e-15);
    }
    for member in 0..sweep.count() {
        let AnyScene::Sleigh(scene) = sweep.member(member, &METHODS).unwrap() else { panic!("a sleigh") };
        let Scene { sleigh, start, effects, .. } = *scene;
        let SceneEffect::Acting(AnyEffect::Bowl(Bowl { stiffness, .. })) = effects[0] else { panic!("a bowl") };
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
fn more_samples_and_longer_lists_leave_the_other_members_as_they_were() {
    // The numbers of a member by the places of its values in the grid and by its sample.
    let drawn = |text: &str, speeds: u64, samples: u64| {
        let sweep = sweep(text);
        assert_eq!(sweep.count(), 3 * speeds * samples);
        move |offset: u64, speed: u64, sample: u64| {
            sweep.values((offset * speeds + speed) * samples + sample)[2..]
                .iter()
                .map(|x| x.to_bits())
                .collect::<Vec<_>>()
        }
    };
    let (more, longer) = (SWEEP.replace("count = 4", "count = 9"), SWEEP.replace("[-1.0, 0.5]", "[-1.0, 0.5, 0.7]"));
    let one_more_key = SWEEP.replace("seed = 7", "seed = 7\n\"start.heading\" = { uniform = [0.0, 1.0] }");
    let in_common = SWEEP.replace("seed = 7", "seed = 7\ncommon = true");
    let (one, more, longer) = (drawn(SWEEP, 2, 4), drawn(&more, 2, 9), drawn(&longer, 3, 4));
    let (one_more_key, in_common) = (drawn(&one_more_key, 2, 4), drawn(&in_common, 2, 4));
    for (offset, speed, sample) in (0..24).map(|k| (k / 8, k / 4 % 2, k % 4)) {
        let numbers = one(offset, speed, sample);
        assert_eq!(numbers, more(offset, speed, sample));
        assert_eq!(numbers, longer(offset, speed, sample));
        let with_heading = one_more_key(offset, speed, sample);
        assert_eq!(numbers, [with_heading[0], with_heading[2]]);
        assert_eq!(in_common(offset, speed, sample), in_common(0, 0, sample));
        assert!((offset, speed) == (0, 0) || numbers != one(0, 0, sample));
    }
}

#[test]
fn a_member_without_a_scene_is_an_error_and_its_neighbours_are_not() {
    let sweep = sweep("scene = \"turnaround\"\n[grid]\nsleigh.mass = [-1.0, 1.0, 2.0]\n");
    assert!(sweep.member(1, &METHODS).is_ok() && sweep.member(2, &METHODS).is_ok());
    let error = sweep.member(0, &METHODS).unwrap_err().to_string();
    assert!(error.contains("mass"), "{error}");
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    // The text, the place of the error, the key and what is accepted.
    let cases = [
        ("", "1:1", "`scene`", "bundled"),
        ("scene = 1", "1:9", "`scene`", "quotes"),
        ("scene = \"bowl\"\nmethods = \"dla\"", "2:1", "`methods`", "did you mean `method`?"),
        ("scene = \"nowhere\"", "", "nowhere", ""),
        ("scene = \"bowl\"\nmethod = \"euler\"", "2:10", "`method`", "`gauss16`"),
        ("scene = \"bowl\"\nstep = 0.0", "2:8", "`step`", "greater than 0"),
        ("scene = \"bowl\"\nstep = 1.0\nduration = 0.5", "2:8", "`step`", "at most the duration"),
        ("scene = \"bowl\"\n[grid]\nstart.speed = \"fast\"", "3:15", "`start.speed`", "list"),
        ("scene = \"bowl\"\n[grid]\nstart.speed = []", "3:15", "`start.speed`", "list"),
        ("scene = \"bowl\"\n[grid]\nstart.speed = [1.0, inf]", "3:21", "`start.speed`", "finite"),
        (
            "scene = \"bowl\"\n[grid]\nstart.speed = { from = 0, to = 1 }",
            "3:15",
            "`start.speed` lacks `count`",
            "three",
        ),
        (
            "scene = \"bowl\"\n[grid]\nstart.speed = { from = 0, to = 1, count = 1e1 }",
            "3:43",
            "`start.speed` has a `count`",
            "without a point or an exponent",
        ),
        ("scene = \"bowl\"\n[grid]\neffects.3.stiffness.0 = [1.0]", "3:21", "`effects.3.stiffness.0`", "keys of"),
        ("scene = \"bowl\"\n[grid]\nstart.sped = [1.0]", "3:7", "`start.sped`", "keys of"),
        ("scene = \"bowl\"\n[grid]\nrun.stride = [1.0]", "3:5", "`run.stride`", "keys of"),
        ("scene = \"bowl\"\n[random]\nstart.speed = { uniform = [0.0] }", "3:15", "`start.speed`", "normal"),
        ("scene = \"bowl\"\n[random]\nstart.speed = { uniform = [2.0, 1.0] }", "3:15", "larger end first", "uniform"),
        ("scene = \"bowl\"\n[random]\nstart.speed = { log_uniform = [-1.0, 1.0] }", "3:15", "positive", "normal"),
        ("scene = \"bowl\"\n[random]\nstart.speed = { normal = [0.0, -1.0] }", "3:15", "deviation", "normal"),
        ("scene = \"bowl\"\n[random]\ncount = 0", "3:9", "`random.count`", "1e12"),
        ("scene = \"bowl\"\n[random]\nseed = 1.5", "3:8", "`random.seed`", "whole"),
        ("scene = \"bowl\"\n[output]\nevery = -1", "3:9", "`output.every`", "whole"),
        ("scene = \"bowl\"\n[output]\nexponent = 1", "3:12", "`output.exponent`", "true or false"),
        (
            "scene = \"bowl\"\n[grid]\nstart.speed = [1.0]\n[random]\n\"start.speed\" = { uniform = [0.0, 1.0] }",
            "5:1",
            "varies already, at line 3",
            "once",
        ),
        ("scene = \"bowl\"\n[grid]\nstart.speed = [1.0]\n\"start.speed\" = [1.0]", "4:1", "at line 3", "once"),
        (
            "scene = \"bowl\"\n[grid]\neffects.0.stiffness.1 = [1.0]\neffects.00.stiffness.1 = [1.0]",
            "4:22",
            "`effects.0.stiffness.1` varies already, at line 3",
            "once",
        ),
        ("scene = ", "1:9", "TOML", ""),
    ];
    for (text, place, named, accepted) in cases {
        let error = Sweep::parse(text, "sweep.toml", &METHODS).unwrap_err().to_string();
        for word in [named, accepted] {
            assert!(error.contains(word), "{text:?}: no {word:?} in {error}");
        }
        assert!(place.is_empty() || error.contains(&format!("--> sweep.toml:{place}")), "{text:?}: {place} {error}");
    }
}
