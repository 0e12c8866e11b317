use crate::error::finite;
use crate::{ContactOscillator, Labels, Model, ModelError, ModelState};
use lagrangian::{AdmissibleBasis, Constraint, Scalar, System, energy};

/// A [`ContactOscillator`] with a gauge term, `L - q' . grad S` with `S = s cos(z)`.
///
/// The term is the total derivative `-dS/dt`: the motions are those of the oscillator, but its momenta
/// `p = q' - grad S` are shifted, `(q, p) -> (q, -p)` no longer reverses them, and an integrator made from this
/// Lagrangian is not reversible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaugedOscillator {
    oscillator: ContactOscillator,
    gauge: f64,
}

impl GaugedOscillator {
    /// An oscillator with the amplitude `s` of the gauge function; that of the source has `s = 1` and `eps = 0`.
    ///
    /// # Errors
    /// [`ModelError`] where the amplitude is not finite.
    pub fn new(oscillator: ContactOscillator, gauge: f64) -> Result<Self, ModelError> {
        Ok(Self { oscillator, gauge: finite("gauge amplitude", gauge)? })
    }

    /// The oscillator without the gauge term.
    #[must_use]
    pub fn oscillator(&self) -> ContactOscillator {
        self.oscillator
    }

    /// The amplitude `s` of the gauge function.
    #[must_use]
    pub fn gauge(&self) -> f64 {
        self.gauge
    }
}

impl System<3, 1> for GaugedOscillator {
    /// `L = L_oscillator - q' . grad S`, `grad S = (0, 0, -s sin(z))`.
    #[inline(always)]
    fn lagrangian<S: Scalar>(&self, t: S, q: &[S; 3], v: &[S; 3]) -> S {
        self.oscillator.lagrangian(t, q, v) + v[2] * q[2].sin() * self.gauge
    }

    #[inline(always)]
    fn constraint<S: Scalar>(&self, t: S, q: &[S; 3]) -> Constraint<S, 3, 1> {
        self.oscillator.constraint(t, q)
    }

    #[inline(always)]
    fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; 3]) -> Option<AdmissibleBasis<S, 3, 1>> {
        self.oscillator.admissible_basis(t, q)
    }
}

impl Model<3, 1> for GaugedOscillator {
    fn name(&self) -> &'static str {
        "gauged contact oscillator"
    }

    fn source(&self) -> &'static str {
        "Modin and Verdier 2020, What makes nonholonomic integrators work?, Numer. Math. 145, 405-435"
    }

    fn labels(&self) -> Labels {
        Labels { reversible: self.gauge == 0.0, ..self.oscillator.labels() }
    }

    fn start(&self) -> ModelState<3> {
        self.oscillator.start()
    }

    /// Those of the oscillator: a total derivative adds no force.
    fn accelerations_by_hand(&self, t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        self.oscillator.accelerations_by_hand(t, q, v)
    }

    fn invariants<S: Scalar>(&self, q: &[S; 3], v: &[S; 3]) -> Vec<(&'static str, S)> {
        vec![("energy", energy(self, S::zero(), q, v)), ("energy along y", self.oscillator.energy_in_y(q, v))]
    }

    fn density<S: Scalar>(&self, q: &[S; 3]) -> Option<S> {
        self.oscillator.density(q)
    }
}
