use crate::shortest;
use crate::{AdmissibleBasis, Called, Constraint, Dual, HyperDual, Parametrised, Scalar, from_fn, mapped, seed};

/// A number with its derivatives in eight directions.
pub type Seeded = Dual<f64, 8>;

/// A number of [`Gradients`] with its derivative along one more direction: a motion or a basis vector.
pub type Along = Dual<Seeded, 1>;

/// What the equations of a step need of a system, with derivatives in eight directions.
///
/// The residual of a step's equations on [`Seeded`] numbers gives their Jacobian, by which the implicit function theorem
/// differentiates the step. The trait is for one scalar and so can be an object: the equations of a method are compiled once,
/// and not for every system.
pub trait Gradients<const N: usize, const M: usize> {
    /// The Lagrangian (J).
    fn lagrangian(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Seeded;

    /// The momenta `L_v`.
    fn momentum(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N];

    /// `d/dt L_v` along `(t', q', v') = (1, v, a)`.
    fn momentum_rate(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N], a: &[Seeded; N]) -> [Seeded; N];

    /// `L_q`.
    fn slope(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N];

    /// The generalised forces.
    fn force(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Option<[Seeded; N]>;

    /// `A` and `b` of the constraint, with their derivatives along the direction of `t` and `q`.
    fn constraint_along(&self, t: Along, q: &[Along; N]) -> Constraint<Along, N, M>;

    /// The basis of admissible velocities, with its derivative along the direction of `t` and `q`.
    fn basis_along(&self, t: Along, q: &[Along; N]) -> Option<AdmissibleBasis<Along, N, M>>;

    /// The functions of constraints on positions.
    fn holonomic(&self, t: Seeded, q: &[Seeded; N]) -> Option<[Option<Seeded>; M]>;

    /// The functions of constraints that are not affine in the velocities, with their derivatives in these.
    fn nonlinear(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Option<[Option<Dual<Seeded, N>>; M]>;
}

/// What follows of the rest; compiled once, and not for every system.
impl<const N: usize, const M: usize> dyn Gradients<N, M> + '_ {
    /// `L_q + F`: what changes the momenta besides the constraint.
    #[must_use]
    pub fn push(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N] {
        let slope = self.slope(t, q, v);
        match self.force(t, q, v) {
            Some(force) => from_fn(|i| slope[i] + force[i]),
            None => slope,
        }
    }

    /// `A` and `b` of the constraint.
    #[must_use]
    pub fn constraint(&self, t: Seeded, q: &[Seeded; N]) -> Constraint<Seeded, N, M> {
        let (a, b) = self.constraint_along(Dual::fixed(t), &mapped(q, Dual::fixed));
        (mapped(&a, |row| mapped(&row, |x| x.re)), mapped(&b, |x| x.re))
    }

    /// `A v + b`, or `phi` of a constraint that is not affine.
    #[must_use]
    pub fn slip(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; M] {
        let (a, b) = self.constraint(t, q);
        let slip = from_fn(|k| (0..N).fold(b[k], |sum, i| sum + a[k][i] * v[i]));
        match self.nonlinear(t, q, v) {
            Some(phi) => from_fn(|k| phi[k].map_or(slip[k], |phi| phi.re)),
            None => slip,
        }
    }

    /// The rows along which the constraints react: `A` for affine constraints, `d phi / dv` for the others.
    #[must_use]
    pub fn reaction_rows(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [[Seeded; N]; M] {
        let (a, _) = self.constraint(t, q);
        match self.nonlinear(t, q, v) {
            Some(phi) => from_fn(|k| phi[k].map_or(a[k], |phi| phi.eps)),
            None => a,
        }
    }

    /// What is left of the equations of motion `d/dt L_v - L_q - F = A' lambda`, `d/dt (A v + b) = 0` at an acceleration `a`.
    #[must_use]
    pub fn motion(
        &self,
        t: Seeded,
        q: &[Seeded; N],
        v: &[Seeded; N],
        a: &[Seeded; N],
        lambda: &[Seeded; M],
    ) -> ([Seeded; N], [Seeded; M]) {
        let (rate, push) = (self.momentum_rate(t, q, v, a), self.push(t, q, v));
        let along_t = Dual { re: t, eps: [Seeded::constant(1.0)] };
        let (rows, b) = self.constraint_along(along_t, &from_fn(|i| Dual { re: q[i], eps: [v[i]] }));
        let forces = from_fn(|i| (0..M).fold(rate[i] - push[i], |sum, k| sum - rows[k][i].re * lambda[k]));
        let slips =
            from_fn(|k| (0..N).fold(b[k].eps[0], |sum, i| sum + rows[k][i].eps[0] * v[i] + rows[k][i].re * a[i]));
        (forces, slips)
    }

    /// The basis of admissible velocities.
    #[must_use]
    pub fn basis(&self, t: Seeded, q: &[Seeded; N]) -> Option<AdmissibleBasis<Seeded, N, M>> {
        let basis = self.basis_along(Dual::fixed(t), &mapped(q, Dual::fixed))?;
        Some(AdmissibleBasis::from_fn(|a| mapped(&basis.vectors()[a], |w| w.re)))
    }

    /// The velocity `W xi + v_b` of quasi-velocities, as [`velocity_of`](crate::velocity_of), with its derivative along the
    /// direction of `t` and `q`.
    #[must_use]
    pub fn velocity_along(&self, t: Along, q: &[Along; N], xi: &[Seeded; N]) -> Option<[Along; N]> {
        let v = self.basis_along(t, q)?.combine(&mapped(xi, Dual::fixed));
        let (a, b) = self.constraint_along(t, q);
        Some(match shortest(&a, &b) {
            Some(shift) => from_fn(|i| v[i] + shift[i]),
            None => v,
        })
    }

    /// The velocity `v = W xi + v_b` and the acceleration `v' = W xi' + (W' xi + v_b')` of quasi-velocities that change at
    /// the rate `xi'`.
    #[must_use]
    pub fn turned(
        &self,
        t: Seeded,
        q: &[Seeded; N],
        xi: &[Seeded; N],
        rate: &[Seeded; N],
    ) -> Option<([Seeded; N], [Seeded; N])> {
        let v = self.velocity(t, q, xi)?;
        let along_t = Dual { re: t, eps: [Seeded::constant(1.0)] };
        let carried = self.velocity_along(along_t, &from_fn(|i| Dual { re: q[i], eps: [v[i]] }), xi)?;
        let turned = self.basis(t, q)?.combine(rate);
        Some((v, from_fn(|i| turned[i] + carried[i].eps[0])))
    }

    /// The velocity `W xi + v_b` of quasi-velocities.
    #[must_use]
    pub fn velocity(&self, t: Seeded, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<[Seeded; N]> {
        Some(self.velocity_along(Dual::fixed(t), &mapped(q, Dual::fixed), xi)?.map(|v| v.re))
    }
}

/// The member of a family at parameters that may carry derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeededMember<F, const P: usize> {
    /// The family.
    pub family: F,
    /// The parameters.
    pub parameters: [Seeded; P],
}

/// All numbers are [`Called`]: a call costs little beside such large numbers, and a system is compiled small.
impl<F: Parametrised<N, M, P>, const N: usize, const M: usize, const P: usize> Gradients<N, M> for SeededMember<F, P> {
    fn lagrangian(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Seeded {
        self.lagrangian_along(fixed(t), &mapped(q, fixed), &mapped(v, fixed)).re
    }

    fn momentum(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N] {
        self.lagrangian_along(fixed(t), &mapped(q, fixed), &variables(v, &[Seeded::zero(); N])).e1
    }

    fn momentum_rate(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N], a: &[Seeded; N]) -> [Seeded; N] {
        let along = |x: Seeded, rate: Seeded| Called(HyperDual::linear(x, [Seeded::zero(); N], [rate]));
        let along_q = from_fn(|i| along(q[i], v[i]));
        let l = self.lagrangian_along(along(t, Seeded::constant(1.0)), &along_q, &variables(v, a));
        mapped(&l.e12, |[rate]| rate)
    }

    fn slope(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N] {
        self.lagrangian_along(fixed(t), &variables(q, &[Seeded::zero(); N]), &mapped(v, fixed)).e1
    }

    fn force(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Option<[Seeded; N]> {
        let force = self.family.force(&Called::all(&self.parameters), Called(t), &Called::all(q), &Called::all(v))?;
        Some(Called::plain(&force))
    }

    fn constraint_along(&self, t: Along, q: &[Along; N]) -> Constraint<Along, N, M> {
        Called::plain_constraint(self.family.constraint(&self.fixed_parameters(), Called(t), &Called::all(q)))
    }

    fn basis_along(&self, t: Along, q: &[Along; N]) -> Option<AdmissibleBasis<Along, N, M>> {
        let basis = self.family.admissible_basis(&self.fixed_parameters(), Called(t), &Called::all(q))?;
        Some(Called::plain_basis(&basis))
    }

    fn holonomic(&self, t: Seeded, q: &[Seeded; N]) -> Option<[Option<Seeded>; M]> {
        let g = self.family.holonomic(&Called::all(&self.parameters), Called(t), &Called::all(q))?;
        Some(g.map(|g| g.map(|Called(g)| g)))
    }

    fn nonlinear(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Option<[Option<Dual<Seeded, N>>; M]> {
        let (t, q) = (Called(Dual::fixed(t)), mapped(q, |q| Called(Dual::fixed(q))));
        let phi = self.family.nonlinear(&self.fixed_parameters(), t, &q, &Called::all(&Dual::variables(v)))?;
        Some(phi.map(|phi| phi.map(|Called(phi)| phi)))
    }
}

/// A number of the Lagrangian, with its derivatives in `N` variables, along a motion, and in both.
type SeededAlong<const N: usize> = Called<HyperDual<Seeded, N, 1>>;

fn fixed<const N: usize>(x: Seeded) -> SeededAlong<N> {
    Called(HyperDual::fixed(x))
}

/// The variables, which change along a motion at the given rates.
fn variables<const N: usize>(x: &[Seeded; N], rate: &[Seeded; N]) -> [SeededAlong<N>; N] {
    from_fn(|i| Called(HyperDual::linear(x[i], seed(Seeded::constant(1.0), i, 0), [rate[i]])))
}

impl<F, const P: usize> SeededMember<F, P> {
    /// The parameters, which no variable changes.
    fn fixed_parameters<const K: usize>(&self) -> [Called<Dual<Seeded, K>>; P] {
        mapped(&self.parameters, |p| Called(Dual::fixed(p)))
    }

    /// The Lagrangian with its derivatives in the variables among `q` and `v`.
    ///
    /// Not inlined, so that the Lagrangian is compiled once for all of its derivatives.
    #[inline(never)]
    fn lagrangian_along<const N: usize, const M: usize>(
        &self,
        t: SeededAlong<N>,
        q: &[SeededAlong<N>; N],
        v: &[SeededAlong<N>; N],
    ) -> HyperDual<Seeded, N, 1>
    where
        F: Parametrised<N, M, P>,
    {
        self.family.lagrangian(&mapped(&self.parameters, fixed), t, q, v).0
    }
}
