//! Cases of systems with one constraint that no scene has, of one type, so that every method is compiled once for all of them.

use crate::HardCaseError;
use crate::lab::Lab;
use crate::systems::{record, record_in_chart};
use dla::Schedule;
use harness::stability::check::{energy, follows, measured, rounding, sign_kept};
use harness::stability::{Case, Claim, Recorded, Seen};
use lagrangian::linear::larger;
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System};
use models::{ContactOscillator, GaugedOscillator};
use std::f64::consts::{FRAC_PI_2, PI};

#[derive(Debug, Clone, Copy)]
enum OneRow {
    Gauged(GaugedOscillator),
    /// A skate of unit mass down a slope of this acceleration (m/s^2), with a drag of the other number times `|v| v` (1/m).
    Falling([f64; 2]),
    /// A point of unit mass on the unit sphere, by its angle from the pole and its longitude, which end at the poles; its third
    /// coordinate does not move.
    Sphere,
}

impl System<3, 1> for OneRow {
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        match self {
            Self::Gauged(oscillator) => oscillator.lagrangian(t, q, v),
            Self::Falling([slope, _]) => (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5 + q[0] * *slope,
            Self::Sphere => (v[0] * v[0] + (q[0].sin() * v[1]).squared() + v[2] * v[2]) * 0.5,
        }
    }
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        match self {
            Self::Gauged(oscillator) => oscillator.constraint(t, q),
            Self::Falling(_) => ([[-q[2].sin(), q[2].cos(), zero]], [zero]),
            Self::Sphere => ([[zero, zero, one]], [zero]),
        }
    }
    fn force<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        match self {
            Self::Gauged(oscillator) => oscillator.force(t, q, v),
            Self::Falling([_, drag]) => {
                let speed = (v[0] * v[0] + v[1] * v[1] + LEAST_SQUARE).sqrt();
                Some([v[0] * speed * -drag, v[1] * speed * -drag, S::zero()])
            }
            Self::Sphere => None,
        }
    }
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        match self {
            Self::Gauged(oscillator) => oscillator.admissible_basis(t, q),
            Self::Falling(_) => Some(AdmissibleBasis::new([[q[2].cos(), q[2].sin(), zero], [zero, zero, one]])),
            Self::Sphere => Some(AdmissibleBasis::new([[one, zero, zero], [zero, one, zero]])),
        }
    }
    fn angles(&self) -> [bool; 3] {
        match self {
            Self::Gauged(oscillator) => oscillator.angles(),
            Self::Falling(_) => [false, false, true],
            Self::Sphere => [false, true, false],
        }
    }
}

/// Keeps the length of a velocity differentiable at rest, where `|v| v` has a corner in its second derivatives: the derivative of the
/// root alone would be `0/0` there. Its root, 1e-150 m/s, is nothing beside any speed.
const LEAST_SQUARE: f64 = 1e-300;

pub(crate) const GAUGE: Case = Case {
    name: "gauge",
    hard: "A gauge term in the Lagrangian changes no motion, but shifts the momenta: symmetric methods no longer see \
           the reversal, and lose energy.",
    shows: "The methods that promise the energy keep it. The drift of dla is tested in crates/harness/tests/table/gauge.rs.",
    bar: "Rounding of the energy over the run.",
    claim: Claim::Energy,
    refusable: false,
};

pub(crate) fn gauge(lab: &mut Lab) -> Result<(), HardCaseError> {
    let fault = |_| HardCaseError::Impossible("the oscillator of the case has impossible parameters");
    let plain = ContactOscillator::new(0.0).map_err(fault)?;
    let system = OneRow::Gauged(GaugedOscillator::new(plain, 1.0).map_err(fault)?);
    let start = plain.start_at(-0.5 * 2f64.sqrt()).map_err(fault)?;
    let schedule = Schedule { t0: 0.0, step: 2.0 * (PI / 40.0).sin(), steps: 4000 };
    let run = record(lab, &system, start, &schedule);
    // Whoever keeps the energy must also move.
    let still = measured("runs that do not move", f64::from(u8::from(sign_kept(&run, 1).holds())), 0.0);
    lab.judge("", &run, [energy(&run, rounding(schedule.steps as usize, 1.5)), still]);
    Ok(())
}

