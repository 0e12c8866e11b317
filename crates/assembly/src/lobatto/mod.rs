//! Methods of higher order for assemblies, with all stages in one system of equations.

pub(crate) mod element;
mod elements;
mod stages;

pub use element::{StageElement, StageTerms};

use crate::assembly::PlacedElement;
use crate::contributions::{at_state, gathered};
use crate::element::ElementBlocks;
use crate::pattern::PatternPart;
use crate::settling::AssemblySettling;
use crate::sparse::Sparse;
use crate::terms;
use crate::{Assembly, AssemblyError, AssemblyMethod, AssemblyReport, AssemblyState, Solver};
use dla::Stage;
use dla::convergence::rounding_of_place;
use lagrangian::linear::{larger, largest};
use stages::{AssemblyStages, LobattoRule, StageRoom, increment};

/// The variational partitioned Runge-Kutta method of the Lobatto pair IIIA and IIIB for an assembly: order `2 S - 2` with `S`
/// stages, self-adjoint.
///
/// The equations are those of the static [`Lobatto`](dla::Lobatto), summed over the elements. The unknowns are the velocities of all
/// stages and the impulses of all but the last, `S N + (S - 1) M`, in a matrix that has `S x S` numbers for each of the assembly's,
/// found once. Joints hold at every stage, `g(Q_i) = 0`; the velocity is projected at the end.
///
/// A step that turns a constraint by more than a radian, or whose iteration does not contract from its start, is refused: the
/// static method continues the solution from a step of length zero there. (The book, (4.3) to (4.5).)
pub struct SparseLobatto {
    rule: LobattoRule,
    stages: Sparse,
    end: Sparse,
    settling: [AssemblySettling; 2],
    terms: Vec<StageTerms>,
    room: StageRoom,
    p: Vec<f64>,
    /// The velocities of the stages of one coordinate after the other.
    v: Vec<f64>,
    impulses: Vec<f64>,
    multipliers: Vec<f64>,
    q1: Vec<f64>,
    v1: Vec<f64>,
    mean: Vec<f64>,
    each: [Vec<f64>; 4],
}

/// What turns by less than this in a step (rad) is near its start.
const NEAR: f64 = 1.0;

impl std::fmt::Debug for SparseLobatto {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Lobatto").field("stages", &self.rule.stages).finish_non_exhaustive()
    }
}

impl SparseLobatto {
    /// The method with 3, 4 or 5 stages for that assembly, whose pattern it finds and whose memory it keeps.
    ///
    /// # Errors
    /// [`AssemblyError::Unsupported`] for other numbers; [`AssemblyError::Factorisation`] where the memory does not suffice.
    pub fn new(assembly: &Assembly, solver: Solver, stages: usize) -> Result<Self, AssemblyError> {
        let rule = match stages {
            3 => LobattoRule::of::<3>(),
            4 => LobattoRule::of::<4>(),
            5 => LobattoRule::of::<5>(),
            _ => return Err(AssemblyError::Unsupported { reason: "lobatto of assemblies has 3, 4 or 5 stages" }),
        };
        let (n, m) = (assembly.coordinates(), assembly.rows());
        // Local unknowns are stage by stage, global ones coordinate by coordinate, so that neighbours stay near.
        let part = |s: usize, r: usize| {
            move |placed: &PlacedElement| PatternPart {
                at: (0..s).flat_map(|stage| placed.at.iter().map(move |i| i * s + stage)).collect(),
                row: r * placed.row,
                rows: r * placed.rows,
                acts: placed.element.acts(),
            }
        };
        let parts = |s: usize, r: usize| assembly.placed().iter().map(part(s, r)).collect::<Vec<_>>();
        let widest = assembly.placed().iter().map(|placed| placed.at.len()).max().unwrap_or(0);
        Ok(Self {
            stages: Sparse::new(stages * n, (stages - 1) * m, parts(stages, stages - 1), solver)?,
            end: Sparse::new(n, m, parts(1, 1), solver)?,
            settling: [AssemblySettling::new(stages * n, (stages - 1) * m), AssemblySettling::new(n, m)],
            terms: vec![StageTerms::new(); stages],
            room: StageRoom::of(assembly, stages),
            p: vec![0.0; n],
            v: vec![0.0; stages * n],
            impulses: vec![0.0; (stages - 1) * m],
            multipliers: vec![0.0; m],
            q1: vec![0.0; n],
            v1: vec![0.0; n],
            mean: vec![0.0; n],
            each: [widest, widest, widest * widest, widest * widest].map(|room| vec![0.0; room]),
            rule,
        })
    }

