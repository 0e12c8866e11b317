pub(crate) mod continued;
pub(crate) mod corrections;
pub(crate) mod derivatives;
pub(crate) mod discrete_lagrangian;
pub(crate) mod discretisation;
pub(crate) mod increment;
pub(crate) mod kept;
pub(crate) mod mean;
pub(crate) mod past;

use crate::branch::tells_turn;
use crate::continued::sup;
use crate::dependent::{named_at, rows_left_out};
use crate::increment::Increment;
use crate::kept::Kept;
use crate::mean::Mean;
use crate::overshoot::brakes_only;
use crate::projection::{Projected, Projection};

use crate::{Discretisation, Mechanics, Newton, OneStep, Rules, StackUse, Stage, State, StepError, StepReport};
use lagrangian::{Alpha, Midpoint, NotAWeight, Rule, Trapezoid, from_fn, mapped};

/// How the equations of a step are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Form {
    /// In the basis of admissible velocities if the system gives one, else with multipliers.
    #[default]
    Best,
    /// With multipliers.
    Multipliers,
}

/// The discrete Lagrange-d'Alembert integrator as a one-step map on the distribution.
///
/// Given `q0` and an admissible `v0`, it finds the mean velocity `v` of the step, with `q1 = q0 + h v`, and the
/// multiplier from
///
/// ```text
/// L_v(q0, v0) + D1 L_d(q0, q1) + f_d^-(q0, q1) + A(q0)' lambda = 0,      w_d(q0, q1) = 0,
/// ```
///
/// then projects the momentum at the other end onto the constraint there:
///
/// ```text
/// L_v(q1, v1) = D2 L_d(q0, q1) + f_d^+(q0, q1) + A(q1)' mu,              A(q1) v1 + b(q1) = 0.
/// ```
///
/// Eliminating the velocities gives the equations of Cortes and Martinez (2001, Nonlinearity 14, 1365-1392), with the node's multiplier
/// `lambda + mu`; as a map on the distribution it needs no special first step, and is self-adjoint if the discrete Lagrangian and the
/// discrete constraint are. It keeps both constraints to round-off. It does not bound the energy in general. (The book, (3.1), (3.2) and
/// (2.3).)
///
/// A constraint on positions, [`System::holonomic`], takes the place of its discrete one: `g(q1) = 0` instead of `w_d = 0`. With such
/// constraints alone this is RATTLE, by the discrete Lagrangian at hand (Marsden and West 2001, section 3.5.4; Jay 1993). A constraint that
/// is not affine, [`System::nonlinear`], acts along `d phi / dv` at the two nodes and is met by the mean velocity at the rule's nodes, and
/// by the velocity at the end. If rows depend on one another and agree, only independent rows have multipliers; the step checks that the
/// remaining rows hold in the nodes.
///
/// [`System::holonomic`]: lagrangian::System::holonomic
/// [`System::nonlinear`]: lagrangian::System::nonlinear
///
/// The equations of a long step may have several solutions, or only solutions of another motion. A solution is accepted if it is connected
/// with the solution of a step of length zero: the determinant of the equations has the same sign there, the constraint turns by less than
/// a radian, and Newton's method contracts from its first step. Otherwise the solution is followed from length zero to the length of the
/// step. No step turns a constraint by half a turn: the turn could as well be one the other way round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dla<D = Rules> {
    /// The discrete Lagrangian `L_d` and the discrete constraint `w_d`.
    pub rules: D,
    /// The solver.
    pub newton: Newton,
    form: Form,
    pub(crate) kept: Kept,
}

impl Dla {
    /// The midpoint rule for both: order 2, self-adjoint.
    #[must_use]
    pub fn midpoint() -> Self {
        Self::new(Midpoint, Midpoint)
    }

    /// The trapezoidal rule for both: order 2, self-adjoint.
    #[must_use]
    pub fn trapezoid() -> Self {
        Self::new(Trapezoid, Trapezoid)
    }

    /// The rule with weight `alpha` for both: order 1 unless `alpha = 1/2`.
    ///
    /// # Errors
    /// [`NotAWeight`] unless `0 <= alpha <= 1`.
    pub fn alpha(alpha: f64) -> Result<Self, NotAWeight> {
        let rule = Alpha::new(alpha)?;
        Ok(Self::new(rule, rule))
    }

    /// The method of a quadrature rule for the discrete Lagrangian and one for the discrete constraint, in its best form.
    pub fn new(lagrangian: impl Into<Rule>, constraint: impl Into<Rule>) -> Self {
        Self::of(Rules::new(lagrangian, constraint))
    }
}

