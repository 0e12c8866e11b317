//! Each effect alone, and ten random combinations, by the discrete principle, by the reduced equations and by the
//! independent integration whose results are stored.

use crate::effects::hand;
use crate::effects::tools::steps;
use crate::effects::typed::Run;
use dla::{Composition, Dla, Form};
use scene::{Scene, Started};

/// `golden/effects.py` writes it and says how.
const GOLDEN: &str = include_str!("golden/effects.txt");

/// The scenes with their states `x y theta u omega psi psi'` at the end.
pub fn scenes() -> impl Iterator<Item = (Scene, [f64; 7])> {
    GOLDEN.split("\nscene\n").skip(1).map(|block| {
        let (text, end) = block.split_once("\nend ").unwrap();
        let numbers: Vec<f64> = end.split_whitespace().map(|word| word.parse().unwrap()).collect();
        (Scene::parse(text, "golden", &["dla8"]).unwrap(), numbers.try_into().unwrap())
    })
}

/// The state at the end by the composition of order 8 of the midpoint rule, solved in the given form, and the jumps until then.
fn by_dla(scene: &Scene, form: Form, step: f64, end: f64) -> ([f64; 7], Vec<f64>) {
    let Started { system, q, v } = scene.system().unwrap();
    let method = Composition::fifteen8(Dla::midpoint().solved(form));
    let schedule = steps(step, (end / step).round() as u64);
    let [q, v] = Run { scene, method, schedule, start: (q, v) }.end();
    let at = system.sleigh_state(&q, &v);
    let [psi, rate] = system.rotor(&q, &v).unwrap_or([0.0; 2]);
    let jumps = system.mechanism().jump_times(0.0, end);
    ([at.x, at.y, at.heading, at.speed, at.turn_rate, psi, rate], jumps)
}

fn distance(a: &[f64; 7], b: &[f64; 7]) -> f64 {
    (0..7).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

fn without_its_last_effect(scene: &Scene) -> Scene {
    let mut lighter = scene.clone();
    lighter.effects.pop();
    lighter
}

/// The first of them, and the control: without its last effect the motion is another one.
#[test]
fn three_computations_agree() {
    let mut count = 0;
    for (scene, _) in scenes() {
        // Between them they have every effect.
        if !["random", "quadratic_drag", "friction"].iter().any(|name| scene.title.starts_with(name)) {
            continue;
        }
        let end = 0.15;
        let by_dla = |form| by_dla(&scene, form, 0.0125, end);
        let (basis, jumps) = by_dla(Form::Best);
        let (multipliers, _) = by_dla(Form::Multipliers);
        let hand = hand::motion(&scene, &jumps, end, 0.05);
        let [a, b] = [basis, multipliers].map(|end| distance(&end, &hand));
        assert!(a < 1e-10 && b < 1e-10, "{}: {a:e}, {b:e}", scene.title);
        // A displacement grows with the square of the time at first.
        let other = distance(&hand::motion(&without_its_last_effect(&scene), &jumps, end, 0.05), &hand);
        assert!(other > 1e-3 * (end / scene.run.duration).powi(2), "{}: {other:e}", scene.title);
        count += 1;
    }
    assert_eq!(count, 12);
}

/// By steps four times as long.
#[test]
fn a_stored_end_is_met() {
    let (scene, stored) = scenes().find(|(scene, _)| scene.title == "random 1 plain").unwrap();
    let end = scene.run.duration;
    let (found, _) = by_dla(&scene, Form::Best, 0.05, end);
    let error = distance(&found, &stored);
    assert!(error < 1e-10 * 4f64.powi(8), "{error:e}");
}

#[test]
#[ignore = "slow"]
fn three_computations_agree_at_length() {
    let mut count = 0;
    for (scene, stored) in scenes() {
        let end = scene.run.duration;
        let by_dla = |form| by_dla(&scene, form, 0.0125, end);
        let (basis, jumps) = by_dla(Form::Best);
        let (multipliers, _) = by_dla(Form::Multipliers);
        let hand = hand::motion(&scene, &jumps, end, 0.05);
        let [a, b, c] = [basis, multipliers, hand].map(|end| distance(&end, &stored));
        println!("{:<40} basis {a:.1e}, multipliers {b:.1e}, by hand {c:.1e}", scene.title);
        assert!(a < 1e-10 && b < 1e-10 && c < 1e-10, "{}: {a:e}, {b:e}, {c:e}", scene.title);
        // The control: without its last effect the motion is another one.
        let other = distance(&hand::motion(&without_its_last_effect(&scene), &jumps, end, 0.05), &stored);
        assert!(other > 1e-3, "{}: {other:e}", scene.title);
        count += 1;
    }
    assert_eq!(count, 36);
}