    /// The momenta at the start, in `p`.
    fn begin(&mut self, assembly: &Assembly, t0: f64, state: &AssemblyState) -> Result<(), AssemblyError> {
        self.p.fill(0.0);
        let [momentum, level, block, rows] = &mut self.each;
        for placed in assembly.placed() {
            let (n, m) = (placed.at.len(), placed.rows);
            let affine = at_state(placed, state, |element, q, v| {
                let out = ElementBlocks {
                    momentum: &mut momentum[..n],
                    level: &mut level[..m],
                    block: &mut block[..0],
                    rows: &mut rows[..m * n],
                    derivatives: false,
                };
                element.beginning(t0, q, v, out);
                element.is_affine(t0, q, v)
            });
            if !affine {
                let reason = "the method is for constraints that are affine in the velocities, and one of these is not";
                return Err(AssemblyError::Unsupported { reason });
            }
            if placed.element.acts() {
                placed.at.iter().zip(&*momentum).for_each(|(i, p)| self.p[*i] += p);
            }
        }
        Ok(())
    }

    /// The velocities of the stages, from those of uniform acceleration.
    fn solve(&mut self, assembly: &Assembly, step: (f64, f64), state: &AssemblyState) -> Result<u32, AssemblyError> {
        /// More acceleration than this leads too far from the start.
        const MOST: f64 = 0.125;
        let Self { rule, stages, settling, terms, room, p, v, impulses, .. } = self;
        let gained = |i: usize| step.1 * state.acceleration(i).unwrap_or(0.0);
        let size = (0..state.len()).fold(0.0, |most, i| larger(most, state.v(i)));
        let most = (0..state.len()).fold(0.0, |most, i| larger(most, gained(i)));
        let near = most <= MOST * size;
        for (i, v) in v.chunks_exact_mut(rule.stages).enumerate() {
            for (v, c) in v.iter_mut().zip(&rule.c) {
                *v = state.v(i) + if near { c * gained(i) } else { 0.0 };
            }
        }
        impulses.fill(0.0);
        let mut equations = AssemblyStages { assembly, rule, step, state, p0: p, terms, room };
        let (s, unknowns) = (rule.stages, rule.stages * assembly.coordinates());
        let sizes = |sizes: &mut [f64]| {
            let (q, v) = (|i: usize| state.q(i), |i: usize| state.v(i));
            terms::for_each(assembly, step, q, v, |_, placed, momentum, level| {
                for (i, size) in placed.at.iter().zip(momentum) {
                    sizes[i * s..][..s].iter_mut().for_each(|to| *to += size);
                }
                let rows = &mut sizes[unknowns + (s - 1) * placed.row..][..(s - 1) * placed.rows];
                for stage in rows.chunks_exact_mut(placed.rows.max(1)) {
                    stage.iter_mut().zip(level).for_each(|(to, size)| *to += size);
                }
            });
        };
        let made = stages.newton(
            (&mut settling[0], Stage::Collocation),
            v,
            impulses,
            sizes,
            |system, v, impulses, fresh| {
                equations.evaluate(system, v, impulses, fresh);
                Ok(())
            },
        )?;
        // The momenta that all stages give.
        let mut gains = AssemblyStages { assembly, rule, step, state, p0: &[], terms, room };
        for placed in assembly.placed() {
            gains.ask(placed, v, impulses);
            for (x, i) in placed.at.iter().enumerate() {
                p[*i] += gains.terms.iter().zip(&rule.b).map(|(terms, b)| b * terms.w[x]).sum::<f64>();
            }
        }
        Ok(made)
    }