pub(crate) const FORCE_WITH_A_CORNER: Case = Case {
    name: "force-with-a-corner",
    hard: "A skate falls from rest against a drag -c abs(v) v: the length of a velocity has no derivative at rest.",
    shows: "u = sqrt(g/c) tanh(sqrt(g c) t), straight down.",
    bar: "The method's order over the run, relative to the terminal speed.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn force_with_a_corner(lab: &mut Lab) -> Result<(), HardCaseError> {
    let [slope, drag] = [2.0, 0.5];
    for heading in [0.0, 0.5f64] {
        let along = slope * heading.cos();
        let (terminal, rate) = ((along / drag).sqrt(), (along * drag).sqrt());
        let schedule = Schedule { t0: 0.0, step: 0.01, steps: 300 };
        let run = record(lab, &OneRow::Falling([slope, drag]), ([0.0, 0.0, heading], [0.0; 3]), &schedule);
        let bar = lab.accuracy(schedule.step * rate, rate * 3.0, schedule.steps) * terminal;
        let at = |t: f64| {
            let speed = terminal * (rate * t).tanh();
            [speed * heading.cos(), speed * heading.sin()]
        };
        lab.judge(format!("heading {heading}"), &run, [follows(&run, [3, 4], at, bar)]);
    }
    Ok(())
}

pub(crate) const CHART_END: Case = Case {
    name: "chart-end",
    hard: "A point on a sphere, by its angle from a pole and its longitude, along a great circle that passes the pole \
           at 0.3 and at 1e-3 rad: the longitude makes half a turn in a thousandth of a second.",
    shows: "The great circle; or an error, where the angles come near to their end.",
    bar: "The method's order over the way, with the rate of the longitude beside the pole; rounding, as many times \
          larger.",
    claim: Claim::Continuation,
    refusable: true,
};

pub(crate) fn chart_end(lab: &mut Lab) -> Result<(), HardCaseError> {
    for nearest in [0.3, 1e-3f64] {
        let schedule = Schedule { t0: 0.0, step: 0.01, steps: 314 };
        // From the equator at 1 rad/s.
        let start = ([FRAC_PI_2, 0.0, 0.0], [-nearest.cos(), nearest.sin(), 0.0]);
        let run = record_in_chart(lab, &OneRow::Sphere, start, &schedule, &|q| q[0].sin().abs());
        let rate = nearest.recip();
        let bar = lab.accuracy(schedule.step * rate, rate * PI, schedule.steps) * rate;
        // Another place is at most the diameter away, and is then wrong, whatever a bound says.
        let found = great_circle(&run, nearest, bar.min(0.1));
        // Beside the pole an error is what is asked for, of whoever does not follow, and no failure of the case.
        let told = if nearest < 0.1 { Recorded { failure: None, ..run } } else { run };
        lab.judge(format!("{nearest} rad"), &told, [found]);
    }
    Ok(())
}

/// How far the point on the sphere is from `cos t` on the first axis and `sin t` towards the pole, which it passes at an angle.
fn great_circle(run: &Recorded, nearest: f64, bar: f64) -> harness::stability::Finding {
    let off = |node: &Seen| {
        let [polar, longitude, ..] = node.values;
        let ([sin, cos], [east, north]) = ([polar.sin(), polar.cos()], [longitude.sin(), longitude.cos()]);
        let (ahead, up) = (node.t.cos(), node.t.sin());
        [sin * north - ahead, sin * east - up * nearest.sin(), cos - up * nearest.cos()]
            .iter()
            .fold(0.0, |most, x| larger(most, x.abs()))
    };
    measured("distance from the great circle", run.nodes.iter().map(off).fold(0.0, larger), bar)
}
