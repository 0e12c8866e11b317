use crate::TextModel;
use crate::slices::TextSlices;
use assembly::{Element, ElementBlocks};
use dla::{Derivative, NotANumber, SystemFunction, Variable};
use lagrangian::linear::largest;
use lagrangian::{Dual, PowerSources, Rounded, Scalar, Seeded, Traced};
use std::array::from_fn;
use std::ops::Range;
use std::sync::Arc;

/// A system of text in its own size, of any number of coordinates, as the one element of an assembly.
#[derive(Debug, Clone)]
pub(crate) struct TextElement {
    model: Arc<TextModel>,
    /// The sides of the corners in time on this smooth piece.
    sides: Vec<f64>,
}

/// How many directions a number carries.
const AT_ONCE: usize = 8;

impl TextElement {
    pub(crate) fn new(model: Arc<TextModel>) -> Self {
        Self { model, sides: Vec::new() }
    }

    /// The functions of the system.
    fn on<S: Scalar>(&self) -> TextSlices<'_, S> {
        TextSlices::of(&self.model, &self.sides)
    }

    fn n(&self) -> usize {
        self.model.coordinates.len()
    }

    /// `h (L_q + F) / 2` at the middle of a step, and `L_v` there: the momenta at its ends are the first less and plus the second.
    fn halves<S: Scalar>(&self, (t0, h): (f64, f64), q: &[S], v: &[S]) -> [Vec<S>; 2] {
        let t = S::constant(t0 + 0.5 * h);
        let mut slopes = self.on().slopes(t, q, v);
        let momentum = slopes.split_off(self.n());
        for (slope, force) in slopes.iter_mut().zip(self.on().force(t, q, v)) {
            *slope = (*slope + force) * (0.5 * h);
        }
        [slopes, momentum]
    }

    /// The configuration in the middle of a step.
    fn middle(h: f64, q0: &[f64], v: &[f64]) -> Vec<f64> {
        q0.iter().zip(v).map(|(q, v)| q + 0.5 * h * v).collect()
    }

    /// Shows a state on numbers with derivatives along `(dq, dv) = (in_q, in_v) e_j` of eight coordinates at a time, until all have been
    /// shown.
    fn along_each(
        &self,
        [q, v]: [&[f64]; 2],
        [in_q, in_v]: [f64; 2],
        mut see: impl FnMut(Range<usize>, &[Seeded], &[Seeded]),
    ) {
        for from in (0..self.n()).step_by(AT_ONCE) {
            let own = from..self.n().min(from + AT_ONCE);
            let along = |x: &[f64], by: f64| -> Vec<Seeded> {
                let one =
                    |(i, x): (usize, &f64)| Dual { re: *x, eps: from_fn(|k| if from + k == i { by } else { 0.0 }) };
                x.iter().enumerate().map(one).collect()
            };
            see(own, &along(q, in_q), &along(v, in_v));
        }
    }

    /// Writes the derivatives of a value along the directions of `own` in a row of a matrix of `n` columns.
    fn write(&self, own: &Range<usize>, matrix: &mut [f64], row: usize, value: &Seeded) {
        let to = &mut matrix[row * self.n()..][own.clone()];
        to.copy_from_slice(&value.eps[..own.len()]);
    }

    /// Whether a constraint is one on positions, with its number among these.
    fn position_of(&self, row: usize) -> Option<usize> {
        row.checked_sub(self.model.velocities)
    }
}

impl Element for TextElement {
    fn size(&self) -> (usize, usize) {
        (self.n(), self.model.constraints())
    }

    fn acts(&self) -> bool {
        true
    }

    fn angles(&self, angles: &mut [bool]) {
        for (angle, coordinate) in angles.iter_mut().zip(&self.model.coordinates) {
            *angle = coordinate.unit == crate::Unit::Angle;
        }
    }

    fn jump_times(&self, from: f64, to: f64) -> Vec<f64> {
        self.model.jumps(from, to).unwrap_or_default()
    }

    fn smooth_piece(&self, t: f64) -> Option<Box<dyn Element>> {
        let pieces = self.model.pieces.as_ref()?;
        Some(Box::new(Self { model: Arc::clone(&pieces.model), sides: pieces.corners.sides(t) }))
    }

    fn beginning(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        out.momentum.copy_from_slice(&self.on().momentum(t, q, v));
        out.rows.copy_from_slice(&self.on().constraint(t, q)[..out.rows.len()]);
    }

