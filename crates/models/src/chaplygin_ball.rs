use crate::error::positive;
use crate::{Attitude, Labels, Model, ModelError, State};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, energy, from_fn};

/// The Chaplygin ball: it rolls on a horizontal plane without slipping, its mass centre at its geometric centre and its
/// three principal moments of inertia any.
///
/// `q = (x, y, alpha, beta, gamma)`: the centre over the plane (m), and the angles of [`Attitude`] (rad), singular
/// where `cos(beta) = 0`. Below, `g = R' e_z` is the vertical as the body sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChaplyginBall {
    mass: f64,
    radius: f64,
    inertia: [f64; 3],
}

impl ChaplyginBall {
    /// A ball of mass `m` (kg) and radius `r` (m), with the principal moments of inertia `I` about its centre (kg m^2).
    ///
    /// # Errors
    /// [`ModelError`] names the parameter that is not positive.
    pub fn new(mass: f64, radius: f64, inertia: [f64; 3]) -> Result<Self, ModelError> {
        positive("mass", mass)?;
        positive("radius", radius)?;
        for (quantity, value) in ["first moment", "second moment", "third moment"].into_iter().zip(inertia) {
            positive(quantity, value)?;
        }
        Ok(Self { mass, radius, inertia })
    }

    /// Mass `m` (kg).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Radius `r` (m).
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The principal moments of inertia `I` (kg m^2).
    #[must_use]
    pub fn inertia(&self) -> [f64; 3] {
        self.inertia
    }

    /// `D = m r^2`, the inertia of the rolling (kg m^2).
    #[must_use]
    pub fn rolling_inertia(&self) -> f64 {
        self.mass * self.radius * self.radius
    }

    /// The angular momentum about the contact point, in space (kg m^2/s): `R K` with
    /// `K = I Omega + D (Omega - (Omega . g) g)`.
    pub fn contact_momentum<S: Scalar>(&self, q: &[S; 5], v: &[S; 5]) -> [S; 3] {
        let attitude = Attitude::new([q[2], q[3], q[4]]);
        let omega = attitude.body_velocity([v[2], v[3], v[4]]);
        let rotation = attitude.rotation();
        let spin = dot(&rotation[2], &omega);
        let d = self.rolling_inertia();
        let k = from_fn(|i| omega[i] * (self.inertia[i] + d) - rotation[2][i] * spin * d);
        rotation.map(|row| dot(&row, &k))
    }
}

impl System<5, 2> for ChaplyginBall {
    /// `L = m/2 (x'^2 + y'^2) + Omega . I Omega / 2`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 5], v: &[S; 5]) -> S {
        let [o1, o2, o3] = Attitude::new([q[2], q[3], q[4]]).body_velocity([v[2], v[3], v[4]]);
        (v[0] * v[0] + v[1] * v[1]) * (0.5 * self.mass)
            + o1 * o1 * (0.5 * self.inertia[0])
            + o2 * o2 * (0.5 * self.inertia[1])
            + o3 * o3 * (0.5 * self.inertia[2])
    }

    /// `x' = r omega_y`, `y' = -r omega_x`, with `omega` the angular velocity in space.
    #[inline(always)]
    fn constraint<S: Scalar>(&self, _t: S, q: &[S; 5]) -> Constraint<S, 5, 2> {
        let [in_x, in_y, _] = Attitude::new([q[2], q[3], q[4]]).space_velocity_matrix();
        let (zero, one) = (S::zero(), S::constant(1.0));
        let r = self.radius;
        let first = [one, zero, -in_y[0] * r, -in_y[1] * r, -in_y[2] * r];
        let second = [zero, one, in_x[0] * r, in_x[1] * r, in_x[2] * r];
        ([first, second], [zero; 2])
    }

    /// One angle turns, and the centre follows.
    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, _t: S, q: &[S; 5]) -> Option<AdmissibleBasis<S, 5, 2>> {
        let [in_x, in_y, _] = Attitude::new([q[2], q[3], q[4]]).space_velocity_matrix();
        let (zero, one) = (S::zero(), S::constant(1.0));
        Some(AdmissibleBasis::new(from_fn::<_, 3, _>(|k| {
            let mut w = [in_y[k] * self.radius, -in_x[k] * self.radius, zero, zero, zero];
            w[2 + k] = one;
            w
        })))
    }

    #[inline(always)]
    fn angles(&self) -> [bool; 5] {
        [false, false, true, true, true]
    }
}

