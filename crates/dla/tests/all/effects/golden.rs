//! Each effect alone, and ten random combinations, by the discrete principle, by the reduced equations and by the
//! independent integration whose results are stored.

use crate::effects::{hand, tools};
use dla::{Composition, Dla, Form, Schedule};
use scene::{Built, Scene, Visitor};

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

/// The state at the end by the composition of order 8 of the midpoint rule, solved in the given form.
struct ByDla<'a> {
    scene: &'a Scene,
    form: Form,
    step: f64,
}

impl Visitor for ByDla<'_> {
    type Output = ([f64; 7], Vec<f64>);

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Self::Output {
        let end = self.scene.run.duration;
        let schedule = Schedule { t0: 0.0, step: self.step, steps: (end / self.step).round() as u64 };
        let mut method = Composition::fifteen8(Dla::midpoint().solved(self.form));
        let state = tools::run(&*system, &mut method, &schedule, (q, v), ());
        let (q, v) = (state.unwrapped(), *state.v());
        let sleigh = system.sleigh().unwrap();
        let at = sleigh.sleigh_state(&q, &v);
        let [psi, rate] = sleigh.rotor(&q, &v).unwrap_or([0.0; 2]);
        ([at.x, at.y, at.heading, at.speed, at.turn_rate, psi, rate], system.jump_times(0.0, end))
    }
}

fn distance(a: &[f64; 7], b: &[f64; 7]) -> f64 {
    (0..7).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

#[test]
fn three_computations_agree() {
    let mut count = 0;
    for (scene, stored) in scenes() {
        let by_dla = |form, step| scene.visit(ByDla { scene: &scene, form, step }).unwrap();
        let (basis, jumps) = by_dla(Form::Best, 0.0125);
        let (multipliers, _) = by_dla(Form::Multipliers, 0.0125);
        let hand = hand::motion(&scene, &jumps, scene.run.duration, 0.05);
        let [a, b, c] = [basis, multipliers, hand].map(|end| distance(&end, &stored));
        println!("{:<40} basis {a:.1e}, multipliers {b:.1e}, by hand {c:.1e}", scene.title);
        assert!(a < 1e-10 && b < 1e-10 && c < 1e-10, "{}: {a:e}, {b:e}, {c:e}", scene.title);
        // The control: without its last effect the motion is another one.
        let mut lighter = scene.clone();
        lighter.effects.pop();
        let other = hand::motion(&lighter, &jumps, scene.run.duration, 0.05);
        assert!(distance(&other, &stored) > 1e-3, "{}: {:e}", scene.title, distance(&other, &stored));
        count += 1;
    }
    assert_eq!(count, 36);
}
