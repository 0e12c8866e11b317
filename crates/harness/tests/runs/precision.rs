//! Work against precision, on methods whose errors are made up and therefore known.

use approx::assert_relative_eq;
use dla::{RunError, StepError};
use harness::precision::{
    Bench, Curve, LadderLimits, Mark, PrecisionPoint, RungSetting, cheapest, mark_pareto, seconds_to, work_precision,
};
use harness::{Method, MethodKind};

const DURATION: f64 = 10.0;
/// Where rounding takes over.
const FLOOR: f64 = 1e-14;

/// The error `h^p` above a floor, of an adaptive method its tolerance; steps beyond a second fail.
fn made_up(method: &Method, steps: u64) -> Result<f64, RunError> {
    let h = DURATION / steps as f64;
    let info = method.info();
    match info.kind {
        MethodKind::Energy(1) => Err(failed(StepError::Unsupported { reason: "made up" })),
        MethodKind::Dop853 => Ok(method.tolerance() + FLOOR),
        _ if h > 1.0 => Err(failed(StepError::Jump { time: h })),
        _ => Ok(0.1 * h.powi(i32::try_from(info.order).unwrap()) + FLOOR),
    }
}

fn failed(source: StepError) -> RunError {
    RunError::new(1, 0.0, source)
}

fn curves(names: &[&str]) -> Vec<Curve> {
    let methods: Vec<Method> = names.iter().map(|name| Method::named(name, None).unwrap()).collect();
    let bench = Bench {
        duration: DURATION,
        reference_error: 1e-15,
        end_error: &made_up,
        aligned: &|steps| steps.div_ceil(3) * 3,
    };
    let mut told = 0;
    let limits = LadderLimits { fewest: 8, longest: 1e-4 };
    let (curves, clock) = work_precision(&bench, &methods, &limits, &mut |done| told += done);
    assert_eq!(told, names.len() as u64 + clock.rounds);
    curves
}

#[test]
fn a_ladder_begins_where_runs_succeed_and_ends_in_rounding() {
    for curve in curves(&["dla", "rk4", "dla8", "gauss16"]) {
        let regular: Vec<&PrecisionPoint> = curve.points.iter().filter(|point| point.is_regular()).collect();
        assert!(regular.len() >= 6, "{}: {} points", curve.method, regular.len());
        assert!(regular.windows(2).all(|pair| pair[1].error < pair[0].error), "{}", curve.method);
        assert!(curve.points.iter().all(|point| point.steps.unwrap().is_multiple_of(3) && point.steps.unwrap() >= 10));
        let (last, before) = (curve.points.last().unwrap(), &curve.points[curve.points.len() - 2]);
        // The last two are rounding, and nothing far above it is taken for rounding.
        assert!([last, before].iter().all(|point| point.mark == Some(Mark::Plateau)), "{curve:?}");
        let plateau = curve.points.iter().filter(|point| point.mark.is_some());
        assert!(plateau.clone().count() == 2 && plateau.clone().all(|point| point.error.unwrap() < 10.0 * FLOOR));
        // Within the fit the floor adds at most a tenth of an error, which tilts the line through n points that span
        // the logarithm of at least two decades by no more than ln(1.1) / ln(100).
        let (order, slope) = (f64::from(curve.order.unwrap()), curve.slope.unwrap());
        assert!(slope.points >= 3, "{curve:?}");
        assert_relative_eq!(slope.value, order, max_relative = 1.1_f64.ln() / 100.0_f64.ln());
        for point in &curve.points {
            let Some(RungSetting::Step(step)) = point.setting else { panic!("{point:?}") };
            assert_relative_eq!(step * point.steps.unwrap() as f64, DURATION, max_relative = 1e-15);
            assert!(point.wall_seconds.is_some() && point.cpu_seconds.is_some() && point.spread.is_some());
        }
    }
}

/// An error that waits for one step and falls again is not yet rounding; the control is the plateau that follows.
#[test]
fn a_pause_is_no_plateau() {
    let pauses = |method: &Method, steps: u64| {
        let error = made_up(method, steps)?;
        Ok(if (1e-12..1e-10).contains(&error) { 1e-10 } else { error })
    };
    let bench = Bench { duration: DURATION, reference_error: 1e-16, end_error: &pauses, aligned: &|steps| steps };
    let limits = LadderLimits { fewest: 10, longest: 1e-4 };
    let (curves, _) = work_precision(&bench, &[Method::named("rk4", None).unwrap()], &limits, &mut ());
    let errors = |marked: bool| {
        let points = curves[0].points.iter().filter(move |point| point.mark.is_some() == marked);
        points.map(|point| point.error.unwrap()).collect::<Vec<_>>()
    };
    let pause = errors(false).iter().position(|error| (*error - 1e-10).abs() < 1e-20).unwrap();
    assert!(errors(false)[pause..].iter().any(|error| *error < 1e-12), "{curves:?}");
    assert!(errors(true).len() == 2 && errors(true).iter().all(|error| *error < 10.0 * FLOOR), "{curves:?}");
}

#[test]
fn an_adaptive_method_has_one_interval_and_a_ladder_of_tolerances() {
    let all = curves(&["dop853", "energy2"]);
    let adaptive = &all[0];
    assert!(adaptive.points.len() >= 8, "{adaptive:?}");
    for point in &adaptive.points {
        let Some(RungSetting::Tolerance(tolerance)) = point.setting else { panic!("{point:?}") };
        assert_eq!(point.steps, Some(3));
        assert_relative_eq!(point.error.unwrap(), tolerance + FLOOR, max_relative = 1e-15);
    }
    assert_eq!((all[1].refusal, all[1].points.len()), (Some("made up"), 0));
}

