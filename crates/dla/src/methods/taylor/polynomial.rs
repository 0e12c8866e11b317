use super::center::Center;
use super::pace::Pace;
use crate::{MeanPower, Mechanics, ReducedSeries, State, StepError, power};
use expression::Expansion;
use lagrangian::quadrature::{gauss_legendre, shifted_legendre};
use lagrangian::{PowerSources, Smoothness, added, from_fn, mul_add, power_of_two_below};

/// The equations of a system, and the polynomial about a center that solves them.
#[derive(Debug, Clone)]
pub(super) struct Polynomial {
    pub(super) of: ReducedSeries,
    pub(super) series: Expansion<f64>,
    pub(super) pace: Pace,
    pub(super) tolerance: f64,
    pub(super) smoothness: Smoothness,
    /// Length of the longest polynomial (s).
    pub(super) longest: f64,
    /// The time of the center (s), as long as the coefficients belong to it.
    about: Option<f64>,
    /// Room for the unknowns at a center, for increments and for rates.
    pub(super) start: Vec<f64>,
    increments: Vec<f64>,
    pub(super) rates: Vec<f64>,
    /// The Legendre series of the power along the polynomial, once it was asked for.
    power: Option<[f64; NODES]>,
}

/// Smallest unit of time at a node (s).
const SHORTEST: f64 = 1e-100;
/// Smallest unit of time (s).
const LEAST_UNIT: f64 = 1e-290;
/// Number of places at which the power is evaluated along a polynomial.
const NODES: usize = 16;
impl Polynomial {
    pub(super) fn new<const N: usize, const M: usize>(
        system: &dyn Mechanics<N, M>,
        of: ReducedSeries,
        tolerance: f64,
    ) -> Self {
        let (series, unknowns) = (Expansion::new(&of.recurrences), of.recurrences.unknowns());
        let [start, increments, rates] = [(); 3].map(|()| vec![0.0; unknowns]);
        let (pace, smoothness) = (Pace::of(tolerance), system.smoothness());
        Self {
            of,
            series,
            pace,
            tolerance,
            smoothness,
            longest: f64::INFINITY,
            about: None,
            start,
            increments,
            rates,
            power: None,
        }
    }

    /// Lets no polynomial be longer than a step of the run (s), if a function of time may do something of which nothing tells before. Steps
    /// are then for the user to choose.
    pub(super) fn within(&mut self, step: f64) {
        self.longest = if self.of.recurrences.is_sudden() { step.abs() } else { f64::INFINITY };
    }

    /// Forgets the coefficients.
    pub(super) fn forget(&mut self) {
        self.about = None;
    }

