use crate::linear::{Lu, Singular};
use crate::{AT_ONCE, seed};
use crate::{AdmissibleBasis, Dual, Scalar, System, from_fn, mapped, mass_matrix};

/// A system without explicit time and with `b = 0`, at one point of the dual `D*` of its distribution.
///
/// With the basis `W(q)` of admissible velocities, `v = W xi`, the quasi-momenta `pi_a = W_a . p`, `p = L_v(q, W xi)`, and
/// the energy `H(q, pi) = v . p - L`, the motion is `z' = B(z) grad H` for `z = (q, pi)`, `B` skew:
///
/// ```text
/// q'    = W_a H_pi_a,                                        H_pi = xi,
/// pi_a' = -W_a . H_q - <p, [W_a, W_b]> H_pi_b + W_a . F,     [W_a, W_b] = DW_b W_a - DW_a W_b.
/// ```
///
/// (Hamel 1904; van der Schaft and Maschke 1994, Rep. Math. Phys. 34, 225-233.) A point is given by `xi` rather than
/// `pi`, since that is where a Lagrangian can be evaluated. Of arrays over the basis the last `M` places are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bracket<S, const N: usize, const M: usize> {
    /// The basis `W(q)`.
    pub basis: AdmissibleBasis<S, N, M>,
    /// The velocity `v = W xi`.
    pub velocity: [S; N],
    /// The momenta `p = L_v(q, v)`.
    pub momentum: [S; N],
    /// The Lagrangian.
    pub lagrangian: S,
    /// `<p, [W_a, W_b]>`, skew.
    structure: [[S; N]; N],
}

impl<S: Scalar, const N: usize, const M: usize> Bracket<S, N, M> {
    const DIMENSION: usize = AdmissibleBasis::<S, N, M>::DIMENSION;

    /// The bracket at `q` and the quasi-velocities `xi`; `None` if the system gives no basis.
    #[must_use]
    #[inline(always)]
    pub fn at<Sys: System<N, M>>(system: &Sys, t: S, q: &[S; N], xi: &[S; N]) -> Option<Self> {
        let (basis, velocity, l, along) = match const { N <= AT_ONCE } {
            true => Self::with_slopes(system, t, q, xi)?,
            false => Self::with_slopes_in_turn(system, t, q, xi)?,
        };
        Some(Self::of_slopes(basis, velocity, l, &along))
    }

    /// The bracket of the basis, its velocity, the Lagrangian there with its momenta, and the covector `p . DW_a` of every vector of the basis.
    #[must_use]
    #[inline(always)]
    pub fn of_slopes(basis: AdmissibleBasis<S, N, M>, velocity: [S; N], l: Dual<S, N>, along: &[[S; N]; N]) -> Self {
        let mut structure = [[S::zero(); N]; N];
        for a in 0..Self::DIMENSION {
            for b in a + 1..Self::DIMENSION {
                let (wa, wb) = (&basis.vectors()[a], &basis.vectors()[b]);
                let mut bracket = S::zero();
                for j in 0..N {
                    bracket += along[b][j] * wa[j] - along[a][j] * wb[j];
                }
                structure[a][b] = bracket;
                structure[b][a] = -bracket;
            }
        }
        Self { basis, velocity, momentum: l.eps, lagrangian: l.re, structure }
    }

    /// The basis, the velocity, the Lagrangian in it, and `p . DW_a`, a covector, of every vector of the basis.
    #[inline(always)]
    fn with_slopes<Sys: System<N, M>>(system: &Sys, t: S, q: &[S; N], xi: &[S; N]) -> Option<BracketSlopes<S, N, M>> {
        let frame = system.admissible_basis(Dual::fixed(t), &Dual::variables(q))?;
        let mut basis = AdmissibleBasis::empty();
        let mut along = [[S::zero(); N]; N];
        for (a, w) in frame.vectors().iter().enumerate() {
            basis.vectors_mut()[a] = mapped(w, |w| w.re);
        }
        let velocity = basis.combine(xi);
        let l = system.lagrangian(Dual::fixed(t), &mapped(q, Dual::fixed), &Dual::variables(&velocity));
        for (a, w) in frame.vectors().iter().enumerate() {
            for i in 0..N {
                for j in 0..N {
                    along[a][j] += l.eps[i] * w[i].eps[j];
                }
            }
        }
        Some((basis, velocity, l, along))
    }

