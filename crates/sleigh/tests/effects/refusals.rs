//! What no effect and no body accepts, each beside a neighbour that it does.

use super::{sine, sleigh};
use sleigh::effects::{Bowl, Drag, EggCrate, Friction, Hill, Hills, MovingMass, QuadraticDrag, Slope, Thrust, Torque};
use sleigh::{ClosedPath, Flywheel, Guide, Guided, Sleigh, SleighError, Table, TimeFunction};
use std::fmt::Debug;

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;

fn refused<T: Debug>(result: Result<T, SleighError>, word: &str) {
    let error = result.unwrap_err();
    assert!(error.to_string().contains(word), "{error} does not say {word:?}");
}

fn not_finite<T: Debug>(result: Result<T, SleighError>, word: &str) {
    assert!(matches!(result, Err(SleighError::NotFinite { .. })), "{result:?}");
    refused(result, word);
}

fn not_positive<T: Debug>(result: Result<T, SleighError>, word: &str) {
    assert!(matches!(result, Err(SleighError::NotPositive { .. })), "{result:?}");
    refused(result, word);
}

#[test]
fn fields() {
    for bad in [NAN, INFINITE, -INFINITE] {
        not_finite(Slope::new([0.0, bad]), "gravity");
        not_finite(Bowl::new([bad, 0.0], [0.0; 2]), "stiffness");
        not_finite(Bowl::new([0.0; 2], [0.0, bad]), "center");
        not_finite(EggCrate::new(bad, [1.0; 2]), "height");
        not_finite(EggCrate::new(1.0, [bad, 1.0]), "wave_number");
        let hill = Hill { height: 1.0, x: 0.0, y: 0.0, width: 1.0 };
        not_finite(Hills::new(vec![hill, Hill { height: bad, ..hill }]), "height");
        not_finite(Hills::new(vec![Hill { x: bad, ..hill }]), "middle");
        not_finite(Hills::new(vec![Hill { y: bad, ..hill }]), "middle");
        not_positive(Hills::new(vec![Hill { width: bad, ..hill }]), "width");
        not_positive(Hills::new(vec![Hill { width: 0.0, ..hill }]), "width");
        not_positive(Hills::new(vec![Hill { width: -1.0, ..hill }]), "width");
        assert!(Hills::new(vec![Hill { width: f64::MIN_POSITIVE, height: -1.0, ..hill }]).is_ok());
    }
    assert!(Hills::new(vec![]).is_ok() && Bowl::new([-1.0, 0.0], [0.0; 2]).is_ok());
}

#[test]
fn drives() {
    for bad in [NAN, INFINITE, -1e-300] {
        for drag in [Drag::new(bad, 0.0), Drag::new(0.0, bad)] {
            assert!(matches!(drag, Err(SleighError::Negative { .. })), "{drag:?}");
        }
        not_positive(MovingMass::new(bad, 0.0, 0.0), "mass");
        not_positive(Flywheel::new(sleigh(), bad, None), "inertia of the rotor");
    }
    for bad in [NAN, INFINITE, -1e-300] {
        for drag in [QuadraticDrag::new(bad, 0.0), QuadraticDrag::new(0.0, bad)] {
            assert!(matches!(drag, Err(SleighError::Negative { .. })), "{drag:?}");
        }
        for friction in [Friction::new(bad, 1.0, 0.0, 1.0), Friction::new(0.0, 1.0, bad, 1.0)] {
            assert!(matches!(friction, Err(SleighError::Negative { .. })), "{friction:?}");
        }
        not_positive(Friction::new(1.0, bad, 1.0, 1.0), "smoothing");
        not_positive(Friction::new(1.0, 1.0, 1.0, bad), "turning_smoothing");
    }
    not_positive(Friction::new(1.0, 0.0, 1.0, 1.0), "smoothing");
    refused(Drag::new(-1.0, 0.0), "along");
    refused(Drag::new(0.0, -1.0), "turning");
    not_positive(MovingMass::new(0.0, 0.0, 0.0), "mass");
    not_positive(Flywheel::new(sleigh(), 0.0, None), "inertia of the rotor");
    assert!(Drag::new(0.0, 0.0).is_ok() && Flywheel::new(sleigh(), 1e-300, None).is_ok());
    for bad in [TimeFunction::Constant(NAN), sine(INFINITE, 1.0, 0.0), sine(1.0, NAN, 0.0), sine(1.0, 1.0, INFINITE)] {
        not_finite(Thrust::new(bad.clone()), "force");
        not_finite(Torque::new(bad.clone()), "torque");
        not_finite(MovingMass::new(1.0, bad.clone(), 0.0), "x ");
        not_finite(MovingMass::new(1.0, 0.0, bad.clone()), "y ");
        not_finite(Flywheel::new(sleigh(), 1.0, Some(bad.clone())), "torque");
        not_finite(Guided::<1>::servo(sleigh(), Guide::Speed(bad.clone())), "speed");
        not_finite(Guided::<1>::servo(sleigh(), Guide::TurnRate(bad.clone())), "turn_rate");
        not_finite(Guided::<2>::servo(sleigh(), bad.clone(), 0.0.into()), "speed");
        not_finite(Guided::<2>::servo(sleigh(), 0.0.into(), bad), "turn_rate");
    }
    let jumping = TimeFunction::Table(Table::new(vec![0.0, 1.0], vec![0.0, 1.0]).unwrap());
    refused(MovingMass::new(1.0, jumping.clone(), 0.0), "jump");
    refused(MovingMass::new(1.0, 0.0, jumping), "jump");
    let still = TimeFunction::Table(Table::new(vec![3.0], vec![0.5]).unwrap());
    assert!(MovingMass::new(1.0, still.clone(), still).is_ok());
}

