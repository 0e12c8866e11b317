use super::element::StageTerms;
use crate::assembly::PlacedElement;
use crate::contributions::gathered;
use crate::local::WIDEST;
use crate::sparse::Sparse;
use crate::{Assembly, AssemblyState};
use dla::LobattoTables;

/// The coefficients of a Lobatto pair, their number a value: see [`LobattoTables`].
#[derive(Debug, Clone)]
pub(super) struct LobattoRule {
    pub(super) stages: usize,
    pub(super) c: Vec<f64>,
    pub(super) b: Vec<f64>,
    /// By rows.
    a: Vec<f64>,
    a_hat: Vec<f64>,
    blind: Vec<f64>,
}

impl LobattoRule {
    pub(super) fn of<const S: usize>() -> Self {
        let LobattoTables { c, b, a, a_hat, blind } = LobattoTables::<S>::new();
        let flat = |x: &[[f64; S]; S]| x.as_flattened().to_vec();
        Self { stages: S, c: c.to_vec(), b: b.to_vec(), a: flat(&a), a_hat: flat(&a_hat), blind: blind.to_vec() }
    }

    fn a(&self, i: usize) -> &[f64] {
        &self.a[i * self.stages..][..self.stages]
    }

    fn a_hat(&self, i: usize) -> &[f64] {
        &self.a_hat[i * self.stages..][..self.stages]
    }
}

/// The increment `h sum_j factors_j V_j` of a coordinate, `share` the sum of the factors; summed about the velocity at the start,
/// so that the rounding of the factors multiplies differences only.
pub(super) fn increment(h: f64, factors: &[f64], share: f64, v0: f64, v: &[f64]) -> f64 {
    let excess: f64 = factors.iter().zip(v).map(|(factor, v)| factor * (v - v0)).sum();
    h * (share * v0 + excess)
}

/// The equations for the velocities of all stages of a step, and the impulses of all but the last.
pub(super) struct AssemblyStages<'a> {
    pub(super) assembly: &'a Assembly,
    pub(super) rule: &'a LobattoRule,
    pub(super) step: (f64, f64),
    pub(super) state: &'a AssemblyState,
    pub(super) p0: &'a [f64],
    pub(super) terms: &'a mut [StageTerms],
    pub(super) room: &'a mut StageRoom,
}

/// Room for what one element says of all stages.
pub(super) struct StageRoom {
    right: Vec<f64>,
    block: Vec<f64>,
    levels: Vec<f64>,
    acting: Vec<f64>,
    rows: Vec<f64>,
}

impl StageRoom {
    /// For the widest of the elements.
    pub(super) fn of(assembly: &Assembly, stages: usize) -> Self {
        let widest = assembly.placed().iter().map(|placed| placed.at.len()).max().unwrap_or(0) * stages;
        let (vector, matrix) = (|| vec![0.0; widest], || vec![0.0; widest * widest]);
        Self { right: vector(), block: matrix(), levels: vector(), acting: matrix(), rows: matrix() }
    }
}