    fn increment(&self, step: (f64, f64), [q0, q1]: [&[f64]; 2], v: &[f64], out: ElementBlocks<'_>) {
        let ((t0, h), q) = (step, Self::middle(step.1, q0, v));
        let t = t0 + 0.5 * h;
        if out.derivatives {
            self.along_each([&q, v], [0.5 * h, 1.0], |own, q, v| {
                let [halves, momentum] = self.halves(step, q, v);
                for (i, (half, p)) in halves.iter().zip(&momentum).enumerate() {
                    let d1 = *half - *p;
                    out.momentum[i] = d1.re;
                    self.write(&own, out.block, i, &d1);
                }
                for (k, w) in self.on().residual(Dual::fixed(t), q, v).iter().enumerate() {
                    out.level[k] = -w.re;
                    self.write(&own, out.rows, k, w);
                }
            });
        } else {
            let [halves, momentum] = self.halves(step, &q, v);
            for (to, (half, p)) in out.momentum.iter_mut().zip(halves.iter().zip(&momentum)) {
                *to = half - p;
            }
            for (level, w) in out.level.iter_mut().zip(self.on().residual(t, &q, v)) {
                *level = -w;
            }
        }
        // Where it constrains positions, in place of the discrete constraint.
        if self.model.positions > 0 {
            let (n, rows) = (self.n(), self.on().constraint(t0 + h, q1));
            for (g, k) in self.on().positions(t0 + h, q1).into_iter().zip(self.model.velocities..) {
                let row = &rows[k * n..(k + 1) * n];
                let rounding: f64 = row.iter().zip(q1).map(|(slope, q)| (slope * q).abs()).sum();
                out.level[k] = if g.abs() <= 2.0 * f64::EPSILON * rounding { 0.0 } else { -g / h };
                if out.derivatives {
                    out.rows[k * n..(k + 1) * n].copy_from_slice(row);
                }
            }
        }
    }

    fn end(&self, step: (f64, f64), q0: &[f64], v: &[f64], p1: &mut [f64]) {
        let [halves, momentum] = self.halves(step, &Self::middle(step.1, q0, v), v);
        for (to, (half, p)) in p1.iter_mut().zip(halves.iter().zip(&momentum)) {
            *to = half + p;
        }
    }

    fn velocity(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let n = self.n();
        if out.derivatives {
            let mass = self.on().mass(t, q, v);
            out.block.copy_from_slice(&mass[..n * n]);
            out.momentum.copy_from_slice(&mass[n * n..]);
            out.rows.copy_from_slice(&self.on().constraint(t, q)[..n * self.model.constraints()]);
        } else if !out.momentum.is_empty() {
            out.momentum.copy_from_slice(&self.on().momentum(t, q, v));
        }
        for (level, w) in out.level.iter_mut().zip(self.on().residual(t, q, v)) {
            *level = -w;
        }
    }

    #[cold]
    fn sizes(&self, (t, h): (f64, f64), q: &[f64], v: &[f64], momentum: &mut [f64], level: &mut [f64]) {
        let once = |x: &[f64]| -> Vec<Rounded> { x.iter().copied().map(Rounded::once).collect() };
        let (t, q, v) = (Rounded::exact(t), once(q), once(v));
        let (slopes, force) = (self.on().slopes(t, &q, &v), self.on().force(t, &q, &v));
        for (i, size) in momentum.iter_mut().enumerate() {
            *size = slopes[self.n() + i].size + h.abs() * (slopes[i].size + force[i].size);
        }
        let positions = self.on().positions(t, &q);
        for (k, (size, w)) in level.iter_mut().zip(self.on().residual(t, &q, &v)).enumerate() {
            *size = w.size + self.position_of(k).map_or(0.0, |g| positions[g].size / h.abs());
        }
    }

    fn motion(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        let motion = self.on().motion(t, q, v);
        out.block.copy_from_slice(&motion.block);
        out.rows.copy_from_slice(&motion.rows);
        out.momentum.copy_from_slice(&motion.right);
        out.level.copy_from_slice(&motion.level);
    }

    fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let along: f64 = self.on().momentum(t, q, v).iter().zip(v).map(|(p, v)| p * v).sum();
        along - self.on().lagrangian(t, q, v)
    }

    fn power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        let fixed = |x: &[f64]| -> Vec<_> { x.iter().copied().map(Dual::fixed).collect() };
        let of_time = self.on().lagrangian(Dual { re: t, eps: [1.0] }, &fixed(q), &fixed(v)).eps[0];
        let of_forces: f64 = self.on().force(t, q, v).iter().zip(v).map(|(force, v)| force * v).sum();
        of_forces - of_time
    }

    fn misses(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; 2] {
        [largest(&self.on().residual(t, q, v)), largest(&self.on().positions(t, q))]
    }

    fn turn(&self, (t0, h): (f64, f64), q0: &[f64], v: &[f64]) -> f64 {
        let (n, mut angles) = (self.n(), vec![false; self.n()]);
        self.angles(&mut angles);
        let increment: Vec<f64> = v.iter().map(|v| h * v).collect();
        dla::turn(&angles, &increment, || {
            let along: Vec<_> = q0.iter().zip(&increment).map(|(q, dq)| Dual { re: *q, eps: [*dq] }).collect();
            let constraint = self.on().constraint(Dual { re: t0, eps: [h] }, &along);
            constraint[..n * self.model.constraints()].chunks_exact(n).map(<[_]>::to_vec).collect::<Vec<_>>()
        })
    }

    fn power_sources(&self) -> PowerSources {
        let state = vec![Traced::STATE; self.n()];
        let constraint = self.on().constraint(Traced::TIME, &state);
        PowerSources {
            time: self.on().lagrangian(Traced::TIME, &state, &state).of_time,
            forces: !self.on().force(Traced::TIME, &state, &state).iter().all(Scalar::is_zero),
            constraints: !constraint[self.n() * self.model.constraints()..].iter().all(Scalar::is_zero),
        }
    }

    fn damping(&self, (t0, h): (f64, f64), q0: &[f64], [v, v1]: [&[f64]; 2]) -> f64 {
        if self.model.force.is_none() {
            return 0.0;
        }
        let (t, q) = (t0 + 0.5 * h, Self::middle(h, q0, v));
        dla::damping(h, [v, v1], [&self.on().force(t, &q, v), &self.on().force(t, &q, v1)])
    }

    fn inertia(&self, (t0, h): (f64, f64), q0: &[f64], [v, v1]: [&[f64]; 2]) -> [f64; 2] {
        let (t, q) = (t0 + 0.5 * h, Self::middle(h, q0, v));
        dla::inertia([v, v1], [&self.on().momentum(t, &q, v), &self.on().momentum(t, &q, v1)])
    }

    #[cold]
    fn not_a_number(&self, t: f64, q: &[f64], v: &[f64]) -> Option<NotANumber> {
        let lost = |function, derivative| Some(NotANumber { function, derivative, time: t, at_node: true });
        if let Some(function) = self.first(
            &self.on().slopes(t, q, v),
            &self.on().force(t, q, v),
            &self.on().constraint(t, q),
            f64::is_finite,
        ) {
            return lost(function, Derivative::Value);
        }
        if let Some(g) = self.on().positions(t, q).iter().position(|g| !g.is_finite()) {
            return lost(SystemFunction::Position { row: self.model.velocities + g }, Derivative::Value);
        }
        let mut found = None;
        for (in_q, in_v) in [(0.0, 1.0), (1.0, 0.0)] {
            self.along_each([q, v], [in_q, in_v], |own, q, v| {
                let t = Dual::fixed(t);
                let (slopes, force, constraint) =
                    (self.on().slopes(t, q, v), self.on().force(t, q, v), self.on().constraint(t, q));
                for (k, i) in own.enumerate() {
                    let variable = if in_v > 0.0 { Variable::Velocity(i) } else { Variable::Coordinate(i) };
                    let first = self.first(&slopes, &force, &constraint, |x: Seeded| x.eps[k].is_finite());
                    found = found.or(first.map(|function| (function, Derivative::First(variable))));
                }
            });
        }
        found.and_then(|(function, derivative)| lost(function, derivative))
    }
}

impl TextElement {
    /// The first function that is not as it must be. A derivative of the Lagrangian counts as the Lagrangian.
    fn first<S: Copy>(
        &self,
        slopes: &[S],
        force: &[S],
        constraint: &[S],
        is_right: impl Fn(S) -> bool,
    ) -> Option<SystemFunction> {
        let wrong = |all: &[S]| all.iter().position(|x| !is_right(*x));
        let (n, all) = (self.n(), self.n() * self.model.constraints());
        let of_force = || wrong(force).map(|coordinate| SystemFunction::Force { coordinate });
        let of_constraint = || {
            wrong(constraint).map(|k| match k.checked_sub(all) {
                Some(row) => SystemFunction::ConstraintTerm { row },
                None => SystemFunction::Constraint { row: k / n, coordinate: k % n },
            })
        };
        wrong(slopes).map(|_| SystemFunction::Lagrangian).or_else(of_force).or_else(of_constraint)
    }
}