    /// The velocity at the end, in `v1`: `L_v(q1, v1) = p1 + A(q1)' mu`, `A(q1) v1 + b = 0`.
    fn project(&mut self, assembly: &Assembly, (t1, h): (f64, f64)) -> Result<u32, AssemblyError> {
        let stages = self.rule.stages;
        let Self { end, settling, p, v, q1, v1, multipliers, each: [momentum, level, block, rows], .. } = self;
        multipliers.fill(0.0);
        let (q1, start) = (&*q1, |i: usize| v[i * stages + stages - 1]);
        let sizes = |sizes: &mut [f64]| terms::add(assembly, (t1, h), |i| q1[i], start, sizes);
        end.newton((&mut settling[1], Stage::Projection), v1, multipliers, sizes, |system, v1, multipliers, fresh| {
            system.linear.right[..p.len()].copy_from_slice(p);
            for (k, placed) in assembly.placed().iter().enumerate() {
                let (n, m, acts) = (placed.at.len(), placed.rows, placed.element.acts());
                let out = ElementBlocks {
                    momentum: &mut momentum[..n],
                    level: &mut level[..m],
                    block: &mut block[..if acts { n * n } else { 0 }],
                    rows: &mut rows[..m * n],
                    derivatives: true,
                };
                gathered(
                    placed,
                    |i| q1[i],
                    |q| gathered(placed, |i| v1[i], |v| placed.element.velocity(t1, q, v, out)),
                );
                if !acts {
                    momentum[..n].fill(0.0);
                }
                momentum[..n].iter_mut().for_each(|p| *p = -*p);
                for (row, mu) in rows[..m * n].chunks_exact(n).zip(&multipliers[placed.row..]) {
                    momentum.iter_mut().zip(row).for_each(|(p, a)| *p += a * mu);
                }
                system.add_right(k, &momentum[..n]);
                system.write_levels(k, &level[..m]);
                if fresh {
                    if acts {
                        system.add_block(k, &block[..n * n]);
                    }
                    block.iter_mut().zip(&rows[..m * n]).for_each(|(acting, a)| *acting = -a);
                    system.write_rows(k, &block[..m * n], &rows[..m * n]);
                }
            }
            Ok(())
        })
    }

    /// By how much the constraint turns that turns most (rad).
    fn turn(&self, assembly: &Assembly, step: (f64, f64), state: &AssemblyState) -> f64 {
        let turn = |placed: &PlacedElement| {
            gathered(
                placed,
                |i| state.q(i),
                |q| gathered(placed, |i| self.mean[i], |v| placed.element.turn(step, q, v)),
            )
        };
        assembly.placed().iter().map(turn).fold(0.0, larger)
    }
}

impl AssemblyMethod for SparseLobatto {
    fn step(
        &mut self,
        assembly: &Assembly,
        t0: f64,
        h: f64,
        state: &mut AssemblyState,
    ) -> Result<AssemblyReport, AssemblyError> {
        self.begin(assembly, t0, state)?;
        for (i, q1) in self.q1.iter_mut().enumerate() {
            *q1 = state.q(i);
        }
        self.settling[0].near = rounding_of_place(&self.q1, h);
        let iterations = self.solve(assembly, (t0, h), state)?;
        let s = self.rule.stages;
        for (i, v) in self.v.chunks_exact(s).enumerate() {
            let moved = increment(h, &self.rule.b, 1.0, state.v(i), v);
            (self.mean[i], self.q1[i], self.v1[i]) = (moved / h, state.ahead(i, moved), v[s - 1]);
        }
        let turn = self.turn(assembly, (t0, h), state);
        if turn > NEAR || !self.settling[0].certain {
            return Err(AssemblyError::Branch { turn });
        }
        self.project(assembly, (t0 + h, h))?;
        if !largest(&self.q1).is_finite() || !largest(&self.v1).is_finite() {
            return Err(AssemblyError::NotFinite);
        }
        for (i, v) in self.v.chunks_exact(s).enumerate() {
            let moved = increment(h, &self.rule.b, 1.0, state.v(i), v);
            // The slope of the stages at the end.
            let acceleration = (v[s - 1] - v[s - 2]) / (h * (self.rule.c[s - 1] - self.rule.c[s - 2]));
            state.advance(h, i, moved, self.v1[i], acceleration);
        }
        Ok(AssemblyReport::of(iterations))
    }
}
