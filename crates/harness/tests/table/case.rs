//! A row of the table, and what every row can be asked whatever its shape.

use crate::table::shapes::{Known, Place};
use dla::{Mechanism, Observer, Report, RunError, Schedule, Subject, View, make_steps};
use harness::Method;
use std::ops::ControlFlow;

/// What the checks must know of a row.
#[derive(Debug, Clone, Copy, Default)]
pub struct Facts {
    /// Explicit time, in the Lagrangian, the constraint or a force.
    pub timed: bool,
    /// Forces.
    pub forced: bool,
    /// A constraint with `b != 0`.
    pub affine: bool,
    /// A constraint on positions.
    pub positions: bool,
    /// Discrete Lagrangians and constraints with one node do not depend on the place of the node. Angular velocities are `e0` times the
    /// increment of a quaternion, and the increment times itself adds none; so one rule is all, if the length is held on positions.
    pub one_rule: bool,
    /// No basis of the admissible velocities.
    pub without_basis: bool,
    /// A Lagrangian that is not a quadratic form of the velocities and a potential.
    pub momentum_is_not_mass_times_velocity: bool,
    /// Reversed by `(q, v) -> (q, -v)`.
    pub reversible: bool,
    /// A motion that comes back again and again: worth a long run.
    pub recurrent: bool,
    /// The momenta of horizontal symmetries, by the names of their invariants.
    pub momenta: &'static [&'static str],
    /// The highest order that can be seen on this motion in double precision.
    pub highest_order: u32,
}

/// One row: a system, a start, how long, and the facts.
#[derive(Debug, Clone)]
pub struct Row<Sys, const N: usize> {
    pub name: &'static str,
    pub system: Sys,
    pub start: Place<N>,
    pub duration: f64,
    pub facts: Facts,
}

/// A configuration and a velocity of any length, angles with their full turns.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
}

impl Point {
    pub fn of<const N: usize>((q, v): &Place<N>) -> Self {
        Self { q: q.to_vec(), v: v.to_vec() }
    }

    fn place<const N: usize>(&self) -> Place<N> {
        (std::array::from_fn(|i| self.q[i]), std::array::from_fn(|i| self.v[i]))
    }

    /// The same place with the opposite velocity.
    pub fn reversed(&self) -> Self {
        Self { q: self.q.clone(), v: self.v.iter().map(|v| -v).collect() }
    }

    fn components(&self) -> impl Iterator<Item = f64> {
        self.q.iter().chain(&self.v).copied()
    }

    /// The largest difference in place and velocity; not-a-number is infinitely far.
    pub fn distance(&self, other: &Self) -> f64 {
        let differences = self.components().zip(other.components()).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { f64::max(m, d) })
    }

    /// The root of the sum of squares of the differences.
    pub fn apart(&self, other: &Self) -> f64 {
        self.components().zip(other.components()).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    /// The largest component, at least one.
    pub fn size(&self) -> f64 {
        self.components().fold(1.0, |m, x| m.max(x.abs()))
    }
}

/// A node of a run.
pub trait Node {
    fn t(&self) -> f64;
    fn energy(&self) -> f64;
    fn slip(&self) -> f64;
    fn point(&self) -> Point;
}

struct Seen<'a, 'b>(&'a View<'b>);

impl Node for Seen<'_, '_> {
    fn t(&self) -> f64 {
        self.0.t
    }
    fn energy(&self) -> f64 {
        self.0.energy()
    }
    fn slip(&self) -> f64 {
        self.0.constraint()
    }
    fn point(&self) -> Point {
        Point { q: self.0.state.unwrapped(), v: self.0.state.v().to_vec() }
    }
}

/// What looks at the nodes of a run, the first among them: one type for all, so that each method is compiled once.
pub type Watch<'a> = &'a mut dyn FnMut(&dyn Node);

struct Watching<'a>(Watch<'a>);

impl Observer for Watching<'_> {
    fn start(&mut self, node: &View<'_>) {
        (self.0)(&Seen(node));
    }
    fn step(&mut self, node: &View<'_>, _report: &Report) -> ControlFlow<()> {
        (self.0)(&Seen(node));
        ControlFlow::Continue(())
    }
}

/// Where a run of a method from a point ends, every node of which is shown.
pub fn end(
    system: &dyn Mechanism,
    method: &Method,
    from: &Point,
    when: &Schedule,
    watch: Watch<'_>,
) -> Result<Point, RunError> {
    let mut state = system.state(&from.q, &from.v);
    make_steps(system, &mut *system.integrator(method), when, 0..when.steps, &mut state, &mut Watching(watch))?;
    Ok(Point { q: state.unwrapped(), v: state.v().to_vec() })
}

/// Some rows.
pub type Rows = [Box<dyn Case>];

/// A row of any shape.
pub trait Case {
    fn name(&self) -> &'static str;
    fn facts(&self) -> &Facts;
    fn start(&self) -> Point;
    fn duration(&self) -> f64;

    /// Runs from a point, shows every node, returns the last one.
    fn run(&self, method: &Method, from: &Point, schedule: &Schedule, watch: Watch<'_>) -> Result<Point, RunError>;

    /// The state a time `t` (s) after the given one, in closed form.
    fn exact_from(&self, start: &Point, t: f64) -> Option<Point>;

    /// Integrals of the motion, by name.
    fn invariants(&self, at: &Point) -> Vec<(&'static str, f64)>;

    /// Where `steps` steps lead from the start in the row's time.
    fn end(&self, method: &Method, steps: u64) -> Result<Point, RunError> {
        self.end_after(self.duration(), method, steps)
    }

    /// Where `steps` steps lead from the start in some time (s).
    fn end_after(&self, duration: f64, method: &Method, steps: u64) -> Result<Point, RunError> {
        let schedule = Schedule { t0: 0.0, step: duration / steps as f64, steps };
        self.run(method, &self.start(), &schedule, &mut |_| {})
    }
}

macro_rules! case {
    ($shape:ty, $n:literal) => {
        impl Case for Row<$shape, $n> {
            fn name(&self) -> &'static str {
                self.name
            }
            fn facts(&self) -> &Facts {
                &self.facts
            }
            fn start(&self) -> Point {
                Point::of(&self.start)
            }
            fn duration(&self) -> f64 {
                self.duration
            }
            fn run(&self, method: &Method, from: &Point, when: &Schedule, watch: Watch<'_>) -> Result<Point, RunError> {
                end(&Subject::from(&self.system), method, from, when, watch)
            }
            fn exact_from(&self, start: &Point, t: f64) -> Option<Point> {
                self.system.exact_from(&start.place(), t).map(|place| Point::of(&place))
            }
            fn invariants(&self, at: &Point) -> Vec<(&'static str, f64)> {
                let (q, v) = at.place();
                self.system.invariants(&q, &v)
            }
        }
    };
}
case!(crate::table::shapes::Three, 3);
case!(crate::table::shapes::Four, 4);
case!(crate::table::shapes::Five, 5);
case!(crate::table::shapes::Six, 6);
case!(crate::table::shapes::Seven, 7);