    /// As `with_slopes`, for many coordinates, along one after another: a basis with its derivatives in all of them has `N^3` numbers.
    #[inline(always)]
    fn with_slopes_in_turn<Sys: System<N, M>>(
        system: &Sys,
        t: S,
        q: &[S; N],
        xi: &[S; N],
    ) -> Option<BracketSlopes<S, N, M>> {
        let basis = system.admissible_basis(t, q)?;
        let mut along = [[S::zero(); N]; N];
        let velocity = basis.combine(xi);
        let l = system.lagrangian(Dual::fixed(t), &mapped(q, Dual::fixed), &Dual::variables(&velocity));
        for j in 0..N {
            let frame = system.admissible_basis(Dual::fixed(t), &along_one(q, j))?;
            for (a, w) in frame.vectors().iter().enumerate() {
                for i in 0..N {
                    along[a][j] += l.eps[i] * w[i].eps[0];
                }
            }
        }
        Some((basis, velocity, l, along))
    }

    /// `W_a . f` of a covector `f`: of the momenta the quasi-momenta, of a force what it does to them.
    #[must_use]
    #[inline(always)]
    pub fn along_basis(&self, f: &[S; N]) -> [S; N] {
        let mut result = [S::zero(); N];
        for (a, w) in self.basis.vectors().iter().enumerate() {
            for i in 0..N {
                result[a] += w[i] * f[i];
            }
        }
        result
    }

    /// The quasi-momenta `pi`.
    #[must_use]
    #[inline(always)]
    pub fn quasi_momenta(&self) -> [S; N] {
        self.along_basis(&self.momentum)
    }

    /// The energy `H = v . p - L` (J).
    #[must_use]
    #[inline(always)]
    pub fn energy(&self) -> S {
        let mut energy = -self.lagrangian;
        for i in 0..N {
            energy += self.velocity[i] * self.momentum[i];
        }
        energy
    }

    /// `B(z) (h_q, h_pi)`: the rates of `q` and of `pi`.
    ///
    /// For the gradient of the energy these are the rates of the motion without forces. The product of any covector with its rates
    /// vanishes, as `B` is skew.
    #[must_use]
    #[inline(always)]
    pub fn rates(&self, h_q: &[S; N], h_pi: &[S; N]) -> ([S; N], [S; N]) {
        let mut pi = mapped(&self.along_basis(h_q), |f| -f);
        for a in 0..Self::DIMENSION {
            for b in 0..Self::DIMENSION {
                if a != b {
                    pi[a] -= self.structure[a][b] * h_pi[b];
                }
            }
        }
        (self.basis.combine(h_pi), pi)
    }
}

/// See [`Bracket::with_slopes`].
type BracketSlopes<S, const N: usize, const M: usize> = (AdmissibleBasis<S, N, M>, [S; N], Dual<S, N>, [[S; N]; N]);

/// The place `q`, its coordinate number `j` the only variable.
#[inline(always)]
fn along_one<S: Scalar, const N: usize>(q: &[S; N], j: usize) -> [Dual<S, 1>; N] {
    from_fn(
        #[inline(always)]
        |i| Dual { re: q[i], eps: seed(S::constant(1.0), i, j) },
    )
}

