use super::equilibria::{Equilibrium, EquilibriumError, RelativeEquilibria};
use super::flow::single;
use super::linear_map::{AllowedDirections, with_family};
use super::manifold::{positions, with_rows};
use super::root::nearest_root;
use super::shape::shape;
use dla::Mechanism;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Rates below this, relative to one plus the size of the point, count as zero.
const ROOT: f64 = 1e-12;
/// Quasi-velocities below this, relative to one plus the largest, belong to a motion that comes to rest.
const REST: f64 = 1e-9;
/// As [`REST`], if there is a rest as near: a search comes only so near to a double root.
const NEARLY_REST: f64 = 1e-5;
/// Distances (m, rad) from a first guess at which the search goes on if it ends there, and points and times (s) at which the dependence of
/// the equations is tested: in general position.
const OFFSETS: [f64; 5] = [0.0, 0.37, -0.61, 0.83, 1.9];
/// Number of further places from which rest is searched; they reach up to these multiples of one plus the start in each coordinate, and all
/// around in an angle.
const PLACES: usize = 20;
const REACHES: [f64; 3] = [0.3, 1.0, 3.0];

/// The search for the relative equilibria of a system.
pub(super) struct Searching<'a> {
    system: &'a dyn Mechanism,
    /// The numbers of its own coordinates and own quasi-velocities.
    own: (usize, usize),
    q: Vec<f64>,
    /// The first guesses of the quasi-velocities of steady motions.
    guesses: Vec<Vec<f64>>,
    shape: Vec<usize>,
}

impl<'a> Searching<'a> {
    /// The search in a system with `own` coordinates and quasi-velocities of its own, from its start.
    pub(super) fn new(
        system: &'a dyn Mechanism,
        own: (usize, usize),
        (q, v): (Vec<f64>, Vec<f64>),
    ) -> Result<Self, EquilibriumError> {
        let xi = system.quasi_velocities(0.0, &q, &v)?;
        let still = vec![0.0; q.len()];
        let rest = system.velocity_of(0.0, &q, &still)?;
        let kinetic = |v: &[f64]| system.energy(0.0, &q, v) - system.energy(0.0, &q, &rest);
        let available = kinetic(&v);
        let mut guesses = Vec::new();
        for axis in 0..own.1 {
            let unit = single(q.len(), axis, 1.0);
            let speed = (available / kinetic(&system.velocity_of(0.0, &q, &unit)?)).max(0.0).sqrt();
            if speed.is_finite() && speed > 0.0 {
                guesses.extend([speed, -speed].map(|speed| unit.iter().map(|unit| unit * speed).collect()));
            }
        }
        guesses.push(xi);
        let near = |x: &[f64], offset: f64, turn: f64| -> Vec<f64> {
            x.iter().enumerate().map(|(i, x)| x + offset * (turn + i as f64).cos()).collect()
        };
        let at = |(k, offset): (usize, &f64)| {
            let xi = if k == 0 { &still } else { &guesses[(k - 1) % guesses.len()] };
            (offset.abs(), near(&q, *offset, 0.5), near(xi, *offset, 1.7))
        };
        let shape = shape(system, own, OFFSETS.iter().enumerate().map(at))?;
        Ok(Self { system, own, q, guesses, shape })
    }

    /// The equilibria found from all places and guesses.
    pub(super) fn all(&self) -> Result<RelativeEquilibria, EquilibriumError> {
        let mut found: Vec<Equilibrium> = Vec::new();
        let mut note = |one: Option<Equilibrium>| {
            let Some(one) = one else { return false };
            if !found.iter().any(|other| self.alike(other, &one)) {
                found.push(one);
            }
            true
        };
        // Rest first: it is exact, while a motion that comes to rest from elsewhere is not.
        let (places, reach) = self.places();
        for place in &places {
            note(self.from(place, &vec![0.0; place.len()]));
        }
        let offsets = &places[..places.len().min(OFFSETS.len())];
        for guess in &self.guesses {
            // A search from a symmetric start may get stuck: then it starts beside it.
            let _ = offsets.iter().any(|place| note(self.from(place, guess)));
        }
        // The fastest first, rest last.
        let speed = |e: &Equilibrium| e.xi.iter().map(|x| x * x).sum::<f64>();
        found.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
        let (places, motions) = (places.len(), self.guesses.len());
        match found.is_empty() {
            true => Err(EquilibriumError::NoneFound { places, reach, motions }),
            false => Ok(RelativeEquilibria { found, places, reach, motions }),
        }
    }

