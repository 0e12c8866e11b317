use crate::solved;
use crate::{
    AdmissibleBasis, Bracket, Called, Dual, Gradient, Motion, MotionError, Reduced, Rounded, Saddle, System,
    energy_slope, from_fn, inverse_reduced_mass, mapped, mass_matrix, reaction_rows, redundant_rows, velocity_of,
};

/// The unit of rounding.
const UNIT: f64 = 0.5 * f64::EPSILON;

/// What the rounding of their terms may do to the equations of motion at one point, component by component.
///
/// All bounds are to first order, by running error analysis on the functions of the system ([`Rounded`]); a place and a velocity
/// are rounded once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionRounding<const N: usize> {
    /// Error bound of the momenta `L_v` (kg m/s, or the momentum unit of the coordinate).
    pub momentum: [f64; N],
    /// Error bound of the sum of the forces, `L_q + F - (d/dt L_v at constant v) + A' lambda`.
    pub force: [f64; N],
    /// Error bound of the accelerations.
    pub acceleration: [f64; N],
}

impl<const N: usize> MotionRounding<N> {
    /// The bounds at `(t, q, v)`.
    ///
    /// # Errors
    /// [`MotionError`] if the mass matrix or the constraint is degenerate.
    #[cold]
    #[inline(never)]
    pub fn at<Sys: System<N, M>, const M: usize>(
        system: &Sys,
        t: f64,
        q: &[f64; N],
        v: &[f64; N],
    ) -> Result<Self, MotionError> {
        let Motion { multiplier, .. } = Motion::of(system, t, q, v)?;
        let (place, velocity) = (mapped(q, Rounded::once), mapped(v, Rounded::once));
        let fixed = |x: &[Rounded; N]| mapped(x, Dual::fixed);
        let slope = configuration_slope(system, Dual::fixed(Rounded::exact(t)), &fixed(&place), &fixed(&velocity));
        let pushed = system.force(Rounded::exact(t), &place, &velocity);
        // Along the motion at constant velocity.
        let along: [Dual<Rounded, 1>; N] = from_fn(|i| Dual { re: place[i], eps: [velocity[i]] });
        let time = Dual { re: Rounded::exact(t), eps: [Rounded::exact(1.0)] };
        let carried = velocity_slope(system, time, &along, &fixed(&velocity));
        let a = reaction_rows(system, t, q, v);
        let force = from_fn(|i| {
            let reaction: f64 = (0..M).map(|k| (a[k][i] * multiplier[k]).abs()).sum();
            UNIT * (slope[i].re.size + pushed.map_or(0.0, |f| f[i].size) + carried[i].eps[0].size + reaction)
        });

        // What a force does to the accelerations, the constraints met.
        let (_, block) = mass_matrix(system, t, q, v);
        let (basis, mut acceleration) = (system.admissible_basis(t, q), [0.0; N]);
        for j in 0..N {
            let right = from_fn(|i| if i == j { force[j] } else { 0.0 });
            let saddle = Saddle { block, transposed: a, rows: a, right, level: [0.0; M] };
            let (response, _) = solved(&saddle, t, basis.as_ref(), || redundant_rows(system, t, q, v))?;
            for i in 0..N {
                acceleration[i] += response[i].abs();
            }
        }
        Ok(Self { momentum: mapped(&carried, |p| UNIT * p.re.size), force, acceleration })
    }
}

/// A number with a bound on its rounding, and with its derivative along a motion.
type RoundedAlong = Dual<Rounded, 1>;

/// `L_q(t, q, v)` with bounds on the rounding, and the rates of both along a motion.
#[inline(never)]
pub fn configuration_slope<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: RoundedAlong,
    q: &[RoundedAlong; N],
    v: &[RoundedAlong; N],
) -> [RoundedAlong; N] {
    let in_q = from_fn(|i| Called(Gradient::variable(q[i], i)));
    rounded_lagrangian(system, t, &in_q, &mapped(v, |v| Called(Gradient::fixed(v))))
}

/// The momenta `L_v(t, q, v)` with bounds on the rounding, and the rates of both along a motion.
#[inline(never)]
pub fn velocity_slope<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: RoundedAlong,
    q: &[RoundedAlong; N],
    v: &[RoundedAlong; N],
) -> [RoundedAlong; N] {
    let in_v = from_fn(|i| Called(Gradient::variable(v[i], i)));
    rounded_lagrangian(system, t, &mapped(q, |q| Called(Gradient::fixed(q))), &in_v)
}

/// The gradient of the Lagrangian in the variables among `q` and `v`, compiled once.
#[inline(never)]
fn rounded_lagrangian<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: RoundedAlong,
    q: &[Called<Gradient<RoundedAlong, N>>; N],
    v: &[Called<Gradient<RoundedAlong, N>>; N],
) -> [RoundedAlong; N] {
    system.lagrangian(Called(Gradient::fixed(t)), q, v).0.gradient()
}

/// The rounding of the quasi-momenta and of their rates, as a [`Bracket`] gives them; none without a basis. Their terms are others than those
/// of the forces: of a blade in a turn they are the momenta times the turning of the basis, which cancel.
#[cold]
#[inline(never)]
pub fn bracket_rounding<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Option<[[f64; N]; 2]> {
    let (t, q, xi) = (Rounded::exact(t), mapped(q, Rounded::once), mapped(xi, Rounded::once));
    let bracket = Bracket::at(system, t, &q, &xi)?;
    let (_, mut rate) = bracket.rates(&energy_slope(system, t, &q, &xi)?.h_q, &xi);
    if let Some(force) = system.force(t, &q, &bracket.velocity) {
        let along = bracket.along_basis(&force);
        rate = from_fn(|a| rate[a] + along[a]);
    }
    Some([bracket.quasi_momenta(), rate].map(|x| mapped(&x, |x| UNIT * x.size)))
}

/// `|W|' x`.
fn products<const N: usize, const M: usize>(basis: &AdmissibleBasis<f64, N, M>, x: &[f64; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    for (sum, w) in sums.iter_mut().zip(basis.vectors()) {
        *sum = (0..N).map(|i| w[i].abs() * x[i]).sum();
    }
    sums
}

/// The rounding of the reduced equations along a step of length `h`, of the velocities and of the accelerations of the
/// quasi-velocities; none where there are no such equations.
#[cold]
#[inline(never)]
pub fn reduced_rounding<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
    h: f64,
) -> Option<[[f64; N]; 2]> {
    let (time, place, quasi) = (Rounded::exact(t), mapped(q, Rounded::once), mapped(xi, Rounded::once));
    let basis = system.admissible_basis(t, q)?;
    let acceleration = match system.reduced().reduced_motion(time, &place, &quasi) {
        Some(by_hand) => mapped(&by_hand, |x| UNIT * x.size),
        None => {
            let v = velocity_of(system, t, q, xi).ok()?;
            let forces = products(&basis, &MotionRounding::at(system, t, q, &v).ok()?.force);
            let inverse = inverse_reduced_mass(system, t, q, &v, &basis).ok()?;
            from_fn(|a| (0..N).map(|b| (inverse[a][b] * forces[b]).abs()).sum())
        }
    };
    let turned = velocity_of(system, time, &place, &quasi).ok()?;
    let velocity = from_fn(|i| {
        let moved = basis.vectors().iter().zip(&acceleration).map(|(w, a)| (h * w[i] * a).abs());
        UNIT * turned[i].size + moved.sum::<f64>()
    });
    Some([velocity, acceleration])
}
