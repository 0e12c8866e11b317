use super::dense::Dense;
use super::point::{LinearisedStage, StagePoint, Terms};
use super::tables::LobattoTables;
use crate::branch;
use crate::convergence::{most_roundings, rounding_of_place};
use crate::newton::BlockEquations;
use crate::{Mechanics, State, StepError};
use lagrangian::linear::{Singular, larger};
use lagrangian::{Rounded, Saddle, from_fn, mapped};

/// The equations for the velocities of all stages of a step, with the impulses of the constraint at all but the last.
pub(super) struct LobattoStages<'a, const N: usize, const M: usize, const S: usize> {
    pub(super) tables: &'a LobattoTables<S>,
    pub(super) system: &'a dyn Mechanics<N, M>,
    pub(super) t0: f64,
    pub(super) h: f64,
    pub(super) start: &'a State<N>,
    pub(super) p0: [f64; N],
    /// `h Lambda` of every stage; zero for the last stage.
    pub(super) impulses: [[f64; M]; S],
    /// The impulses before the last correction.
    pub(super) before: [[f64; M]; S],
}

impl<const N: usize, const M: usize, const S: usize> Clone for LobattoStages<'_, N, M, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<const N: usize, const M: usize, const S: usize> Copy for LobattoStages<'_, N, M, S> {}

impl<const N: usize, const M: usize, const S: usize> LobattoStages<'_, N, M, S> {
    /// The increment `h sum_j factors[j] v[j]`, `share` the sum of the factors.
    ///
    /// Summed about the velocity at the start, so that the rounding of the factors multiplies differences only.
    #[inline]
    pub(super) fn increment(&self, factors: &[f64; S], share: f64, v: &[[f64; N]; S]) -> [f64; N] {
        let v0 = self.start.v();
        from_fn(|i| {
            let excess: f64 = (0..S).map(|j| factors[j] * (v[j][i] - v0[i])).sum();
            self.h * (share * v0[i] + excess)
        })
    }

    /// The angle by which the step turns the constraint (rad).
    #[inline]
    pub(super) fn turn(&self, v: &[[f64; N]; S]) -> f64 {
        let increment = self.increment(&self.tables.b, 1.0, v);
        branch::turn_of(self.system, (self.t0, self.h), self.start.q(), &mapped(&increment, |d| d / self.h))
    }

    /// The points of the stages.
    #[inline]
    pub(super) fn points(&self, v: &[[f64; N]; S]) -> [StagePoint<N, M>; S] {
        let LobattoTables { c, a, .. } = self.tables;
        from_fn(|j| StagePoint {
            t: self.t0 + c[j] * self.h,
            q: self.start.ahead(&self.increment(&a[j], c[j], v)),
            v: v[j],
            impulse: self.impulses[j],
        })
    }

    /// The round-off of the velocities that the round-off of forces, and of constraints on positions, causes over the step.
    #[cold]
    #[inline(never)]
    pub(super) fn velocity_rounding(&self) -> [f64; N] {
        let Self { system, t0, h, start, .. } = *self;
        let (q, v) = (start.q(), start.v());
        let rounding = system.motion_rounding(t0, q, v);
        let mut velocity = rounding.map_or([0.0; N], |rounding| mapped(&rounding.acceleration, |a| (h * a).abs()));
        if let Some(positions) = system.positions_rounded(Rounded::exact(t0), &mapped(q, Rounded::once)) {
            let ((_, block), rows) = (system.mass_matrix(t0, q, v), system.reaction_rows(t0, q, v));
            for k in 0..M {
                let noise = positions[k].map_or(0.0, |g| 0.5 * f64::EPSILON * g.size / h);
                let level = from_fn(|l| if l == k { noise } else { 0.0 });
                let saddle = Saddle { block, transposed: rows, rows, right: [0.0; N], level };
                if let Ok((moved, _)) = saddle.solve(system.basis(t0, q).as_ref()) {
                    velocity = from_fn(|i| velocity[i] + moved[i].abs());
                }
            }
        }
        velocity
    }

    /// The largest residual of the equations, in units of the round-off of its terms, with these velocities and the impulses. Velocities
    /// meet the constraints no better than the round-off of the forces allows; at the nodes the projection removes that.
    #[cold]
    #[inline(never)]
    pub(super) fn missed(&self, v: &[[f64; N]; S]) -> f64 {
        let LobattoTables { a, a_hat, blind, .. } = self.tables;
        let h = self.h;
        let terms: [Terms<N, M>; S] = from_fn(|j| {
            let way = |i: usize| (0..S).map(|k| (h * a[j][k] * v[k][i]).abs()).sum::<f64>();
            self.points(v)[j].terms(self.system, h, &from_fn(way))
        });
        let momenta = (0..S).flat_map(|i| {
            let terms = &terms;
            (0..N).map(move |x| {
                let gained = (0..S - 1).fold(Rounded::exact(self.p0[x]), |sum, j| sum + terms[j].w[x] * a_hat[i][j]);
                gained - terms[i].p[x]
            })
        });
        let unknown = self.velocity_rounding();
        let rows = (1..S).flat_map(|i| {
            let (terms, unknown) = (&terms, &unknown);
            (0..M).map(move |k| {
                let missed = match terms[i].positions[k] {
                    Some(g) => g / h,
                    None => terms[0].g[k] * blind[i] - terms[i].g[k],
                };
                let moved: f64 = (0..N).map(|x| terms[i].a[k][x].abs() * unknown[x]).sum();
                Rounded { size: missed.size + 2.0 * moved / f64::EPSILON, ..missed }
            })
        });
        most_roundings(momenta.chain(rows))
    }

    /// The error that refuses the velocities `v` of the stages, which are not found from the velocity `v0`.
    #[cold]
    #[inline(never)]
    pub(super) fn unfollowed(&self, v: &[[f64; N]; S], v0: [f64; N]) -> StepError {
        let derivatives = |v: &[[f64; N]; S]| {
            let mut all = Vec::new();
            for at in self.points(v).iter().map(|point| point.linearised(self.system, self.h)) {
                for square in [&at.p_q, &at.p_v, &at.w_q, &at.w_v] {
                    all.extend_from_slice(square.as_flattened());
                }
                all.extend_from_slice(at.a.as_flattened());
            }
            all
        };
        branch::unfollowed([&derivatives(v), &derivatives(&[v0; S])])
    }

    /// The units of the multipliers: about the inverse diagonal of `A M^-1 A'`. In them the equations of light and of heavy bodies are
    /// equally far from singular.
    #[inline]
    fn units(at: &[LinearisedStage<N, M>; S]) -> [f64; M] {
        let start = &at[0];
        from_fn(|k| {
            let mobility = |x: usize| match start.p_v[x][x] {
                0.0 => 0.0,
                mass => start.a[k][x] * start.a[k][x] / mass,
            };
            match (0..N).fold(0.0, |most, x| larger(most, mobility(x))) {
                0.0 => 1.0,
                largest => largest.recip(),
            }
        })
    }

    /// The linear equations of Newton's method, the multipliers in these units.
    #[inline]
    fn equations(
        &self,
        points: &[StagePoint<N, M>; S],
        at: &[LinearisedStage<N, M>; S],
        units: &[f64; M],
        dense: &mut Dense<N, M, S>,
    ) {
        let LobattoTables { a, a_hat, blind, .. } = self.tables;
        let h = self.h;
        // p_i - p0 - sum_j a_hat_ij w_j = 0
        for i in 0..S {
            for x in 0..N {
                let gained: f64 = (0..S - 1).map(|j| a_hat[i][j] * at[j].w[x]).sum();
                let equation = Dense::<N, M, S>::velocity(i, x);
                dense.right()[equation] = self.p0[x] - at[i].p[x] + gained;
                let row = dense.row(equation);
                for k in 0..S {
                    for y in 0..N {
                        // The first stage is at the start whatever the velocities are.
                        let moved: f64 = (1..S - 1).map(|j| a_hat[i][j] * a[j][k] * at[j].w_q[x][y]).sum();
                        let mut sum = h * (a[i][k] * at[i].p_q[x][y] - moved) - a_hat[i][k] * at[k].w_v[x][y];
                        if i == k {
                            sum += at[i].p_v[x][y];
                        }
                        row[Dense::<N, M, S>::velocity(k, y)] = sum;
                    }
                }
                for j in 0..S - 1 {
                    for k in 0..M {
                        row[Dense::<N, M, S>::multiplier(j, k)] = -a_hat[i][j] * at[j].a[k][x] * units[k];
                    }
                }
            }
        }
        // g_i - blind_i g_0 = 0, or of positions g_i = 0
        for i in 1..S {
            let positions = self.system.position_misses(points[i].t, &points[i].q);
            for k in 0..M {
                let equation = Dense::<N, M, S>::multiplier(i - 1, k);
                if let Some(g) = positions.and_then(|g| g[k]) {
                    dense.right()[equation] = -g.re / h;
                    let row = dense.row(equation);
                    for j in 0..S {
                        for y in 0..N {
                            row[Dense::<N, M, S>::velocity(j, y)] = a[i][j] * g.eps[y];
                        }
                    }
                    continue;
                }
                dense.right()[equation] = blind[i] * at[0].g[k] - at[i].g[k];
                let row = dense.row(equation);
                for j in 0..S {
                    for y in 0..N {
                        row[Dense::<N, M, S>::velocity(j, y)] = h * a[i][j] * at[i].g_q[k][y];
                    }
                }
                for y in 0..N {
                    row[Dense::<N, M, S>::velocity(i, y)] += at[i].a[k][y];
                    row[Dense::<N, M, S>::velocity(0, y)] -= blind[i] * at[0].a[k][y];
                }
            }
        }
    }
}