impl Model<5, 2> for ChaplyginBall {
    fn name(&self) -> &'static str {
        "Chaplygin ball"
    }

    fn source(&self) -> &'static str {
        "Chaplygin 1903, On a ball's rolling on a horizontal plane, Regul. Chaotic Dyn. 7 (2002) 131-148; Borisov and \
         Mamaev 2001, Chaplygin's ball rolling problem is Hamiltonian, Math. Notes 70, 720-723"
    }

    fn labels(&self) -> Labels {
        Labels { reversible: true, integrable: true, invariant_measure: true }
    }

    fn start(&self) -> State<5> {
        let q = [0.0, 0.0, 0.2, -0.3, 0.1];
        let attitude = Attitude::new([q[2], q[3], q[4]]);
        let rates = attitude.rates([0.5, 0.8, -0.4]);
        let [in_x, in_y, _] = attitude.space_velocity_matrix();
        let r = self.radius;
        (q, [r * dot(&in_y, &rates), -r * dot(&in_x, &rates), rates[0], rates[1], rates[2]])
    }

    /// `K' = K x Omega`, `g' = g x Omega`: with `A = (I + D)^-1` and `b = K x Omega + D (g . Omega) g x Omega`,
    /// `Omega' = A b + D (g . A b) / (1 - D g . A g) A g`; the centre is `r` times the acceleration in space.
    fn accelerations_by_hand(&self, _t: f64, q: &[f64; 5], v: &[f64; 5]) -> [f64; 5] {
        let attitude = Attitude::new([q[2], q[3], q[4]]);
        let rotation = attitude.rotation();
        let g = rotation[2];
        let rates = [v[2], v[3], v[4]];
        let omega = attitude.body_velocity(rates);
        let d = self.rolling_inertia();
        let spin = dot(&g, &omega);
        let k = from_fn(|i| (self.inertia[i] + d) * omega[i] - d * spin * g[i]);
        let (turning, falling) = (cross(k, omega), cross(g, omega));
        let solved: [f64; 3] = from_fn(|i| (turning[i] + d * spin * falling[i]) / (self.inertia[i] + d));
        let leaned: [f64; 3] = from_fn(|i| g[i] / (self.inertia[i] + d));
        let share = d * dot(&g, &solved) / (1.0 - d * dot(&g, &leaned));
        let acceleration = from_fn(|i| solved[i] + share * leaned[i]);
        let angles = attitude.accelerations(rates, acceleration);
        let r = self.radius;
        let [along_x, along_y, _] = rotation.map(|row| dot(&row, &acceleration));
        [r * along_y, -r * along_x, angles[0], angles[1], angles[2]]
    }

    fn invariants<S: Scalar>(&self, q: &[S; 5], v: &[S; 5]) -> Vec<(&'static str, S)> {
        let [x, y, z] = self.contact_momentum(q, v);
        vec![
            ("energy", energy(self, S::zero(), q, v)),
            ("momentum about the contact point, x", x),
            ("momentum about the contact point, y", y),
            ("momentum about the contact point, z", z),
        ]
    }

    /// `sqrt(1 - D g . A g)` for the rotations and `Omega`, and `cos(beta)^2` from these to the angles and their rates.
    fn density<S: Scalar>(&self, q: &[S; 5]) -> Option<S> {
        let attitude = Attitude::new([q[2], q[3], q[4]]);
        let [_, _, g] = attitude.rotation();
        let d = self.rolling_inertia();
        let lean = g[0] * g[0] * (d / (self.inertia[0] + d))
            + g[1] * g[1] * (d / (self.inertia[1] + d))
            + g[2] * g[2] * (d / (self.inertia[2] + d));
        Some((-lean + 1.0).sqrt() * attitude.regularity().squared())
    }

    fn regularity(&self, q: &[f64; 5]) -> f64 {
        Attitude::new([q[2], q[3], q[4]]).regularity().abs()
    }
}

fn dot<S: Scalar>(a: &[S; 3], b: &[S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
