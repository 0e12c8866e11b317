use approx::assert_relative_eq;
use lagrangian::{Constraint, GrowthError, Scalar, System, growth};
use sleigh::{CentreOfMass, Flywheel, Sleigh};
use test_systems::{IsokineticParticle, KnifeEdge, Model, RollingDisk, Snakeboard};

fn sleigh() -> Sleigh {
    Sleigh::new(1.3, 0.7, 0.4).unwrap()
}

/// `[drive, pivot] = sin theta d_x - cos theta d_y`.
#[test]
fn the_bracket_of_drive_and_pivot_is_sideways() {
    let brackets = growth(&sleigh(), 0.0, &[0.3, -0.2, 0.9]).unwrap().brackets;
    let (_, bracket) = brackets.into_iter().find(|(word, _)| *word == [0, 1]).unwrap();
    for (x, y) in bracket.iter().zip([0.9_f64.sin(), -0.9_f64.cos(), 0.0]) {
        assert_relative_eq!(*x, y, epsilon = 4.0 * f64::EPSILON);
    }
}

/// What spans the same directions grows the same, whichever coordinates describe it.
#[test]
fn the_sleigh_is_controllable_at_once() {
    let q = [0.3, -0.2, 0.9];
    let free = growth(&sleigh(), 0.0, &q).unwrap();
    assert_eq!((free.dimensions.as_slice(), free.degree()), (&[2, 3][..], Some(2)));
    assert_eq!(growth(&CentreOfMass(sleigh()), 0.0, &q).unwrap().dimensions, [2, 3]);
    // The rotor is one more direction, and one that commutes with the others.
    let rotor = Flywheel::new(sleigh(), 0.2, None).unwrap();
    assert_eq!(growth(&rotor, 0.0, &[0.3, -0.2, 0.9, 0.1]).unwrap().dimensions, [3, 4]);
}

/// (Bloch 2003, sections 1.4 and 6.2: the rolling disk is reached in three steps.)
#[test]
fn other_systems_grow_as_the_literature_has_it() {
    let disk = RollingDisk { m: 1.0, R: 0.5, I: 0.125, J: 0.0625 };
    assert_eq!(growth(&disk, 0.0, &disk.start().0).unwrap().dimensions, [2, 3, 4]);
    let board = Snakeboard { m: 1.2, l: 0.4, J: 0.05, Jr: 0.03, Jw: 0.02 };
    let (q, _) = board.start();
    let grown = growth(&board, 0.0, &q).unwrap();
    assert!(grown.is_controllable(), "{:?}", grown.dimensions);
    let edge = KnifeEdge { m: 1.0, I: 0.5, g: 1.0 };
    assert_eq!(growth(&edge, 0.0, &edge.start().0).unwrap().dimensions, [2, 3]);
}

/// A point in space with one row, and one that is nothing or the same again.
#[derive(Clone, Copy)]
enum Form {
    /// `z' = 2 x x'`, the rate of `z - x^2`.
    Leaf,
    /// `z' = y^2 x'`, whose bracket vanishes at `y = 0`.
    Martinet,
    /// The leaf's row, twice.
    Twice,
}

impl System<3, 2> for Form {
    fn lagrangian<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5
    }
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 3]) -> Constraint<S, 3, 2> {
        let (zero, one) = (S::zero(), S::constant(1.0));
        let row = match self {
            Self::Leaf | Self::Twice => [q[0] * -2.0, zero, one],
            Self::Martinet => [-(q[1] * q[1]), zero, one],
        };
        let second = if matches!(self, Self::Twice) { row.map(|x| x * 3.0) } else { [zero; 3] };
        ([row, second], [zero; 2])
    }
}

/// The positive controls: what can be integrated stops growing, and a place that is singular takes one more step.
#[test]
fn a_holonomic_system_stops_growing() {
    let q = [0.4, 0.5, 0.6];
    for form in [Form::Leaf, Form::Twice] {
        let grown = growth(&form, 0.0, &q).unwrap();
        assert_eq!(grown.dimensions, [2, 2, 2, 2]);
        assert!(!grown.is_controllable() && grown.degree().is_none());
    }
    assert_eq!(growth(&Form::Martinet, 0.0, &q).unwrap().dimensions, [2, 3]);
    assert_eq!(growth(&Form::Martinet, 0.0, &[0.4, 0.0, 0.6]).unwrap().dimensions, [2, 2, 3]);
}

#[test]
fn a_constraint_on_the_speed_has_no_directions() {
    let particle = IsokineticParticle::new(1.3, 0.8, 1.0);
    let (q, _) = particle.start();
    assert!(matches!(growth(&particle, 0.0, &q), Err(GrowthError::Nonlinear { .. })));
}
