//! What systems and joints add to the equations of a method that keeps the energy.

use super::element::{Average, EnergyElement, Swing};
use crate::AssemblyError;
use crate::joint::{Joint, JointElement};
use crate::local::local;
use crate::system_element::SystemElement;
use dla::Slopes;
use lagrangian::linear::largest;
use lagrangian::{Dual, Lanes, Scalar, from_fn};

const UNSUPPORTED_TIME: AssemblyError = AssemblyError::Unsupported {
    reason: "the energy-preserving methods need systems that do not depend on time explicitly, and this assembly does",
};
const UNSUPPORTED_MOVING: AssemblyError = AssemblyError::Unsupported {
    reason: "the energy is conserved only under constraints with b = 0, and a constraint of the assembly has another b",
};
const UNSUPPORTED_ROWS: AssemblyError = AssemblyError::Unsupported {
    reason: "energy2 needs constraints that are affine in the velocities, and a constraint of the assembly is not",
};
const UNSUPPORTED_LINEAR: AssemblyError = AssemblyError::Unsupported {
    reason: "energy2 needs kinetic energies that are quadratic in the velocities, and a kinetic energy of the \
        assembly is not",
};

impl<const N: usize, const M: usize> SystemElement<N, M> {
    /// Whether the system gives a basis. One whose constraints hold positions too is held by its rows.
    fn has_basis(&self) -> bool {
        let (system, q) = (&self.system, &[0.0; N]);
        M > 0 && !system.constrains_positions(0.0, q) && system.basis(0.0, q).is_some()
    }
}

/// Writes vectors as the columns of a matrix.
fn columns<const N: usize>(vectors: &[[f64; N]], matrix: &mut [f64]) {
    let k = vectors.len();
    for (a, w) in vectors.iter().enumerate() {
        for (i, w) in w.iter().enumerate() {
            matrix[i * k + a] = *w;
        }
    }
}

fn identity<const N: usize>() -> [[f64; N]; N] {
    from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))))
}

impl<const N: usize, const M: usize> EnergyElement for SystemElement<N, M> {
    fn quasi_velocities(&self) -> usize {
        if self.has_basis() { N - M } else { N }
    }

    fn rest(&self, t: f64, q: &[f64], v: &[f64], xi: &mut [f64], mass: &mut [f64]) -> Result<(), AssemblyError> {
        let (q, v) = (local(q), local(v));
        let (_, full) = self.system.mass_matrix(t, &q, &v);
        let basis = if self.has_basis() { self.system.basis(t, &q) } else { None };
        let k = xi.len();
        match &basis {
            Some(_) => {
                let own = self.system.quasi_velocities(t, &q, &v).map_err(|_| NO_BASIS)?;
                xi.copy_from_slice(&own[..k]);
            }
            None => xi.copy_from_slice(&v),
        }
        let axes = identity::<N>();
        let w = basis.as_ref().map_or(&axes[..], |basis| basis.vectors());
        for a in 0..k {
            for b in 0..k {
                mass[a * k + b] = (0..N).map(|i| w[a][i] * (0..N).map(|j| full[i][j] * w[b][j]).sum::<f64>()).sum();
            }
        }
        Ok(())
    }

    fn has_inertia(&self, t: f64, q: &[f64], v: &[f64]) -> bool {
        let (_, mass) = self.system.mass_matrix(t, &local(q), &local(v));
        mass.as_flattened().iter().any(|m| *m != 0.0)
    }

    fn keeps_energy(&self, t: f64, q: &[f64], v: &[f64]) -> Result<(), AssemblyError> {
        let (q, v): ([f64; N], [f64; N]) = (local(q), local(v));
        if self.system.has_moving_rows(t, &q) {
            return Err(UNSUPPORTED_MOVING);
        }
        if self.system.is_nonlinear(t, &q, &v) {
            return Err(UNSUPPORTED_ROWS);
        }
        if self.system.lagrangian_power(t, &q, &v) != 0.0 {
            return Err(UNSUPPORTED_TIME);
        }
        if largest(&self.system.momentum(t, &q, &[0.0; N])) != 0.0 {
            return Err(UNSUPPORTED_LINEAR);
        }
        Ok(())
    }

    fn swing(&self, step: (f64, f64), q0: &[f64], xi: &[f64], out: Swing<'_>) -> Option<()> {
        if self.has_basis() {
            return self.system.swing(step, &local(q0), xi, out);
        }
        out.v.copy_from_slice(xi);
        out.slope.copy_from_slice(identity::<N>().as_flattened());
        out.frame.copy_from_slice(identity::<N>().as_flattened());
        out.turning.fill(0.0);
        out.turning_slope.fill(0.0);
        Some(())
    }

    fn frame(&self, t: f64, q: &[f64], frame: &mut [f64]) -> Option<()> {
        if self.has_basis() {
            columns(self.system.basis(t, &local(q))?.vectors(), frame);
        } else {
            frame.copy_from_slice(identity::<N>().as_flattened());
        }
        Some(())
    }

