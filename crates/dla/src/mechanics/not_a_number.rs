use lagrangian::{AdmissibleBasis, Called, Gradient, Reduced, SeldomNumber, System, from_fn, quasi_velocities};
use std::fmt;
use thiserror::Error;

/// A function of a system that is not finite, or has no finite derivative, although a step needs it.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub struct NotANumber {
    /// The function.
    pub function: SystemFunction,
    /// The value or derivative that is not finite.
    pub derivative: Derivative,
    /// The time (s).
    pub time: f64,
    /// Whether it is so at the beginning of the step: no shorter step avoids it then.
    pub at_node: bool,
}

/// A function by which a system is given, or one of its numbers. Coordinates and rows are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SystemFunction {
    /// The Lagrangian.
    Lagrangian,
    /// The generalised force on a coordinate.
    Force {
        /// The coordinate.
        coordinate: usize,
    },
    /// The factor of a velocity in a row of the constraint, `A v + b`.
    Constraint {
        /// The row.
        row: usize,
        /// The coordinate.
        coordinate: usize,
    },
    /// The term `b` of a row of the constraint.
    ConstraintTerm {
        /// The row.
        row: usize,
    },
    /// The function of the positions whose rate a row is.
    Position {
        /// The row.
        row: usize,
    },
    /// A constraint that is not affine.
    Nonlinear {
        /// The row.
        row: usize,
    },
    /// The component of a vector of the basis of admissible velocities along a coordinate.
    Basis {
        /// The vector.
        vector: usize,
        /// The coordinate.
        coordinate: usize,
    },
    /// The acceleration of a quasi-velocity, if the system gives it by hand.
    ReducedMotion {
        /// The quasi-velocity.
        quasi_velocity: usize,
    },
}

/// A variable of a function of a system. Coordinates are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// The time.
    Time,
    /// A coordinate.
    Coordinate(usize),
    /// The velocity of a coordinate.
    Velocity(usize),
}

/// A value or a derivative of a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// The value.
    Value,
    /// A first derivative.
    First(Variable),
    /// A second derivative.
    Second(Variable, Variable),
}

impl NotANumber {
    /// The error of a part of a larger system, in the numbers of the whole: coordinate `i` of the part is `coordinate(i)`, and its rows
    /// begin at `row`.
    #[must_use]
    pub fn renumbered(mut self, coordinate: impl Fn(usize) -> usize, row: usize) -> Self {
        match &mut self.function {
            SystemFunction::Lagrangian | SystemFunction::ReducedMotion { .. } => {}
            SystemFunction::Force { coordinate: i } | SystemFunction::Basis { coordinate: i, .. } => {
                *i = coordinate(*i);
            }
            SystemFunction::Constraint { row: k, coordinate: i } => (*k, *i) = (row + *k, coordinate(*i)),
            SystemFunction::ConstraintTerm { row: k }
            | SystemFunction::Position { row: k }
            | SystemFunction::Nonlinear { row: k } => *k += row,
        }
        let of = |x: Variable| match x {
            Variable::Time => Variable::Time,
            Variable::Coordinate(i) => Variable::Coordinate(coordinate(i)),
            Variable::Velocity(i) => Variable::Velocity(coordinate(i)),
        };
        self.derivative = match self.derivative {
            Derivative::Value => Derivative::Value,
            Derivative::First(x) => Derivative::First(of(x)),
            Derivative::Second(x, y) => Derivative::Second(of(x), of(y)),
        };
        self
    }
}

impl fmt::Display for SystemFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lagrangian => f.write_str("the Lagrangian"),
            Self::Force { coordinate } => write!(f, "the force on coordinate {coordinate}"),
            Self::Constraint { row, coordinate } => {
                write!(f, "row {row} of the constraint, in its factor of velocity {coordinate},")
            }
            Self::ConstraintTerm { row } => write!(f, "row {row} of the constraint, in its term without velocities,"),
            Self::Position { row } => write!(f, "the constraint on positions of row {row}"),
            Self::Nonlinear { row } => write!(f, "row {row} of the constraint, which is not affine,"),
            Self::Basis { vector, coordinate } => {
                write!(
                    f,
                    "vector {vector} of the basis of admissible velocities, in its part along coordinate {coordinate},"
                )
            }
            Self::ReducedMotion { quasi_velocity } => {
                write!(f, "the acceleration given for quasi-velocity {quasi_velocity}")
            }
        }
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => f.write_str("the time"),
            Self::Coordinate(i) => write!(f, "coordinate {i}"),
            Self::Velocity(i) => write!(f, "velocity {i}"),
        }
    }
}

impl fmt::Display for NotANumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { function, derivative, time, .. } = self;
        match derivative {
            Derivative::Value => write!(f, "{function} has no finite value")?,
            Derivative::First(x) => write!(f, "{function} has no finite derivative in {x}")?,
            Derivative::Second(x, y) => write!(f, "{function} has no finite second derivative in {x} and {y}")?,
        }
        write!(f, " at t = {} s", lagrangian::Shown(*time))
    }
}

/// A number with a derivative in each of two variables, and the second derivative in both. It has no derivative in a variable that it does
/// not depend on: zero times infinity would be NaN.
type AnyNumber = SeldomNumber;
type Twice = Gradient<Once, 1>;
type Once = Gradient<f64, 1>;