impl AssemblyStages<'_> {
    /// What an element says at every stage, in the terms: `v` has the velocities of the stages of one coordinate after the other.
    pub(super) fn ask(&mut self, placed: &PlacedElement, v: &[f64], impulses: &[f64]) {
        let (t0, h, s) = (self.step.0, self.step.1, self.rule.stages);
        let state = self.state;
        let own = |i: usize| &v[i * s..][..s];
        for (j, terms) in self.terms.iter_mut().enumerate() {
            let moved = |i: usize| increment(h, self.rule.a(j), self.rule.c[j], state.v(i), own(i));
            let mut q = [0.0; WIDEST];
            let n = placed.gather(|i| state.ahead(i, moved(i)), &mut q);
            for (k, origin) in placed.origins.iter().flatten().enumerate() {
                let from = |o: usize| state.apart(placed.at[k], o) + (moved(placed.at[k]) - moved(o));
                q[k] = origin.map_or(q[k], |origin| from(placed.at[origin]));
            }
            let m = placed.rows;
            let first = (s - 1) * placed.row + j * m;
            // The impulses of the last stage are those of the projection.
            let impulses = if j + 1 < s { &impulses[first..first + m] } else { &[] };
            gathered(
                placed,
                |i| v[i * s + j],
                |v| {
                    placed.element.stage((t0 + self.rule.c[j] * h, h), &q[..n], v, impulses, terms);
                },
            );
        }
    }

    /// Right side and, where it is asked for, the matrix; that without the curvature of joints, which is of the second order in
    /// the step.
    pub(super) fn evaluate(&mut self, system: &mut Sparse, v: &[f64], impulses: &[f64], matrix: bool) {
        let s = self.rule.stages;
        for (right, p0) in system.linear.right.chunks_exact_mut(s).zip(self.p0) {
            right.fill(*p0);
        }
        let assembly = self.assembly;
        for (k, placed) in assembly.placed().iter().enumerate() {
            self.ask(placed, v, impulses);
            let (n, m) = (placed.at.len(), placed.rows);
            self.momenta(n);
            system.add_right(k, &self.room.right[..s * n]);
            if matrix && placed.element.acts() {
                self.block(n);
                system.add_block(k, &self.room.block[..s * n * s * n]);
            }
            if m > 0 {
                self.constraints(n, m);
                system.write_levels(k, &self.room.levels[..(s - 1) * m]);
                if matrix {
                    let rows = (s - 1) * m * s * n;
                    system.write_rows(k, &self.room.acting[..rows], &self.room.rows[..rows]);
                }
            }
        }
    }

    /// `-p_i + sum_j a^_ij w_j`.
    fn momenta(&mut self, n: usize) {
        for (i, right) in self.room.right.chunks_exact_mut(n).take(self.rule.stages).enumerate() {
            for (x, right) in right.iter_mut().enumerate() {
                let gained: f64 = self.terms.iter().zip(self.rule.a_hat(i)).map(|(terms, a)| a * terms.w[x]).sum();
                *right = gained - self.terms[i].p[x];
            }
        }
    }

    /// The derivatives of `p_i - sum_j a^_ij w_j` in the velocities of the stages.
    fn block(&mut self, n: usize) {
        let (h, s, rule) = (self.step.1, self.rule.stages, self.rule);
        for i in 0..s {
            for x in 0..n {
                let row = &mut self.room.block[(i * n + x) * s * n..][..s * n];
                for k in 0..s {
                    for y in 0..n {
                        let at = x * n + y;
                        // The first stage is at the start whatever the velocities are.
                        let moved: f64 =
                            (1..s - 1).map(|j| rule.a_hat(i)[j] * rule.a(j)[k] * self.terms[j].w_q[at]).sum();
                        let mut sum = h * (rule.a(i)[k] * self.terms[i].p_q[at] - moved);
                        sum -= rule.a_hat(i)[k] * self.terms[k].w_v[at];
                        if i == k {
                            sum += self.terms[i].p_v[at];
                        }
                        row[k * n + y] = sum;
                    }
                }
            }
        }
    }

    /// `g_i - blind_i g_0 = 0`, or of positions `g_i = 0`, of all stages but the first; and how the impulses act.
    fn constraints(&mut self, n: usize, m: usize) {
        let (h, s, rule, terms) = (self.step.1, self.rule.stages, self.rule, &*self.terms);
        let StageRoom { levels, acting, rows, .. } = &mut *self.room;
        for i in 1..s {
            for k in 0..m {
                let equation = (i - 1) * m + k;
                let row = &mut rows[equation * s * n..][..s * n];
                let own = k * n;
                if terms[i].holds[k] {
                    levels[equation] = -terms[i].position[k] / h;
                    for j in 0..s {
                        for y in 0..n {
                            row[j * n + y] = rule.a(i)[j] * terms[i].position_q[own + y];
                        }
                    }
                } else {
                    levels[equation] = rule.blind[i] * terms[0].g[k] - terms[i].g[k];
                    for j in 0..s {
                        for y in 0..n {
                            row[j * n + y] = h * rule.a(i)[j] * terms[i].g_q[own + y];
                        }
                    }
                    for y in 0..n {
                        row[i * n + y] += terms[i].a[own + y];
                        row[y] -= rule.blind[i] * terms[0].a[own + y];
                    }
                }
            }
        }
        for j in 0..s - 1 {
            for k in 0..m {
                let row = &mut acting[(j * m + k) * s * n..][..s * n];
                for i in 0..s {
                    for x in 0..n {
                        row[i * n + x] = -rule.a_hat(i)[j] * terms[j].a[k * n + x];
                    }
                }
            }
        }
    }
}