impl<const N: usize, const M: usize, const S: usize> BlockEquations<N, S> for LobattoStages<'_, N, M, S> {
    #[inline(always)]
    fn near(&self) -> f64 {
        rounding_of_place(self.start.q(), self.h)
    }

    fn roundings(&self, v: &[[f64; N]; S]) -> Option<f64> {
        Some(Self { impulses: self.before, ..*self }.missed(v))
    }

    /// Not inlined: it is long, and called from each of the iterations that a step may make.
    #[inline(never)]
    fn correction(&mut self, v: &[[f64; N]; S]) -> Result<[[f64; N]; S], Singular> {
        let points = self.points(v);
        let at = mapped(&points, |point| point.linearised(self.system, self.h));
        // Filled in place: a second matrix would be on the stack beside it.
        let mut dense = Dense::zero();
        let units = Self::units(&at);
        self.equations(&points, &at, &units, &mut dense);
        dense.solve()?;
        let solution = dense.right();
        self.before = self.impulses;
        for j in 0..S - 1 {
            for k in 0..M {
                self.impulses[j][k] += solution[Dense::<N, M, S>::multiplier(j, k)] * units[k];
            }
        }
        Ok(from_fn(|j| from_fn(|i| solution[Dense::<N, M, S>::velocity(j, i)])))
    }
}
