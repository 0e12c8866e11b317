use crate::reduced::shortest;
use crate::{AdmissibleBasis, Constraint, Dual, HyperDual, Parametrised, Scalar, from_fn, mapped};

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

impl<F: Parametrised<N, M, P>, const N: usize, const M: usize, const P: usize> Gradients<N, M> for SeededMember<F, P> {
    fn lagrangian(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Seeded {
        self.first_order(t, &mapped(q, Dual::fixed), &mapped(v, Dual::fixed)).re
    }

    fn momentum(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N] {
        self.first_order(t, &mapped(q, Dual::fixed), &Dual::variables(v)).eps
    }

    fn momentum_rate(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N], a: &[Seeded; N]) -> [Seeded; N] {
        let (zero, one) = (Seeded::zero(), Seeded::constant(1.0));
        let along_t = HyperDual::linear(t, [zero; N], [one]);
        let along_q: [HyperDual<Seeded, N, 1>; N] = from_fn(|i| HyperDual::linear(q[i], [zero; N], [v[i]]));
        let in_v =
            from_fn(|i| HyperDual::linear(v[i], from_fn(|k| Seeded::constant(f64::from(u8::from(k == i)))), [a[i]]));
        let p = mapped(&self.parameters, HyperDual::fixed);
        mapped(&self.family.lagrangian(&p, along_t, &along_q, &in_v).e12, |[rate]| rate)
    }

    fn slope(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> [Seeded; N] {
        self.first_order(t, &Dual::variables(q), &mapped(v, Dual::fixed)).eps
    }

    fn force(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Option<[Seeded; N]> {
        self.family.force(&self.parameters, t, q, v)
    }

    fn constraint_along(&self, t: Along, q: &[Along; N]) -> Constraint<Along, N, M> {
        self.family.constraint(&mapped(&self.parameters, Dual::fixed), t, q)
    }

    fn basis_along(&self, t: Along, q: &[Along; N]) -> Option<AdmissibleBasis<Along, N, M>> {
        self.family.admissible_basis(&mapped(&self.parameters, Dual::fixed), t, q)
    }

    fn holonomic(&self, t: Seeded, q: &[Seeded; N]) -> Option<[Option<Seeded>; M]> {
        self.family.holonomic(&self.parameters, t, q)
    }

    fn nonlinear(&self, t: Seeded, q: &[Seeded; N], v: &[Seeded; N]) -> Option<[Option<Dual<Seeded, N>>; M]> {
        let (t, q) = (Dual::fixed(t), mapped(q, Dual::fixed));
        self.family.nonlinear(&mapped(&self.parameters, Dual::fixed), t, &q, &Dual::variables(v))
    }
}

impl<F, const P: usize> SeededMember<F, P> {
    /// The Lagrangian with its gradient in the variables among `q` and `v`.
    ///
    /// Not inlined, so that the Lagrangian is compiled once for both of its gradients.
    #[inline(never)]
    fn first_order<const N: usize, const M: usize>(
        &self,
        t: Seeded,
        q: &[Dual<Seeded, N>; N],
        v: &[Dual<Seeded, N>; N],
    ) -> Dual<Seeded, N>
    where
        F: Parametrised<N, M, P>,
    {
        self.family.lagrangian(&mapped(&self.parameters, Dual::fixed), Dual::fixed(t), q, v)
    }
}