/// The parts of the equations of motion in the order in which they are examined: first the parts that every method needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DerivativeOrder {
    /// Values of forces and constraints, first derivatives of the Lagrangian.
    Values,
    /// First derivatives of forces and constraints, second ones of the Lagrangian.
    Slopes,
    /// The value of the Lagrangian, which only an energy needs; one that is infinite may belong to large velocities with finite momenta.
    Energy,
}

/// The first function of the system, at a place and a time that are finite, that is not finite or has no finite derivative there.
///
/// It examines the derivatives that the equations of a step may need: second ones of the Lagrangian, first ones of all other functions.
/// Derivatives in velocities come first, then derivatives in coordinates and in time.
#[must_use]
#[cold]
#[inline(never)]
pub fn not_a_number<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Option<NotANumber> {
    if !(t.is_finite() && q.iter().chain(v).all(|x| x.is_finite())) {
        return None;
    }
    let found = |order| first(system, (t, q, v), order);
    found(DerivativeOrder::Values)
        .or_else(|| found(DerivativeOrder::Slopes))
        .or_else(|| by_hand(system, (t, q, v)))
        .or_else(|| found(DerivativeOrder::Energy))
}

/// An acceleration that the system gives by hand and that is not finite.
fn by_hand<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    (time, q, v): (f64, &[f64; N], &[f64; N]),
) -> Option<NotANumber> {
    let xi = quasi_velocities(system, time, q, v).ok()?;
    let accelerations = system.reduced().reduced_motion(time, q, &xi)?;
    let quasi_velocity = accelerations.iter().take(N.saturating_sub(M)).position(|x| !x.is_finite())?;
    let function = SystemFunction::ReducedMotion { quasi_velocity };
    Some(NotANumber { function, derivative: Derivative::Value, time, at_node: true })
}

fn first<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    (time, q, v): (f64, &[f64; N], &[f64; N]),
    order: DerivativeOrder,
) -> Option<NotANumber> {
    let variable = |k: usize| match k {
        k if k < N => Variable::Velocity(k),
        k if k < 2 * N => Variable::Coordinate(k - N),
        _ => Variable::Time,
    };
    let count = 2 * N + 1;
    for a in 0..count {
        for b in a..count {
            // Only the Lagrangian is differentiated twice.
            if b > a && order != DerivativeOrder::Slopes {
                break;
            }
            let (x, y) = (variable(a), variable(b));
            let seed = |of: Variable, re: f64| {
                let re = if of == y { Once::variable(re, 0) } else { Once::fixed(re) };
                Called(if of == x { Twice::variable(re, 0) } else { Twice::fixed(re) })
            };
            let (q, v) =
                (from_fn(|i| seed(Variable::Coordinate(i), q[i])), from_fn(|i| seed(Variable::Velocity(i), v[i])));
            let mut found = None;
            visit(system, seed(Variable::Time, time), &q, &v, &mut |function, Called(number)| {
                let ([once], value) = (number.gradient(), number.re.re);
                let [twice] = once.gradient();
                let once = once.re;
                let of_lagrangian = function == SystemFunction::Lagrangian;
                let (missing, derivative) = match order {
                    DerivativeOrder::Values if of_lagrangian => (!once.is_finite(), Derivative::First(x)),
                    DerivativeOrder::Slopes if of_lagrangian => (!twice.is_finite(), Derivative::Second(x, y)),
                    DerivativeOrder::Slopes => (!once.is_finite(), Derivative::First(x)),
                    DerivativeOrder::Energy => (of_lagrangian && value.is_nan(), Derivative::Value),
                    DerivativeOrder::Values => (!value.is_finite(), Derivative::Value),
                };
                if missing && found.is_none() {
                    // A function that is itself not finite is reported without a derivative.
                    let derivative = if value.is_finite() { derivative } else { Derivative::Value };
                    found = Some(NotANumber { function, derivative, time, at_node: true });
                }
            });
            if found.is_some() {
                return found;
            }
        }
    }
    None
}

/// Shows every number that the system is given by.
fn visit<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: AnyNumber,
    q: &[AnyNumber; N],
    v: &[AnyNumber; N],
    see: &mut dyn FnMut(SystemFunction, AnyNumber),
) {
    see(SystemFunction::Lagrangian, system.lagrangian(t, q, v));
    for (coordinate, force) in system.force(t, q, v).iter().flatten().enumerate() {
        see(SystemFunction::Force { coordinate }, *force);
    }
    let (rows, terms) = system.constraint(t, q);
    for (row, factors) in rows.iter().enumerate() {
        for (coordinate, factor) in factors.iter().enumerate() {
            see(SystemFunction::Constraint { row, coordinate }, *factor);
        }
    }
    for (row, term) in terms.iter().enumerate() {
        see(SystemFunction::ConstraintTerm { row }, *term);
    }
    for (row, position) in system.holonomic(t, q).iter().flatten().enumerate() {
        position.iter().for_each(|g| see(SystemFunction::Position { row }, *g));
    }
    for (row, nonlinear) in system.nonlinear(t, q, v).iter().flatten().enumerate() {
        nonlinear.iter().for_each(|phi| see(SystemFunction::Nonlinear { row }, *phi));
    }
    for (vector, parts) in system.admissible_basis(t, q).iter().flat_map(AdmissibleBasis::vectors).enumerate() {
        for (coordinate, part) in parts.iter().enumerate() {
            see(SystemFunction::Basis { vector, coordinate }, *part);
        }
    }
}
