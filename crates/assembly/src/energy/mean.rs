use super::element::{Average, Swing};
use super::elements::NO_BASIS;
use super::frames::{BodyFrame, Frames};
use crate::assembly::PlacedElement;
use crate::contributions::{at, gathered};
use crate::dla::relative;
use crate::element::ElementBlocks;
use crate::local::WIDEST;
use crate::sparse::Sparse;
use crate::{Assembly, AssemblyError, AssemblyState};
use dla::Stage;

/// What the mean quasi-velocities of a step say of it.
pub(super) struct MeanPath {
    /// The mean velocities `W(q_m) x`, and where they lead.
    pub(super) v: Vec<f64>,
    pub(super) q1: Vec<f64>,
    /// The frames `W(q_m)`, and the derivatives of the mean velocities in `x`.
    middle: Vec<f64>,
    slope: Vec<f64>,
    /// `Y'` of one element after the other.
    mean_rows: Vec<f64>,
    starts: Vec<usize>,
    room: Room,
}

/// Room for what one element says.
struct Room {
    full: Vec<f64>,
    vector: Vec<f64>,
    half: Vec<f64>,
    block: Vec<f64>,
    reduced: Vec<f64>,
    rows: Vec<f64>,
    levels: Vec<f64>,
}

/// The equations for the mean quasi-velocities.
pub(super) struct SparseMeanEquations<'a> {
    pub(super) assembly: &'a Assembly,
    pub(super) frames: &'a Frames,
    pub(super) rule: &'a Average,
    pub(super) step: (f64, f64),
    pub(super) state: &'a AssemblyState,
    pub(super) mass: &'a [f64],
    pub(super) xi0: &'a [f64],
    pub(super) q0: &'a [f64],
    pub(super) kappa: f64,
    pub(super) path: &'a mut MeanPath,
    /// The work of the forces, as last evaluated (J).
    pub(super) work: f64,
}

impl MeanPath {
    pub(super) fn of(assembly: &Assembly, frames: &Frames) -> Self {
        let mut starts = vec![0];
        for part in &frames.parts {
            starts.push(starts[starts.len() - 1] + part.rows * part.at.len());
        }
        let widest = frames.parts.iter().map(|part| part.at.len()).max().unwrap_or(0).max(WIDEST);
        let (all, square) = (|| vec![0.0; assembly.coordinates()], || vec![0.0; widest * widest]);
        Self {
            v: all(),
            q1: all(),
            middle: vec![0.0; frames.room],
            slope: vec![0.0; frames.room],
            mean_rows: vec![0.0; starts[starts.len() - 1]],
            starts,
            room: Room {
                full: square(),
                vector: square(),
                half: square(),
                block: square(),
                reduced: square(),
                rows: square(),
                levels: square(),
            },
        }
    }

    /// A body with the mean quasi-velocities `x`; what its bracket turns is left in the room.
    fn swing(
        &mut self,
        (assembly, step): (&Assembly, (f64, f64)),
        body: &BodyFrame,
        q0: &[f64],
        x: &[f64],
    ) -> Result<(), AssemblyError> {
        let out = Swing {
            v: &mut self.v[body.coordinates()],
            slope: &mut self.slope[body.frames()],
            frame: &mut self.middle[body.frames()],
            turning: &mut self.room.vector[..body.quasi],
            turning_slope: &mut self.room.full[..body.quasi * body.quasi],
        };
        let element = &assembly.placed()[body.element].element;
        element.swing(step, &q0[body.coordinates()], &x[body.quasi_velocities()], out).ok_or(NO_BASIS)
    }

    /// Mean velocities and end with the mean quasi-velocities `x`.
    pub(super) fn end(
        &mut self,
        frames: &Frames,
        (assembly, t0, h): (&Assembly, f64, f64),
        (q0, state): (&[f64], &AssemblyState),
        x: &[f64],
    ) -> Result<(), AssemblyError> {
        for body in &frames.bodies {
            self.swing((assembly, (t0, h)), body, q0, x)?;
        }
        self.advance(h, state);
        Ok(())
    }

    fn advance(&mut self, h: f64, state: &AssemblyState) {
        for (i, (q1, v)) in self.q1.iter_mut().zip(&self.v).enumerate() {
            *q1 = state.ahead(i, h * v);
        }
    }

    /// Solves for the correction of the velocities `v1 = W(q1) xi1` that the constraints at the end ask for: `M d = Y alpha`,
    /// `C (xi1 + d) = 0`. Where the end is `near` that of the last projection, its factors do with refinements.
    pub(super) fn project(
        &mut self,
        assembly: &Assembly,
        frames: &Frames,
        (system, near): (&mut Sparse, bool),
        (t1, mass): (f64, &[f64]),
        (end, v1): (&[f64], &[f64]),
    ) -> Result<(), AssemblyError> {
        system.clear();
        for body in &frames.bodies {
            system.add_block(body.element, &mass[body.masses()]);
        }
        for (k, (placed, part)) in assembly.placed().iter().zip(&frames.parts).enumerate() {
            if part.rows == 0 {
                continue;
            }
            let Room { full, vector, half, block, rows, levels, .. } = &mut self.room;
            let (n, m, reduced) = (placed.at.len(), part.rows, part.at.len());
            at(placed, &self.q1, v1, |q, v| {
                let out = ElementBlocks {
                    momentum: &mut vector[..n],
                    level: &mut levels[..m],
                    block: &mut full[..if placed.element.acts() { n * n } else { 0 }],
                    rows: &mut rows[..m * n],
                    derivatives: true,
                };
                placed.element.velocity(t1, q, v, out);
            });
            system.write_levels(k, &levels[..m]);
            frames.reduce_rows(end, part, &placed.at, &rows[..m * n], &mut block[..m * reduced]);
            negated(&self.mean_rows[self.starts[k]..self.starts[k + 1]], half);
            system.write_rows(k, &half[..m * reduced], &block[..m * reduced]);
        }
        if near {
            system.linear.solve(3);
        } else {
            system.linear.factorise(Stage::Projection, None)?;
            system.linear.solve(1);
        }
        Ok(())
    }
}