impl<D> Dla<D> {
    /// The method of a discrete Lagrangian and a discrete constraint, in its best form.
    pub fn of(rules: D) -> Self {
        Self { rules, newton: Newton::default(), form: Form::Best, kept: Kept::NONE }
    }

    /// The same method, solved in the given form.
    #[must_use]
    pub fn solved(mut self, form: Form) -> Self {
        self.form = form;
        self
    }
}

const USE: StackUse = StackUse { squares: 31, rows: 34 };

impl<D: Discretisation<N, M>, const N: usize, const M: usize> OneStep<N, M> for Dla<D> {
    fn step(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t0: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError> {
        if const { USE.exceeds::<N, M>() } {
            return Err(USE.refusal::<N, M>());
        }
        match self.continued_step(system, t0, h, state) {
            Some(report) => Ok(report),
            None => self.solved_step(system, t0, h, state),
        }
    }

    fn memory(&self) -> Vec<f64> {
        self.kept.save()
    }

    fn recall(&mut self, memory: &[f64], _state: &State<N>) {
        self.kept = Kept::load(memory);
    }
}

impl<D> Dla<D> {
    /// The step without memory. Compiled once for a shape, whatever is composed of it.
    #[inline(never)]
    fn solved_step<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        t0: f64,
        h: f64,
        state: &mut State<N>,
    ) -> Result<StepReport<M>, StepError>
    where
        D: Discretisation<N, M>,
    {
        let (q0, v0) = (*state.q(), *state.v());
        tells_turn(system, (t0, h), &q0, &v0)?;
        let in_basis = self.form != Form::Multipliers;
        let basis = |t, q: &[f64; N]| if in_basis { system.basis(t, q) } else { None };

        // The increment, through the mean velocity.
        let increment = Increment {
            rules: &self.rules,
            system,
            t0,
            h,
            state,
            q0,
            p0: system.momentum(t0, &q0, &v0),
            a0: system.reaction_rows(t0, &q0, &v0),
            basis: basis(t0, &q0),
        };
        let Mean { v, p1, lambda, iterations, some, block } =
            increment.solve(&self.newton, v0, predicted(state, h, expected(state, h)))?;

        // The momentum at the end, projected onto the constraint there.
        let d = mapped(&v, |v| h * v);
        let (t1, q1) = (t0 + h, state.ahead(&d));
        let Projected { v1, mu, mass } = Projection::new(system, t1, q1, p1, basis(t1, &q1))
            .of(some)
            .solve(&self.newton, v)
            .map_err(|source| named_at(system, t1, &q1, &v0, Stage::Projection, source))?;

        brakes_only(system, (t0, h), &q0, (&v, &v1))?;
        if let Some(rows) = some {
            rows_left_out(system, t1, &q1, &v1, rows)?;
        }
        state.stays_finite(&d, &v1)?;
        // From the middle of the step to its end.
        let acceleration = from_fn(|i| (v1[i] - v[i]) / (0.5 * h));
        state.advance_with_acceleration(h, &d, v1, acceleration);
        self.kept.begins(block.zip(mass), h, (state.q(), &v1));
        Ok(StepReport { impulses: [lambda, mu], ..StepReport::of(iterations) })
    }
}

/// The mean velocity of a step, extrapolated from the last steps.
#[inline(always)]
pub(crate) fn expected<const N: usize>(state: &State<N>, h: f64) -> Option<[f64; N]> {
    state.expected(h).map(|d| from_fn(|i| d[i] / h))
}

/// The predictor of the mean velocity: the extrapolated one, or else the one with the acceleration of the last step. `None` if neither is
/// known, or if it would change the velocity so much that Newton's method might converge to another solution.
#[inline(always)]
pub(crate) fn predicted<const N: usize>(state: &State<N>, h: f64, expected: Option<[f64; N]>) -> Option<[f64; N]> {
    /// The largest change of the velocity by a predictor, relative to the velocity (`docs/methods/discrete-lagrange-dalembert.md`).
    const MOST: f64 = 0.125;
    let v0 = state.v();
    let near = |v: &[f64; N]| sup(&from_fn::<_, N, _>(|i| v[i] - v0[i])) <= MOST * sup(v0);
    if let Some(v) = expected
        && near(&v)
    {
        return Some(v);
    }
    let acceleration = state.acceleration()?;
    let v = from_fn(|i| v0[i] + 0.5 * h * acceleration[i]);
    near(&v).then_some(v)
}