/// The derivatives of the energy `H(q, pi)` of a [`Bracket`] in `q` at fixed `pi`, `H_q = -d/dq L(q, W(q) xi)`, and the
/// quasi-momenta; none where the system gives no basis.
#[must_use]
#[inline(always)]
pub fn energy_slope<Sys, S, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    xi: &[S; N],
) -> Option<EnergySlope<S, N>>
where
    Sys: System<N, M>,
    S: Scalar,
{
    if const { N > AT_ONCE } {
        return energy_slope_in_turn(system, t, q, xi);
    }
    let place: [Dual<S, N>; N] = Dual::variables(q);
    let frame = system.admissible_basis(Dual::fixed(t), &place)?;
    let velocity = frame.combine(&mapped(xi, Dual::fixed));
    let h_q = mapped(&system.lagrangian(Dual::fixed(t), &place, &velocity).eps, |l_q| -l_q);

    // The derivatives in xi.
    let mut moving = mapped(&velocity, |v| Dual::fixed(v.re));
    for (a, w) in frame.vectors().iter().enumerate() {
        for i in 0..N {
            moving[i].eps[a] = w[i].re;
        }
    }
    let pi = system.lagrangian(Dual::fixed(t), &mapped(q, Dual::fixed), &moving).eps;
    Some(EnergySlope { h_q, pi })
}

/// As [`energy_slope`], for many coordinates, along one after another.
#[inline(always)]
fn energy_slope_in_turn<Sys, S, const N: usize, const M: usize>(
    system: &Sys,
    t: S,
    q: &[S; N],
    xi: &[S; N],
) -> Option<EnergySlope<S, N>>
where
    Sys: System<N, M>,
    S: Scalar,
{
    let basis = system.admissible_basis(t, q)?;
    let mut moving = mapped(&basis.combine(xi), Dual::fixed);
    for (a, w) in basis.vectors().iter().enumerate() {
        for i in 0..N {
            moving[i].eps[a] = w[i];
        }
    }
    let pi = system.lagrangian(Dual::fixed(t), &mapped(q, Dual::fixed), &moving).eps;
    let mut h_q = [S::zero(); N];
    for j in 0..N {
        let place = along_one(q, j);
        let velocity = system.admissible_basis(Dual::fixed(t), &place)?.combine(&mapped(xi, Dual::fixed));
        h_q[j] = -system.lagrangian(Dual::fixed(t), &place, &velocity).eps[0];
    }
    Some(EnergySlope { h_q, pi })
}

/// What [`energy_slope`] gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySlope<S, const N: usize> {
    /// `H_q` at fixed `pi`.
    pub h_q: [S; N],
    /// The quasi-momenta `pi`, by which the point would be named.
    pub pi: [S; N],
}

/// The inverse of the mass matrix `W' L_vv W` on the distribution, `dxi/dpi`; zero outside of the first `N - M` places.
///
/// # Errors
/// [`Singular`] where the Lagrangian does not determine the quasi-velocities.
pub fn inverse_reduced_mass<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    basis: &AdmissibleBasis<f64, N, M>,
) -> Result<[[f64; N]; N], Singular> {
    inverse_on_basis(&mass_matrix(system, t, q, v).1, basis)
}

/// The inverse of a mass matrix on the distribution, as [`inverse_reduced_mass`].
///
/// # Errors
/// [`Singular`] where the mass matrix does not determine the quasi-velocities.
#[inline(never)]
pub fn inverse_on_basis<const N: usize, const M: usize>(
    mass: &[[f64; N]; N],
    basis: &AdmissibleBasis<f64, N, M>,
) -> Result<[[f64; N]; N], Singular> {
    let dimension = basis.vectors().len();
    // The identity fills the places that are not used.
    let reduced: [[f64; N]; N] = from_fn(|a| {
        from_fn(|b| match (basis.vectors().get(a), basis.vectors().get(b)) {
            (Some(wa), Some(wb)) => (0..N).map(|i| wa[i] * (0..N).map(|j| mass[i][j] * wb[j]).sum::<f64>()).sum(),
            _ => f64::from(u8::from(a == b)),
        })
    });
    let lu = Lu::new(reduced)?;
    let mut inverse = [[0.0; N]; N];
    for b in 0..dimension {
        let column = lu.solve(from_fn(|k| f64::from(u8::from(k == b))));
        for a in 0..dimension {
            inverse[a][b] = column[a];
        }
    }
    Ok(inverse)
}