    /// The places from which rest is searched, the start first, places beside it next; and their largest distance from the start in a
    /// coordinate.
    fn places(&self) -> (Vec<Vec<f64>>, f64) {
        let moved = |offset: &dyn Fn(usize) -> f64| {
            let mut place = self.q.clone();
            self.shape.iter().for_each(|&i| place[i] += offset(i));
            place
        };
        if self.shape.is_empty() {
            return (vec![self.q.clone()], 0.0);
        }
        let mut places: Vec<Vec<f64>> =
            OFFSETS.iter().map(|offset| moved(&|i| offset * (0.5 + i as f64).cos())).collect();
        let angles = self.system.angles();
        // Multiples of powers of a number that no ratio of small integers is near to: they fill a box evenly.
        let base = generalised_golden_ratio(self.shape.len());
        for k in 1..=PLACES {
            let reach = |i: usize| match angles[i] {
                true => PI,
                false => REACHES[k % REACHES.len()] * (1.0 + self.q[i].abs()),
            };
            let part = |i: usize| {
                let power = self.shape.iter().position(|j| *j == i).unwrap_or(0) as i32 + 1;
                2.0 * (0.5 + k as f64 * base.powi(-power)).fract() - 1.0
            };
            places.push(moved(&|i| reach(i) * part(i)));
        }
        let far = |place: &Vec<f64>| place.iter().zip(&self.q).map(|(x, start)| (x - start).abs()).fold(0.0, f64::max);
        let reach = places.iter().map(far).fold(0.0, f64::max);
        (places, reach)
    }

    /// The relative equilibrium near a place and quasi-velocities; a state of rest if these are zero.
    fn from(&self, place: &[f64], xi: &[f64]) -> Option<Equilibrium> {
        let (n, free) = self.own;
        let moving = if xi.iter().all(|xi| *xi == 0.0) { 0 } else { free };
        let start = DVector::from_iterator(n + moving, place[..n].iter().chain(&xi[..moving]).copied());
        let split = |z: &DVector<f64>| {
            let (mut q, mut xi) = (self.q.clone(), vec![0.0; self.q.len()]);
            q[..n].copy_from_slice(&z.as_slice()[..n]);
            xi[..moving].copy_from_slice(&z.as_slice()[n..]);
            (q, xi)
        };
        let tolerance = ROOT * (1.0 + start.norm());
        let mut rates = |z: &DVector<f64>| {
            let (q, xi) = split(z);
            self.at(moving == 0, &q, |system| self.rates(system, &q, &xi, moving))?
        };
        let z = nearest_root(&mut rates, start, tolerance)?;
        // A number far below rounding of the largest one is the remainder of a correction.
        let nothing = f64::EPSILON * f64::EPSILON * (1.0 + z.norm());
        let (q, xi) = split(&z.map(|x| if x.abs() < nothing { 0.0 } else { x }));
        let size = |x: &[f64]| x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if moving > 0 && size(&xi) <= NEARLY_REST * (1.0 + size(&q)) {
            let rest = self.from(&q, &vec![0.0; q.len()]);
            let apart =
                |rest: &Equilibrium| rest.q.iter().zip(&q).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            let here = |rest: &Equilibrium| apart(rest) <= NEARLY_REST * (1.0 + size(&q));
            if size(&xi) <= REST * (1.0 + size(&q)) || rest.as_ref().is_some_and(here) {
                return rest;
            }
        }
        self.at(moving == 0, &q, |system| self.linearised(system, &q, &xi))?
    }

