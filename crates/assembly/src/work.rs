use crate::contributions::{at, gathered};
use crate::element::ElementBlocks;
use crate::local::WIDEST;
use crate::motion::ElementMotion;
use crate::{Assembly, AssemblyState};
use dla::{Checkpoint, CheckpointError, Hermite};
use lagrangian::added;
use lagrangian::quadrature::gauss_legendre;

/// The work done on an assembly since the start of a run (J), so that `E(t) - E(0) - work` is the error of the energy.
///
/// As in [`dla::Work`], summed over the elements: the power `F . v - dL/dt - lambda . b` is integrated with four Gauss nodes along the
/// polynomial of degree five through the positions, velocities and accelerations at both ends of the step, which has order 6. A step whose
/// forces and moving constraints have no power needs no acceleration.
pub struct AssemblyWork {
    total: f64,
    rest: f64,
    nodes: [f64; 4],
    weights: [f64; 4],
    /// The solver for accelerations, made when first needed; `Err` if the memory did not suffice.
    motion: Option<Result<ElementMotion, ()>>,
    ends: [WorkEnd; 2],
    q: Vec<f64>,
    v: Vec<f64>,
}

/// An end of a step.
#[derive(Debug, Clone, Default)]
struct WorkEnd {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl WorkEnd {
    fn see(&mut self, state: &AssemblyState) {
        self.q.clear();
        self.v.clear();
        self.q.extend((0..state.len()).map(|i| state.unwrapped(i)));
        self.v.extend((0..state.len()).map(|i| state.v(i)));
    }
}

impl std::fmt::Debug for AssemblyWork {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Work").field("total", &self.total).field("rest", &self.rest).finish_non_exhaustive()
    }
}

impl Default for AssemblyWork {
    fn default() -> Self {
        let (nodes, weights) = gauss_legendre();
        let (ends, none) = ([WorkEnd::default(), WorkEnd::default()], Vec::new);
        Self { total: 0.0, rest: 0.0, nodes, weights, motion: None, ends, q: none(), v: none() }
    }
}

impl AssemblyWork {
    /// The work so far (J).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Writes the work to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("work", &[self.total, self.rest]);
    }

    /// The work that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has no work.
    pub fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [total, rest] = checkpoint.get("work")?;
        Ok(Self { total, rest, ..Self::default() })
    }

    /// The sum with its rest (J), for [`back_to`](Self::back_to).
    #[must_use]
    pub fn sum(&self) -> [f64; 2] {
        [self.total, self.rest]
    }

    /// Restores an earlier [`sum`](Self::sum), for steps that are discarded.
    pub fn back_to(&mut self, sum: [f64; 2]) {
        [self.total, self.rest] = sum;
    }

    /// Adds the work of a step from one time and state to another. The work is NaN if the accelerations are not determined.
    pub fn step(&mut self, assembly: &Assembly, before: (f64, &AssemblyState), after: (f64, &AssemblyState)) {
        let work = self.over_step(assembly, before, after);
        self.add(work);
    }

    /// Adds the work of an impulse (J).
    pub fn add(&mut self, work: f64) {
        if work != 0.0 {
            // With compensation.
            (self.total, self.rest) = added(self.total, work + self.rest);
        }
    }

    fn over_step(
        &mut self,
        assembly: &Assembly,
        (t0, before): (f64, &AssemblyState),
        (t1, after): (f64, &AssemblyState),
    ) -> f64 {
        let [first, last] = &mut self.ends;
        first.see(before);
        last.see(after);
        let (h, moved) = (t1 - t0, moves(assembly, t0, &first.q) || moves(assembly, t1, &last.q));
        if !moved && !self.is_powered(assembly, t0, h) {
            return 0.0;
        }
        let motion = self.motion.get_or_insert_with(|| ElementMotion::of(assembly).map_err(|_| ()));
        let Ok(motion) = motion else { return f64::NAN };
        for (t, WorkEnd { q, v, a }) in [t0, t1].into_iter().zip(&mut self.ends) {
            let Ok((accelerations, _)) = motion.solved(assembly, t, q, v) else { return f64::NAN };
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
fn moves(assembly: &Assembly, t: f64, q: &[f64]) -> bool {
    let (mut momentum, mut level, rest) = ([0.0; WIDEST], [0.0; WIDEST], [0.0; WIDEST]);
    assembly.placed().iter().filter(|placed| placed.rows > 0).any(|placed| {
        let (n, m) = (placed.at.len(), placed.rows);
        let level = &mut level[..m];
        let out = ElementBlocks {
            momentum: &mut momentum[..n],
            level: &mut *level,
            block: &mut [],
            rows: &mut [],
            derivatives: false,
        };
        gathered(placed, |i| q[i], |q| placed.element.velocity(t, q, &rest[..n], out));
        level.iter().any(|b| *b != 0.0)
    })
}

/// `mu . A v`: on the constraint it is `-mu . b`, and off it keeps its order.
fn carried(assembly: &Assembly, t: f64, q: &[f64], v: &[f64], multipliers: &[f64]) -> f64 {
    let (mut momentum, mut rows) = ([0.0; WIDEST], [0.0; WIDEST * WIDEST]);
    let each = assembly.placed().iter().filter(|placed| placed.rows > 0).map(|placed| {
        let (n, m) = (placed.at.len(), placed.rows);
        let rows = &mut rows[..m * n];
        at(placed, q, v, |q, v| {
            let out = ElementBlocks {
                momentum: &mut momentum[..n],
                level: &mut [],
                block: &mut [],
                rows: &mut *rows,
                derivatives: false,
            };
            placed.element.beginning(t, q, v, out);
            let along = |row: &[f64]| row.iter().zip(v).map(|(a, v)| a * v).sum::<f64>();
            rows.chunks_exact(n).zip(&multipliers[placed.row..]).map(|(row, mu)| mu * along(row)).sum::<f64>()
        })
    });
    each.sum()
}
