use crate::branch::tells_turn;
use crate::convergence::most_roundings;
use crate::overshoot::brakes_only;
use crate::positions::{affine_only, velocities_only};
use crate::{
    Discretisation, Equations, Mechanics, Newton, NewtonError, OneStep, RoundedStep, Rules, StackUse, Stage, State,
    StepError, StepReport,
};
use lagrangian::linear::{Lu, Singular};
use lagrangian::{Rounded, Saddle, Trapezoid, from_fn, mapped};

/// The geometric nonholonomic integrator: **a counter-example**, not a method to use.
///
/// At every node the momentum is reflected at the constraint in the kinetic metric,
///
/// ```text
/// p+ = (P* - Q*) p-,     p- = D2 L_d(q_{k-1}, q_k),     -D1 L_d(q_k, q_{k+1}) = p+,
/// ```
///
/// with `Q* p = A' (A M^-1 A')^-1 A M^-1 p` and `P* = 1 - Q*` (Ferraro, Iglesias and Martin de Diego 2008, Nonlinearity 21,
/// 1911-1928; with the trapezoidal rule the nonholonomic RATTLE). It is of order 2, holds the constraint in the mean of
/// two steps, and keeps the kinetic energy of free motions between nodes. But it is no map on the distribution: the
/// momentum across the constraint is carried from step to step as a variable of its own, and about the *stable* straight
/// motion of the sleigh that variable grows as `exp(asinh(kappa h) t / h)`, until the sleigh reverses by itself (the book,
/// (3.9)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gni<const N: usize, D = Rules> {
    rules: D,
    newton: Newton,
    memory: Option<GniMemory<N>>,
}

/// The node that the last step led to, and the momentum it arrived with.
#[derive(Debug, Clone, Copy, PartialEq)]
struct GniMemory<const N: usize> {
    node: State<N>,
    arriving: [f64; N],
}

impl<const N: usize> Default for Gni<N> {
    fn default() -> Self {
        Self::of(Rules::new(Trapezoid, Trapezoid))
    }
}

impl<const N: usize, D> Gni<N, D> {
    /// The integrator of a discrete Lagrangian, with which comes a discrete constraint that it does not use.
    pub fn of(rules: D) -> Self {
        Self { rules, newton: Newton::default(), memory: None }
    }
}

/// `Q* p`, the part of a momentum across the constraint, and the admissible velocity of the rest.
fn across<const N: usize, const M: usize>(
    system: &dyn Mechanics<N, M>,
    t: f64,
    state: (&[f64; N], &[f64; N]),
    p: &[f64; N],
) -> Result<([f64; N], [f64; N]), Singular> {
    let (_, mass) = system.mass_matrix(t, state.0, state.1);
    let (a, b) = system.constraint(t, state.0);
    let saddle = Saddle { block: mass, transposed: a, rows: a, right: *p, level: mapped(&b, |b| -b) };
    let (v, mu) = saddle.solve(system.basis(t, state.0).as_ref())?;
    Ok((from_fn(|i| (0..M).map(|k| a[k][i] * mu[k]).sum()), v))
}

const USE: StackUse = StackUse { squares: 14, rows: 20 };

impl<D: Discretisation<N, M>, const N: usize, const M: usize> OneStep<N, M> for Gni<N, D> {
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>());
        }
        affine_only(system, t, state)?;
        let reason = "the reflection of momenta lets the positions drift, and this system constrains them";
        velocities_only(system, t, state, reason)?;
        let singular = |stage| move |source| StepError::Newton { stage, source: NewtonError::singular(source) };
        let (q0, v0) = (*state.q(), *state.v());
        tells_turn(system, (t, h), &q0, &v0)?;
        // Only a node that it led to itself has a momentum to reflect; another start begins without one across.
        let departing = match self.memory {
            Some(memory) if memory.node == *state => {
                let p = memory.arriving;
                let (q_p, _) = across(system, t, (&q0, &v0), &p).map_err(singular(Stage::Projection))?;
                from_fn(|i| p[i] - 2.0 * q_p[i])
            }
            _ => system.momentum(t, &q0, &v0),
        };
        let mut equations = GniDeparture { rules: &self.rules, system, t, h, q0, departing };
        let mut v = v0;
        let iterations = self
            .newton
            .solve(&mut equations, &mut v)
            .map_err(|source| StepError::Newton { stage: Stage::Increment, source })?;

        // At once with the step, since a force that is too large for a number may have an impulse that is not.
        let (momenta, _) = self.rules.linearised(system, (t, h), &q0, &v);
        let [_, mut arriving] = momenta.slopes;
        if let Some([_, plus]) = momenta.forces {
            arriving = from_fn(|i| arriving[i] + plus[i]);
        }
        let increment = mapped(&v, |v| h * v);
        let q1 = state.ahead(&increment);
        let (_, v1) = across(system, t + h, (&q1, &v), &arriving).map_err(singular(Stage::Projection))?;
        state.stays_finite(&increment, &v1)?;
        brakes_only(system, (t, h), &q0, (&v, &v1))?;
        state.advance(&increment, v1, None);
        self.memory = Some(GniMemory { node: *state, arriving });
        Ok(StepReport::of(iterations))
    }

    fn memory(&self) -> Vec<f64> {
        self.memory.map_or_else(Vec::new, |memory| memory.arriving.to_vec())
    }

    fn recall(&mut self, memory: &[f64], state: &State<N>) {
        self.memory = <[f64; N]>::try_from(memory).ok().map(|arriving| GniMemory { node: *state, arriving });
    }
}

/// The equations `p+ + D1 L_d(q0, q0 + h v) + f_d^- = 0` for the mean velocity of a step; nothing constrains it.
struct GniDeparture<'a, D, const N: usize, const M: usize> {
    rules: &'a D,
    system: &'a dyn Mechanics<N, M>,
    t: f64,
    h: f64,
    q0: [f64; N],
    departing: [f64; N],
}

impl<D: Discretisation<N, M>, const N: usize, const M: usize> Equations<N> for GniDeparture<'_, D, N, M> {
    #[cold]
    #[inline(never)]
    fn roundings(&self, v: &[f64; N]) -> Option<f64> {
        let Self { rules, system, t, h, q0, departing } = *self;
        let RoundedStep { d1, minus, .. } = rules.rounded(system, (t, h), &q0, &mapped(v, Rounded::once));
        Some(most_roundings((0..N).map(|i| {
            let conservative = d1[i] + departing[i];
            minus.map_or(conservative, |minus| conservative + minus[i])
        })))
    }

    fn correction(&mut self, v: &[f64; N]) -> Result<[f64; N], Singular> {
        let Self { rules, system, t, h, q0, departing } = *self;
        let (momenta, block) = rules.linearised(system, (t, h), &q0, v);
        let [d1, _] = momenta.slopes;
        let mut residual: [f64; N] = from_fn(|i| departing[i] + d1[i]);
        if let Some([minus, _]) = momenta.forces {
            for i in 0..N {
                residual[i] += minus[i];
            }
        }
        Ok(Lu::new(block)?.solve(mapped(&residual, |r| -r)))
    }
}