    /// Evaluates `then` on the system. For rest the system has the basis that is good at `q`, since rest is rest in every basis; a motion
    /// is steady in the basis of the start only.
    fn at<T>(&self, rest: bool, q: &[f64], mut then: impl FnMut(&dyn Mechanism) -> T) -> Option<T> {
        let mut outcome = None;
        if rest {
            self.system.near(0.0, q, 0, &mut |_, system| outcome = Some(then(system)));
        }
        Some(outcome.unwrap_or_else(|| then(self.system)))
    }

    /// The rates of shape and quasi-velocities and the misses of the constraints on positions, with their derivatives in all coordinates
    /// and in `moving` quasi-velocities.
    fn rates(
        &self,
        system: &dyn Mechanism,
        q: &[f64],
        xi: &[f64],
        moving: usize,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let field = system.reduced_field(0.0, q, xi)?.ok()?;
        let (misses, gradients) = positions(system, self.own.0, 0.0, q);
        let all = [field.velocity, field.acceleration].concat();
        let rows = self.rows();
        let values: DVector<f64> =
            rows.iter().map(|row| all[*row]).chain(misses.iter().copied()).collect::<Vec<_>>().into();
        let slope = field.derivative.select_rows(&rows).select_columns(&self.columns(moving));
        let slope = with_rows(slope, &gradients);
        (values.iter().chain(&slope).all(|x| x.is_finite())).then_some((values, slope))
    }

    /// The indices of the shape and the own quasi-velocities among all coordinates and quasi-velocities.
    fn rows(&self) -> Vec<usize> {
        let all = self.q.len();
        self.shape.iter().copied().chain(all..all + self.own.1).collect()
    }

    /// The indices of all own coordinates and `moving` quasi-velocities.
    fn columns(&self, moving: usize) -> Vec<usize> {
        let all = self.q.len();
        (0..self.own.0).chain(all..all + moving).collect()
    }

    /// The equilibrium at a root, with its linear equations.
    fn linearised(&self, system: &dyn Mechanism, q: &[f64], xi: &[f64]) -> Option<Equilibrium> {
        let (n, free) = self.own;
        let field = system.reduced_field(0.0, q, xi)?.ok()?;
        let (_, gradients) = positions(system, n, 0.0, q);
        let along = AllowedDirections::new(&gradients, &self.shape, free)?;
        let slope = along.restrict(&field.derivative.select_rows(&self.rows()).select_columns(&self.columns(free)));
        let (family, flow) = with_family(slope, 0.0, 0.0, |[re, _]| re)?;
        let stable = flow.is_stable_flow();
        let mut place: Vec<usize> = self.shape.iter().copied().chain(along.determined).collect();
        place.sort_unstable();
        let (q, xi, shape) = (q.to_vec(), xi.to_vec(), self.shape.clone());
        Some(Equilibrium { q, v: field.velocity, xi, shape, place, family, flow: flow.values, stable })
    }

    /// Whether two equilibria are the same, or of one family: with quasi-velocities of the same signs, and at rest with equally many
    /// unstable directions.
    fn alike(&self, a: &Equilibrium, b: &Equilibrium) -> bool {
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-8 * (1.0 + x.abs().max(y.abs()));
        let sign = |x: f64| if x.abs() <= 1e-8 { 0.0 } else { x.signum() };
        let angles = self.system.angles();
        let place = |i: &usize| {
            let apart = a.q[*i] - b.q[*i];
            let turns = if angles[*i] { (apart / (2.0 * PI)).round() * 2.0 * PI } else { 0.0 };
            near(a.q[*i], b.q[*i] + turns)
        };
        let velocities = || a.xi.iter().zip(&b.xi);
        let same = self.shape.iter().all(place) && velocities().all(|(a, b)| near(*a, *b));
        let unstable = |e: &Equilibrium| if e.stable { 0 } else { e.flow.iter().filter(|z| z[0] > 1e-8).count() };
        same || a.family > 0
            && a.family == b.family
            && (!a.is_rest() || unstable(a) == unstable(b))
            && velocities().all(|(a, b)| near(sign(*a), sign(*b)))
    }
}

/// The root of `x^(d + 1) = x + 1` above one.
fn generalised_golden_ratio(d: usize) -> f64 {
    (0..60).fold(1.5_f64, |x, _| (1.0 + x).powf(1.0 / (d as f64 + 1.0)))
}