#[test]
fn what_fails_in_every_run_is_told_of_its_finest() {
    let fails = |_: &Method, _: u64| Err(failed(StepError::Jump { time: 1.0 }));
    let bench = Bench { duration: DURATION, reference_error: 1e-15, end_error: &fails, aligned: &|steps| steps };
    let limits = LadderLimits { fewest: 8, longest: 1e-12 };
    let (curves, _) = work_precision(&bench, &[Method::named("dla", None).unwrap()], &limits, &mut ());
    let [point] = &curves[0].points[..] else { panic!("{curves:?}") };
    assert!(point.error.is_none() && point.cpu_seconds.is_none() && !point.pareto);
    assert!(matches!(&point.mark, Some(Mark::Failed(reason, Some(_))) if reason.starts_with("step 1, from t = 0 s")));
}

fn point(method: &str, error: f64, seconds: f64) -> PrecisionPoint {
    PrecisionPoint {
        method: method.to_owned(),
        source: None,
        setting: None,
        steps: None,
        error: Some(error),
        wall_seconds: Some(seconds),
        cpu_seconds: None,
        spread: None,
        mark: None,
        pareto: true,
    }
}

fn curve(method: &str, points: &[[f64; 2]]) -> Curve {
    let points = points.iter().map(|[error, seconds]| point(method, *error, *seconds)).collect();
    Curve::new(method.to_owned(), None, None, points)
}

#[test]
fn the_front_is_what_nothing_beats() {
    let mut curves = [
        curve("a", &[[1e-2, 1.0], [1e-4, 2.0], [1e-8, 4.0]]),
        curve("b", &[[1e-1, 1.5], [1e-6, 2.5], [1e-7, 5.0], [0.0, 6.0], [f64::NAN, 0.1]]),
    ];
    let marked = |curves: &[Curve]| -> Vec<bool> {
        curves.iter().flat_map(|curve| &curve.points).map(|point| point.pareto).collect()
    };
    mark_pareto(&mut curves, 0.0);
    assert_eq!(marked(&curves), [true, true, true, false, true, false, false, false]);
    // Where errors are known to 1e-5 only, the first of those below is as good as the others.
    mark_pareto(&mut curves, 1e-5);
    assert_eq!(marked(&curves), [true, true, false, false, true, false, false, false]);
}

#[test]
fn times_to_an_error_are_interpolated_in_logarithms() {
    let slow = curve("slow", &[[1e-2, 1.0], [1e-4, 10.0]]);
    // Half of the way between two powers of ten is the root of ten, to the four digits that a time has.
    assert_relative_eq!(seconds_to(&slow.points, 1e-3).unwrap(), 10.0_f64.sqrt(), max_relative = 5e-4);
    assert_relative_eq!(seconds_to(&slow.points, 1e-1).unwrap(), 1.0);
    assert_eq!(seconds_to(&slow.points, 1e-6), None);
    // A finer point may take less.
    let odd = curve("odd", &[[1e-2, 9.0], [1e-4, 8.0], [1e-5, 2.0], [1e-6, 3.0]]);
    assert_relative_eq!(seconds_to(&odd.points, 1e-3).unwrap(), 2.0);
    let fast = curve("fast", &[[1e-3, 0.5], [1e-6, 1.0]]);
    let levels = cheapest(&[slow, fast]);
    let best: Vec<Option<&str>> = levels.iter().map(|level| Some(level.methods.first()?.0.as_str())).collect();
    assert_eq!(best, [Some("fast"), Some("fast"), None, None]);
    assert_relative_eq!(levels[0].factor().unwrap(), 3.162 / 0.5);
    assert_eq!(levels[1].factor(), None);
}

/// The time of a method must not depend on its place in the rounds: the same method twice has the same time. A timing, made where
/// `NOSLIP_MEASURE=1` is set:
///
/// ```text
/// NOSLIP_MEASURE=1 cargo test --release -p noslip-harness two_identical_methods -- --ignored --nocapture
/// ```
#[test]
#[ignore = "a timing, with NOSLIP_MEASURE=1"]
fn two_identical_methods_take_the_same_time() {
    if std::env::var_os("NOSLIP_MEASURE").is_none_or(|value| value != "1") {
        return;
    }
    let work = |method: &Method, steps: u64| {
        let mut x = std::hint::black_box(1.0_f64);
        for _ in 0..200 * steps {
            x = x.sin() + 1.0;
        }
        std::hint::black_box(x);
        made_up(method, steps.max(20))
    };
    let bench = Bench { duration: DURATION, reference_error: 1e-15, end_error: &work, aligned: &|steps| steps };
    let method = Method::named("dla", None).unwrap();
    let limits = LadderLimits { fewest: 20, longest: 0.01 };
    let (curves, _) = work_precision(&bench, &[method, method], &limits, &mut ());
    for (a, b) in curves[0].points.iter().zip(&curves[1].points) {
        let ratio = a.cpu_seconds.unwrap() / b.cpu_seconds.unwrap();
        println!("{} steps: ratio {ratio:.4}, spread {:?}", a.steps.unwrap(), a.spread.unwrap());
        assert!((ratio - 1.0).abs() < 0.03, "{ratio}");
    }
}