    fn push(
        &self,
        (t0, h): (f64, f64),
        rule: &Average,
        q0: &[f64],
        v: &[f64],
        (push, slope): (&mut [f64], &mut [f64]),
    ) -> f64 {
        let (q0, v): ([f64; N], [f64; N]) = (local(q0), local(v));
        let (system, t) = (&self.system, t0 + 0.5 * h);
        let middle = from_fn(|i| q0[i] + 0.5 * h * v[i]);
        // The derivative in v is that of the gradient in the middle.
        let (l_q, l_qq) = system.potential_slopes(t, &rule.points(h, &q0, &v), &middle);
        for i in 0..N {
            push[i] = h * rule.of(l_q[i]);
            for j in 0..N {
                slope[i * N + j] = 0.5 * h * h * l_qq[i][j];
            }
        }
        let Some(force) = system.force_along(t, &middle, &v, 0.5 * h, 1.0) else { return 0.0 };
        let mut work = 0.0;
        for i in 0..N {
            push[i] += h * force[i].re;
            work += h * force[i].re * v[i];
            for j in 0..N {
                slope[i * N + j] += h * force[i].eps[j];
            }
        }
        work
    }

    fn mean_rows(&self, (t0, h): (f64, f64), rule: &Average, q0: &[f64], v: &[f64], rows: &mut [f64]) {
        let (q0, v): ([f64; N], [f64; N]) = (local(q0), local(v));
        let t = t0 + 0.5 * h;
        let (a, _) = self.system.constraint(t, &from_fn(|i| q0[i] + 0.5 * h * v[i]));
        rows.copy_from_slice(a.as_flattened());
        let positions = self.system.position_slopes(t, &rule.points(h, &q0, &v));
        for (row, slopes) in rows.chunks_exact_mut(N).zip(positions.iter().flatten()) {
            for (x, slope) in row.iter_mut().zip(slopes.iter().flatten()) {
                *x = rule.of(*slope);
            }
        }
    }

    fn energies(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; 2] {
        let (q, v): ([f64; N], [f64; N]) = (local(q), local(v));
        let Slopes { l_q, l_v, .. } = self.system.slopes(t, &q, &v);
        let products = (0..N).map(|i| (l_v[i] * v[i]).abs() + (l_q[i] * q[i]).abs()).sum::<f64>();
        [self.system.energy(t, &q, &v), self.system.lagrangian(t, &q, &v).abs() + products]
    }
}

pub(super) const NO_BASIS: AssemblyError =
    AssemblyError::Unsupported { reason: "a body has no basis of its admissible velocities there" };

impl<J: Joint<N, M>, const N: usize, const M: usize> EnergyElement for JointElement<J, N, M> {
    fn quasi_velocities(&self) -> usize {
        N
    }

    fn rest(&self, _t: f64, _q: &[f64], v: &[f64], xi: &mut [f64], mass: &mut [f64]) -> Result<(), AssemblyError> {
        xi.copy_from_slice(v);
        mass.fill(0.0);
        Ok(())
    }

    fn has_inertia(&self, _t: f64, _q: &[f64], _v: &[f64]) -> bool {
        false
    }

    fn keeps_energy(&self, t: f64, q: &[f64], _v: &[f64]) -> Result<(), AssemblyError> {
        let q: [f64; N] = local(q);
        let g = self.joint.position(Dual { re: t, eps: [1.0] }, &q.map(Dual::fixed));
        if g.iter().any(|g: &Dual<f64, 1>| g.eps[0] != 0.0) { Err(UNSUPPORTED_MOVING) } else { Ok(()) }
    }

    fn swing(&self, _step: (f64, f64), _q0: &[f64], _xi: &[f64], _out: Swing<'_>) -> Option<()> {
        None
    }

    fn frame(&self, _t: f64, _q: &[f64], _frame: &mut [f64]) -> Option<()> {
        None
    }

    fn push(&self, _step: (f64, f64), _rule: &Average, _q0: &[f64], _v: &[f64], out: (&mut [f64], &mut [f64])) -> f64 {
        out.0.fill(0.0);
        out.1.fill(0.0);
        0.0
    }

    fn mean_rows(&self, (t0, h): (f64, f64), rule: &Average, q0: &[f64], v: &[f64], rows: &mut [f64]) {
        let path = Dual::variables(&rule.points(h, &local::<N>(q0), &local::<N>(v)));
        let g = self.joint.position(Dual::fixed(Lanes::constant(t0 + 0.5 * h)), &path);
        for (row, g) in rows.chunks_exact_mut(N).zip(&g) {
            for (x, slope) in row.iter_mut().zip(g.eps) {
                *x = rule.of(slope);
            }
        }
    }

    fn energies(&self, _t: f64, _q: &[f64], _v: &[f64]) -> [f64; 2] {
        [0.0; 2]
    }
}