    /// The polynomial from a node on.
    pub(super) fn begin<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        (t, h): (f64, f64),
        state: &State<N>,
    ) -> Result<Center<N>, StepError> {
        let mut center = Center {
            t,
            state: *state,
            xi: [state.quasi_velocities(system, t)?, [0.0; N]],
            unit: power_of_two_below(h.abs().clamp(SHORTEST, 1.0)),
            full: 0.0,
            forward: h > 0.0,
            sides: vec![0.0; self.of.recurrences.corners()].into(),
            after: None,
            before: None,
        };
        self.expand(&mut center)?;
        self.settle(system, &mut center, None)?;
        Ok(center)
    }

    /// Goes on to the polynomial that begins at the end of this one. Returns false if the equations there contradict this polynomial: then this
    /// polynomial is made shorter, and nothing else changes.
    pub(super) fn go_on<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        center: &mut Center<N>,
    ) -> Result<bool, StepError> {
        let (t, full) = (center.end(), center.full);
        let before = self.doubted().then(|| center.clone());
        if before.is_some() {
            self.rates_at(center, t - center.t);
        }
        self.advance(center, t)?;
        (center.t, center.unit) = (t, power_of_two_below(full));
        let turned = center.after.take();
        let at_corner = turned.is_some();
        center.before = turned.map(|sides| std::mem::replace(&mut center.sides, sides));
        self.expand(center)?;
        if let Some(mut before) = before.filter(|_| !at_corner && self.refuted(center.unit, full)) {
            before.full *= 0.25;
            *center = before;
            self.expand(center)?;
            return Ok(false);
        }
        self.settle(system, center, Some(full))?;
        Ok(true)
    }

    /// The state on the polynomial at a time (s).
    pub(super) fn at<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        center: &Center<N>,
        t: f64,
    ) -> Result<State<N>, StepError> {
        let mut place = center.clone();
        self.advance(&mut place, t)?;
        let Center { mut state, xi: [xi, _], .. } = place;
        let v = system.velocity_of(t, state.q(), &xi)?;
        state.stays_finite(&[0.0; N], &v)?;
        state.advance(&[0.0; N], v, Some(xi));
        Ok(state)
    }

    /// The work that some sources do between two times (s) on the polynomial about a center: the integral of the power's Legendre series.
    pub(super) fn work<const N: usize, const M: usize>(
        &mut self,
        system: &dyn Mechanics<N, M>,
        sources: PowerSources,
        center: &Center<N>,
        [from, to]: [f64; 2],
    ) -> f64 {
        let (begin, length) = (center.t, center.end() - center.t);
        let series = match self.power {
            Some(series) => series,
            None => {
                let (nodes, weights) = gauss_legendre::<NODES>();
                let powers = nodes.map(|node| {
                    let t = begin + node * length;
                    self.at(system, center, t).map_or(f64::NAN, |at| power(system, sources, t, (at.q(), at.v())))
                });
                // A power that is not known at one place is the mean of those at the others.
                let mut mean = MeanPower::default();
                powers.iter().zip(weights).for_each(|(power, weight)| mean.add(weight, *power));
                let powers = powers.map(|power| if power.is_finite() { power } else { mean.mean() });
                let polynomials = nodes.map(|node| shifted_legendre::<NODES>(node).0);
                let sum = |l: usize| (0..NODES).map(|i| weights[i] * powers[i] * polynomials[i][l]).sum::<f64>();
                *self.power.insert(from_fn(|l| (2 * l + 1) as f64 * sum(l)))
            }
        };
        let ends = [from, to].map(|t| shifted_legendre::<{ NODES + 1 }>((t - begin) / length).0);
        // The integral of the polynomial `l` is `(P_(l+1) - P_(l-1))/(2 l + 1)`.
        let between = |l: usize| ends[1][l] - ends[0][l];
        let rest = (1..NODES).map(|l| series[l] * (between(l + 1) - between(l - 1)) / (2 * l + 1) as f64);
        0.5 * length * rest.fold(series[0] * between(1), |sum, x| sum + x)
    }

    /// Makes sure that the coefficients are those of a center.
    pub(super) fn refresh<const N: usize>(&mut self, center: &mut Center<N>) -> Result<(), StepError> {
        let same = self.about.is_some_and(|t| t.to_bits() == center.t.to_bits());
        if same { Ok(()) } else { self.expand(center) }
    }

    /// Moves place and quasi-velocities along the polynomial about a center, to a time (s).
    pub(super) fn advance<const N: usize>(&mut self, center: &mut Center<N>, t: f64) -> Result<(), StepError> {
        let s = (t - center.t) / center.unit;
        self.increments.fill(0.0);
        for k in (1..=self.series.order()).rev() {
            for (sum, c) in self.increments.iter_mut().zip(self.series.coefficients(k)) {
                *sum = mul_add(*sum, s, *c);
            }
        }
        let (places, velocities) = self.increments.split_at(self.of.coordinates);
        let increment = |row: &[f64], k: usize| row.get(k).map_or(0.0, |x| x * s);
        let increments: [f64; N] = from_fn(|i| increment(places, i));
        let [xi, rest] = &mut center.xi;
        for k in 0..velocities.len().min(N) {
            (xi[k], rest[k]) = added(xi[k], increment(velocities, k) + rest[k]);
        }
        center.state.stays_finite(&increments, xi)?;
        center.state.advance(&increments, [0.0; N], None);
        Ok(())
    }

    /// The rates of the unknowns on the polynomial, at a time since its center (s).
    pub(super) fn rates_at<const N: usize>(&mut self, center: &Center<N>, s: f64) {
        let s = s / center.unit;
        self.rates.resize(self.start.len(), 0.0);
        self.rates.fill(0.0);
        for k in (1..=self.series.order()).rev() {
            for (sum, c) in self.rates.iter_mut().zip(self.series.coefficients(k)) {
                *sum = mul_add(*sum, s, k as f64 * c);
            }
        }
        for rate in &mut self.rates {
            *rate /= center.unit;
        }
    }

    /// Computes the coefficients about a center, in a smaller unit of time if they overflow.
    pub(super) fn expand<const N: usize>(&mut self, center: &mut Center<N>) -> Result<(), StepError> {
        self.power = None;
        let (places, velocities) = self.start.split_at_mut(self.of.coordinates);
        places.iter_mut().zip(center.state.q()).for_each(|(x, q)| *x = *q);
        velocities.iter_mut().zip(&center.xi[0]).for_each(|(x, xi)| *x = *xi);
        let other = |variable: usize| self.of.constant(variable).map_or(0.0, |(_, x)| x);
        while (LEAST_UNIT..=f64::MAX).contains(&center.unit) {
            let at = (center.t, &self.start[..], &*center.sides);
            self.series.expand_with(&self.of.recurrences, at, center.unit, self.pace.order, other);
            let finite = |k: usize| self.series.coefficients(k).iter().all(|c| c.is_finite());
            if finite(self.pace.order) && finite(self.pace.order - 1) {
                self.about = Some(center.t);
                return Ok(());
            }
            center.unit *= 2f64.powi(-12);
        }
        self.about = None;
        Err(StepError::NotFinite)
    }
}
