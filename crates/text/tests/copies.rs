//! A system that no shape has room for keeps its own size: several copies of a system side by side move as each of them alone.

use dla::{MethodKind, Schedule, StepError};
use harness::{METHODS, Method, Request, Run};
use std::sync::Arc;
use text::{TextMechanics, TextModel, TextStart, Unit, Words};

const EACH: usize = 6;

/// Copies of a knife edge in a moving frame, driven and braked, and of a bead on a sphere. Their names end with the number of the copy.
fn copies(count: usize, extra: &str) -> Words {
    let mut words = Words::default();
    let mut lagrangian = Vec::new();
    for k in 0..count {
        let name = |name: &str| format!("{name}{k}");
        let of = |formula: &str| formula.replace('#', &k.to_string());
        let units = [("x", Unit::other("m")), ("y", Unit::other("m")), ("a", Unit::Angle)];
        let bead = ["u", "v", "w"].map(|coordinate| (coordinate, Unit::other("m")));
        words.coordinates.extend(units.into_iter().chain(bead).map(|(coordinate, unit)| (name(coordinate), unit)));
        lagrangian.push(of("(x#'^2 + y#'^2)*(1 + 0.1*sin(t))/2 + 0.2*a#'^2 - x#*y#/3"));
        lagrangian.push(of("(u#'^2 + v#'^2 + w#'^2)/2 - 3*w# - u#^2*v#/5"));
        words.constraints.push(of("x#'*sin(a#) - y#'*cos(a#) + 0.3*a#' - 0.1*cos(t)"));
        words.positions.push(of("u#^2 + v#^2 + w#^2 - 1"));
        words.forces.push((name("x"), of("-0.2*x#' + max(t - 0.55, 0)")));
        words.forces.push((name("a"), "0.1*sin(3*t)".to_owned()));
    }
    words.lagrangian = lagrangian.join(" + ") + extra;
    words
}

/// The system of such copies from the start in which copy `k` of the system has the start of copy `first + k`.
fn begun(words: &Words, first: usize) -> (TextMechanics, TextStart) {
    let model = Arc::new(TextModel::new(words).unwrap());
    let count = words.coordinates.len() / EACH;
    let each = |numbers: fn(f64) -> [f64; EACH]| -> Vec<Option<f64>> {
        (first..first + count).flat_map(|k| numbers(k as f64).map(Some)).collect()
    };
    let q = each(|k| [0.1 * k, 0.3, 0.2 + k, 0.6, 0.0, -0.8]);
    let v = each(|k| [1.0, 0.1 * k, 0.5, 0.4, 0.2 * k, 0.3]);
    let start = model.start(&q, &v).unwrap();
    (TextMechanics::new(&model, &start).unwrap(), start)
}

fn request(start: &TextStart, size: usize, steps: u64) -> Request {
    let filled = |x: &[f64]| [x, &vec![0.0; size - x.len()]].concat();
    let schedule = Schedule { t0: 0.0, step: 0.02, steps };
    Request { q: filled(&start.q), v: filled(&start.v), schedule, samples: 1 }
}

#[test]
fn copies_move_as_each_alone() {
    const COUNT: usize = 4;
    let words = copies(COUNT, "");
    let (together, start) = begun(&words, 0);
    assert!(together.model().is_assembly());
    assert_eq!(together.mechanism().size().n, COUNT * EACH);
    for name in ["dla", "dla4"] {
        let method = Method::named(name, None).unwrap();
        let steps = if name == "dla" { 50 } else { 10 };
        let all = Run::of(&*together.mechanism(), &method).timed(&request(&start, COUNT * EACH, steps));
        assert_eq!((&all.failure, all.steps), (&None, steps));
        let (mut energy, mut work) = (0.0, 0.0);
        for k in 0..COUNT {
            let (alone, at) = begun(&copies(1, ""), k);
            assert!(!alone.model().is_assembly());
            let apart = |(x, y): (&f64, &f64)| (x - y).abs();
            assert!(start.v[k * EACH..].iter().zip(&at.v).map(apart).fold(0.0, f64::max) < 1e-15, "{k}");
            let size = alone.mechanism().size().n;
            let one = Run::of(&*alone.mechanism(), &method).timed(&request(&at, size, steps));
            for (i, (x, y)) in all.q[k * EACH..].iter().zip(&one.q[..EACH]).enumerate() {
                // Rounding, grown along a motion of a second.
                assert!((x - y).abs() < 1e-12, "{name}, copy {k}, coordinate {i}: {x} and {y}");
            }
            energy += one.energy.last;
            work += one.energy.work;
        }
        assert!((all.energy.last - energy).abs() < 1e-11, "{name}: {} and {energy}", all.energy.last);
        assert!((all.energy.work - work).abs() < 1e-11, "{name}: {} and {work}", all.energy.work);
        assert!(all.constraint_max < 1e-13 && all.leaf_max.unwrap() < 1e-13, "{name}");
    }
}

#[test]
fn coupled_copies_do_not_move_alone() {
    let (together, start) = begun(&copies(4, " - x0*x1"), 0);
    let (apart, _) = begun(&copies(4, ""), 0);
    let method = Method::named("dla", None).unwrap();
    let end = |system: &TextMechanics| Run::of(&*system.mechanism(), &method).timed(&request(&start, 24, 50)).q;
    assert!((end(&together)[0] - end(&apart)[0]).abs() > 1e-3);
}

#[test]
fn other_methods_are_refused_with_those_that_run() {
    let (system, start) = begun(&copies(4, ""), 0);
    for info in METHODS {
        let record =
            Run::of(&*system.mechanism(), &Method::named(info.name, None).unwrap()).timed(&request(&start, 24, 1));
        let runs = matches!(info.kind, MethodKind::Dla | MethodKind::Composed(_));
        assert_eq!(record.failure.is_none(), runs, "{}", info.name);
        if let Some(failure) = record.failure {
            assert!(failure.to_string().contains("take dla, dla4, dla6 or dla8"), "{failure}");
            assert!(matches!(failure.source, StepError::Unsupported { .. }), "{failure}");
        }
    }
}

#[test]
fn a_function_that_is_not_finite_is_named() {
    let of_lagrangian = copies(4, " - sqrt(2 - t*5 - x3^2)");
    let mut of_force = copies(4, "");
    of_force.forces.push(("y1".to_owned(), "sqrt(0.31 - t)".to_owned()));
    for (words, named) in [(of_lagrangian, "the Lagrangian has no"), (of_force, "the force on coordinate 7 has no")] {
        let (system, start) = begun(&words, 0);
        let method = Method::named("dla", None).unwrap();
        let record = Run::of(&*system.mechanism(), &method).timed(&request(&start, 24, 200));
        let failure = record.failure.unwrap().to_string();
        assert!(failure.contains(named), "{failure}");
        assert!(record.steps > 0 && record.q.iter().all(|x| x.is_finite()), "{failure}");
    }
}