#[test]
fn tables() {
    for (times, values, word) in [
        (vec![], vec![], "no times"),
        (vec![0.0, 1.0], vec![1.0], "2 times and 1 values"),
        (vec![0.0], vec![], "1 times and 0 values"),
        (vec![1.0, 0.0], vec![1.0, 2.0], "do not increase"),
        (vec![0.0, 0.0], vec![1.0, 2.0], "do not increase"),
        (vec![0.0, NAN], vec![1.0, 2.0], "not finite"),
        (vec![0.0, INFINITE], vec![1.0, 2.0], "not finite"),
        (vec![0.0, 1.0], vec![1.0, -INFINITE], "not finite"),
    ] {
        let table = Table::new(times, values);
        assert!(matches!(table, Err(SleighError::Table { .. })), "{table:?}");
        refused(table, word);
    }
    let table = Table::new(vec![-1.0, 2.0], vec![1.0, 1.0]).unwrap();
    assert!(table.times() == [-1.0, 2.0] && table.values() == [1.0, 1.0]);
}

#[test]
fn paths_and_planes() {
    for bad in [NAN, INFINITE, 0.0, -1.0] {
        not_positive(ClosedPath::circle(bad, [0.0; 2], 1.0), "radius");
        not_positive(ClosedPath::circle(1.0, [0.0; 2], bad), "period");
        not_positive(ClosedPath::polygon(vec![[0.0, 0.0], [1.0, 0.0]], bad), "period");
    }
    for bad in [NAN, INFINITE] {
        not_finite(ClosedPath::circle(1.0, [0.0, bad], 1.0), "center");
        not_finite(ClosedPath::polygon(vec![[0.0, 0.0], [bad, 0.0]], 1.0), "polygon");
        not_finite(Guided::turntable(sleigh(), bad), "rate");
    }
    not_finite(ClosedPath::polygon(vec![[-1e308, 0.0], [1e308, 0.0]], 1.0), "length");
    refused(ClosedPath::polygon(vec![], 1.0), "at least two");
    refused(ClosedPath::polygon(vec![[0.0, 0.0]], 1.0), "at least two");
    refused(ClosedPath::polygon(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]], 1.0), "coincide");
    // Closed by hand: the last vertex is the first again.
    refused(ClosedPath::polygon(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]], 1.0), "coincide");
    assert!(ClosedPath::polygon(vec![[0.0, 0.0], [1.0, 0.0]], 1.0).is_ok());

    let path = ClosedPath::circle(0.7, [0.1, 0.2], 6.0).unwrap();
    refused(Guided::<2>::tracer(Sleigh::new(1.0, 1.0, 0.0).unwrap(), path.clone()), "offset 0");
    assert!(Guided::<2>::tracer(Sleigh::new(1.0, 1.0, -1e-3).unwrap(), path.clone()).is_ok());
    refused(Guided::<1>::servo(sleigh(), Guide::TracerX(path.clone())), "both components");
    refused(Guided::<1>::servo(sleigh(), Guide::TracerY(path)), "both components");
}
