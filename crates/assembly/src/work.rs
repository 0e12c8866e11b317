use crate::Assembly;
use crate::contributions::{at, gathered};
use crate::element::{ElementBlocks, with_room};
use crate::motion::ElementMotion;
use dla::{Hermite, Place};
use lagrangian::PowerSources;
use lagrangian::quadrature::gauss_legendre;

/// Integrates the work done on an assembly over a step.
///
/// As in [`dla::Work`], summed over the elements: the power `F . v - dL/dt - lambda . b` is integrated with four Gauss nodes along the
/// polynomial of degree five through the positions, velocities and accelerations at both ends of the step, which has order 6. A step whose
/// forces and moving constraints have no power needs no acceleration.
pub(crate) struct StepWork {
    nodes: [f64; 4],
    weights: [f64; 4],
    /// The solver for accelerations, made when first needed; `Err` if the memory did not suffice.
    motion: Option<Result<ElementMotion, ()>>,
    ends: [WorkEnd; 2],
    q: Vec<f64>,
    v: Vec<f64>,
    /// The work between these ends (J), if it is known: several observers ask for the work of one step.
    known: Option<f64>,
}

/// An end of a step.
#[derive(Default)]
struct WorkEnd {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl WorkEnd {
    fn is(&self, (t, q, v): Place<'_>) -> bool {
        self.t.to_bits() == t.to_bits() && self.q == q && self.v == v
    }

    /// Copies a place of an assembly with this number of coordinates.
    fn see(&mut self, (t, q, v): Place<'_>, all: usize) {
        self.t = t;
        for (own, x) in [(&mut self.q, q), (&mut self.v, v)] {
            own.clear();
            own.extend_from_slice(x);
            own.resize(all, f64::NAN);
        }
    }
}

impl Default for StepWork {
    fn default() -> Self {
        let (nodes, weights) = gauss_legendre();
        let (ends, none) = ([WorkEnd::default(), WorkEnd::default()], Vec::new);
        Self { nodes, weights, motion: None, ends, q: none(), v: none(), known: None }
    }
}

impl StepWork {
    /// The work of a step from one place to another (J). The work is NaN if the accelerations are not determined.
    pub(crate) fn between(
        &mut self,
        (assembly, sources): (&Assembly, PowerSources),
        from: Place<'_>,
        to: Place<'_>,
    ) -> f64 {
        let [first, last] = &mut self.ends;
        if let Some(known) = self.known.filter(|_| first.is(from) && last.is(to)) {
            return known;
        }
        first.see(from, assembly.coordinates());
        last.see(to, assembly.coordinates());
        let work = self.integrated(assembly, sources);
        self.known = Some(work);
        work
    }

    fn integrated(&mut self, assembly: &Assembly, sources: PowerSources) -> f64 {
        let [first, last] = &self.ends;
        let (t0, t1) = (first.t, last.t);
        let h = t1 - t0;
        let moved = sources.constraints && (moves(assembly, t0, &first.q) || moves(assembly, t1, &last.q));
        if !moved && !((sources.forces || sources.time) && self.is_powered(assembly, t0, h)) {
            return 0.0;
        }
        let motion = self.motion.get_or_insert_with(|| ElementMotion::of(assembly).map_err(|_| ()));
        let Ok(motion) = motion else { return f64::NAN };
        for WorkEnd { t, q, v, a } in &mut self.ends {
            let Ok((accelerations, _)) = motion.solved(assembly, *t, q, v) else { return f64::NAN };
            a.clear();
            a.extend_from_slice(accelerations);
        }
        let [first, last] = &self.ends;
        let mut sum = 0.0;
        for (c, weight) in self.nodes.into_iter().zip(self.weights) {
            self.q.resize(first.q.len(), 0.0);
            self.v.resize(first.q.len(), 0.0);
            for (i, (q, v)) in self.q.iter_mut().zip(&mut self.v).enumerate() {
                let end = |end: &WorkEnd| [[end.q[i]], [end.v[i]], [end.a[i]]];
                ([*q], [*v]) = Hermite::through((t0, h), end(first), end(last)).at_part(c);
            }
            let (t, q, v) = (t0 + c * h, &self.q[..], &self.v[..]);
            let mut power = power(assembly, t, q, v);
            if moved {
                let Ok((_, multipliers)) = motion.solved(assembly, t, q, v) else { return f64::NAN };
                power -= carried(assembly, t, q, v, multipliers);
            }
            sum += weight * power;
        }
        h * sum
    }

    /// Whether forces or explicit time have power at an end of the step, or at a node on the straight line between the ends.
    fn is_powered(&mut self, assembly: &Assembly, t0: f64, h: f64) -> bool {
        let [first, last] = &self.ends;
        [0.0, 1.0].into_iter().chain(self.nodes).any(|c| {
            let along = |into: &mut Vec<f64>, from: &[f64], to: &[f64]| {
                into.clear();
                into.extend(from.iter().zip(to).map(|(from, to)| from + c * (to - from)));
            };
            along(&mut self.q, &first.q, &last.q);
            along(&mut self.v, &first.v, &last.v);
            power(assembly, t0 + c * h, &self.q, &self.v) != 0.0
        })
    }
}

/// The power of all forces and of time (W).
fn power(assembly: &Assembly, t: f64, q: &[f64], v: &[f64]) -> f64 {
    let each = assembly.placed().iter().map(|placed| at(placed, q, v, |q, v| placed.element.power(t, q, v)));
    each.sum()
}

/// Whether a constraint moves: `b` does not vanish.
pub(crate) fn moves(assembly: &Assembly, t: f64, q: &[f64]) -> bool {
    assembly.placed().iter().filter(|placed| placed.rows > 0).any(|placed| {
        with_room(placed.at.len(), |rest| {
            with_room(placed.rows, |level| {
                let (momentum, block, rows) = Default::default();
                let out = ElementBlocks { momentum, level: &mut *level, block, rows, derivatives: false };
                gathered(placed, q, |q| placed.element.velocity(t, q, rest, out));
                level.iter().any(|b| *b != 0.0)
            })
        })
    })
}

/// `mu . A v`: on the constraint it is `-mu . b`, and off it keeps its order.
fn carried(assembly: &Assembly, t: f64, q: &[f64], v: &[f64], multipliers: &[f64]) -> f64 {
    let mut numbers = Vec::new();
    let each = assembly.placed().iter().filter(|placed| placed.rows > 0).map(|placed| {
        let (n, m) = (placed.at.len(), placed.rows);
        numbers.resize(n + m * n, 0.0);
        let (momentum, rows) = numbers.split_at_mut(n);
        at(placed, q, v, |q, v| {
            let out = ElementBlocks { momentum, level: &mut [], block: &mut [], rows: &mut *rows, derivatives: false };
            placed.element.beginning(t, q, v, out);
            let along = |row: &[f64]| row.iter().zip(v).map(|(a, v)| a * v).sum::<f64>();
            rows.chunks_exact(n).zip(&multipliers[placed.row..]).map(|(row, mu)| mu * along(row)).sum::<f64>()
        })
    });
    each.sum()
}