impl SparseMeanEquations<'_> {
    /// Right side and, where it is asked for, the matrix: that of the potentials in the middle of the step, and without the
    /// change of `Y` and `W`, which are of the second order in the step.
    pub(super) fn evaluate(
        &mut self,
        system: &mut Sparse,
        x: &[f64],
        impulses: &[f64],
        matrix: bool,
    ) -> Result<(), AssemblyError> {
        for body in &self.frames.bodies {
            self.path.swing((self.assembly, self.step), body, self.q0, x)?;
            self.add_body(system, body, x, matrix);
        }
        self.path.advance(self.step.1, self.state);
        self.work = 0.0;
        for (k, placed) in self.assembly.placed().iter().enumerate() {
            if self.frames.parts[k].acts {
                self.add_push(system, k, placed, matrix);
            }
            if self.frames.parts[k].rows > 0 {
                self.add_constraint(system, k, placed, impulses, matrix);
            }
        }
        Ok(())
    }

    /// `2 M (x - xi0) + h S x - kappa M x`.
    fn add_body(&mut self, system: &mut Sparse, body: &BodyFrame, x: &[f64], matrix: bool) {
        let (h, kappa, k) = (self.step.1, self.kappa, body.quasi);
        let Room { full, vector, block, reduced, .. } = &mut self.path.room;
        let (x, x0) = (&x[body.quasi_velocities()], &self.xi0[body.quasi_velocities()]);
        for a in 0..k {
            let m = &self.mass[body.mass + a * k..][..k];
            let gained: f64 = (0..k).map(|b| m[b] * (2.0 * (x[b] - x0[b]) - kappa * x[b])).sum();
            reduced[a] = -gained - h * vector[a];
            for b in 0..k {
                block[a * k + b] = (2.0 - kappa) * m[b] + h * full[a * k + b];
            }
        }
        system.add_right(body.element, &reduced[..k]);
        if matrix {
            system.add_block(body.element, &block[..k * k]);
        }
    }

    /// `-W' (-h V_q + h F)`.
    fn add_push(&mut self, system: &mut Sparse, k: usize, placed: &PlacedElement, matrix: bool) {
        let (frames, part, n) = (self.frames, &self.frames.parts[k], placed.at.len());
        let MeanPath { v, middle, slope, room, .. } = &mut *self.path;
        let Room { full, vector, half, block, reduced, .. } = room;
        let out = (&mut vector[..n], &mut full[..n * n]);
        self.work += at(placed, self.q0, v, |q, v| placed.element.push(self.step, self.rule, q, v, out));
        let columns = part.at.len();
        frames.reduce(middle, part, &placed.at, &vector[..n], &mut reduced[..columns]);
        system.add_right(k, &reduced[..columns]);
        if matrix {
            let block = &mut block[..columns * columns];
            frames.reduce_block([middle, slope], part, &placed.at, &full[..n * n], (&mut half[..n * columns], block));
            block.iter_mut().for_each(|x| *x = -*x);
            system.add_block(k, block);
        }
    }

    /// `-Y lambda`, and `g(q1) = 0` or `A(q_m) v = 0`.
    fn add_constraint(
        &mut self,
        system: &mut Sparse,
        k: usize,
        placed: &PlacedElement,
        impulses: &[f64],
        matrix: bool,
    ) {
        let (frames, part, n) = (self.frames, &self.frames.parts[k], placed.at.len());
        let MeanPath { v, q1, middle, slope, mean_rows, starts, room } = &mut *self.path;
        let Room { full, vector, half, block, reduced, rows, levels } = room;
        let (m, columns, mean) = (part.rows, part.at.len(), &mut mean_rows[starts[k]..starts[k + 1]]);
        at(placed, self.q0, v, |q, v| {
            placed.element.mean_rows(self.step, self.rule, q, v, &mut rows[..m * n]);
        });
        frames.reduce_rows(middle, part, &placed.at, &rows[..m * n], mean);
        let acting = &mut reduced[..columns];
        acting.fill(0.0);
        for (row, impulse) in mean.chunks_exact(columns).zip(&impulses[part.row..]) {
            acting.iter_mut().zip(row).for_each(|(sum, y)| *sum += y * impulse);
        }
        system.add_right(k, acting);

        let out = ElementBlocks {
            momentum: &mut vector[..n],
            level: &mut levels[..m],
            block: &mut full[..if part.acts { n * n } else { 0 }],
            rows: &mut rows[..m * n],
            derivatives: true,
        };
        at(placed, self.q0, v, |q0, own| match &placed.origins {
            None => gathered(placed, |i| q1[i], |q1| placed.element.increment(self.step, [q0, q1], own, out)),
            Some(origins) => relative(placed, origins, self.step.1, self.state, own, |q1| {
                placed.element.increment(self.step, [q0, q1], own, out);
            }),
        });
        system.write_levels(k, &levels[..m]);
        if matrix {
            frames.reduce_rows(slope, part, &placed.at, &rows[..m * n], &mut block[..m * columns]);
            negated(mean, half);
            system.write_rows(k, &half[..m * columns], &block[..m * columns]);
        }
    }
}

fn negated(x: &[f64], into: &mut [f64]) {
    into.iter_mut().zip(x).for_each(|(y, x)| *y = -x);
}
