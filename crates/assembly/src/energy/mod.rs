//! A method that keeps the energy of an assembly, with its joints and blades.

pub(crate) mod element;
mod elements;
mod frames;
mod mean;

pub use element::{Average, EnergyElement, Swing};

use crate::assembly::PlacedElement;
use crate::contributions::at;
use crate::dla::predict;
use crate::settling::AssemblySettling;
use crate::sparse::Sparse;
use crate::terms;
use crate::{Assembly, AssemblyError, AssemblyMethod, AssemblyReport, AssemblyState, Solver};
use dla::Stage;
use dla::convergence::{FixedPoint, rounding_of_place};
use elements::NO_BASIS;
use frames::Frames;
use lagrangian::linear::larger;
use mean::{MeanPath, SparseMeanEquations};

/// The energy-preserving method of order 2 of an assembly, whose joints and blades hold at every node: symmetric.
///
/// Each body moves in the basis `W` of its own admissible velocities, `v = W xi`, as in the static
/// [`Energy`](dla::Energy) of order 2. Joints, and blades under bodies that have no such basis, are constraints `C(q) xi = 0`, and
/// `g(q) = 0` where they hold positions. From `(q0, xi0)` a step finds the mean quasi-velocities `x` and impulses `lambda` with
///
/// ```text
/// q1 = q0 + h W(q_m) x,      q_m = (q0 + q1)/2,      g(q1) = 0 or A(q_m) (q1 - q0) = 0,
/// 2 M (x - xi0) = -h (W' V_q + S(q_m, x) x) + h W' F + Y lambda + kappa M x,
/// ```
///
/// `V_q` the mean of the potential's gradient along the step and `S` the skew matrix of the [bracket](lagrangian::Bracket); `Y`
/// has the mean gradients of the joints, `Y' x = (g(q1) - g(q0))/h`. The velocity follows by
///
/// ```text
/// xi1 = 2 x - xi0 - 2 e,     M e = Y alpha,     C(q1) xi1 = 0.
/// ```
///
/// Without joints `e = 0`, and this is the static method. With them `x = (xi0 + xi1)/2 + e`, and by the equations the energy changes
/// by the work `h F . W x` of the forces and by `kappa x . M x - e . M (xi1 - xi0)`; so `kappa`, one number of the third order
/// in the step, is `e . M (xi1 - xi0) / x . M x`, and the energy of the whole is kept. (A discrete gradient under constraints on
/// positions: Gonzalez 1999, Physica D 132, 165-174, whose velocities do not meet `C xi = 0`; the book, (5.7) to (5.10).)
///
/// The kinetic energy of each body must be a constant quadratic form in its quasi-velocities, as that of a sleigh, a rigid body
/// of the plane or a rotor is; constraints do not move, and time does not enter but in forces. What else is refused, as is a
/// step along which the energy is too rough for the eight nodes of its averages.
pub struct SparseEnergy {
    frames: Frames,
    system: Sparse,
    projection: Sparse,
    settling: AssemblySettling,
    rule: Average,
    mass: Vec<f64>,
    xi0: Vec<f64>,
    x: Vec<f64>,
    xi1: Vec<f64>,
    momenta: Vec<f64>,
    impulses: Vec<f64>,
    path: MeanPath,
    /// The frames `W(q1)`.
    end: Vec<f64>,
    /// The frames `W(q0)`, where they are needed.
    start: Vec<f64>,
    q0: Vec<f64>,
    v0: Vec<f64>,
    v1: Vec<f64>,
    /// The masses at the start of the iteration.
    unused: Vec<f64>,
}

impl std::fmt::Debug for SparseEnergy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Energy").field("quasi_velocities", &self.frames.quasi).finish_non_exhaustive()
    }
}

/// What turns by less than this in a step (rad) is near its start.
const NEAR: f64 = 1.0;

impl SparseEnergy {
    /// So many times `kappa` is computed at most: it is of the third order in the step, and so is the factor of its convergence.
    const PASSES: u32 = 60;
    /// A change of `kappa` by so little changes the energy by less than its rounding.
    const SETTLED: f64 = f64::EPSILON / 8.0;
    /// The energy may miss the work by so many roundings; more is an error.
    const ROUNDINGS: f64 = 1024.0;

    /// The method for that assembly, whose pattern it finds and whose memory it keeps.
    ///
    /// # Errors
    /// [`AssemblyError::Factorisation`] where the memory does not suffice.
    pub fn new(assembly: &Assembly, solver: Solver) -> Result<Self, AssemblyError> {
        let frames = Frames::of(assembly);
        let rows = frames.parts.last().map_or(0, |part| part.row + part.rows);
        let (quasi, all) = (|| vec![0.0; frames.quasi], || vec![0.0; assembly.coordinates()]);
        let mut system = Sparse::new(frames.quasi, rows, frames.parts.clone(), solver)?;
        system.polishes = true;
        let masses = frames.bodies.last().map_or(0, |body| body.masses().end);
        Ok(Self {
            settling: AssemblySettling::new(frames.quasi, rows),
            start: vec![0.0; frames.room],
            system,
            projection: Sparse::new(frames.quasi, rows, frames.parts.clone(), solver)?,
            rule: Average::new(),
            mass: vec![0.0; masses],
            unused: vec![0.0; masses],
            xi0: quasi(),
            x: quasi(),
            xi1: quasi(),
            momenta: quasi(),
            impulses: vec![0.0; rows],
            path: MeanPath::of(assembly, &frames),
            end: vec![0.0; frames.room],
            q0: all(),
            v0: all(),
            v1: all(),
            frames,
        })
    }

    /// Quasi-velocities and masses at the start; refuses what cannot keep the energy.
    fn begin(&mut self, assembly: &Assembly, (t0, h): (f64, f64), state: &AssemblyState) -> Result<(), AssemblyError> {
        for i in 0..state.len() {
            (self.q0[i], self.v0[i]) = (state.q(i), state.v(i));
        }
        let Self { frames, mass, xi0, q0, v0, .. } = self;
        let mut bodies = frames.bodies.iter();
        for (k, placed) in assembly.placed().iter().enumerate() {
            let element = &placed.element;
            // The time is not one that a period of the system is likely to share with the step.
            at(placed, q0, v0, |q, v| element.keeps_energy(t0 + 0.381_966 * h, q, v))?;
            if frames.is_body(k) {
                let Some(body) = bodies.next() else { continue };
                let (xi, mass) = (&mut xi0[body.quasi_velocities()], &mut mass[body.masses()]);
                at(placed, q0, v0, |q, v| element.rest(t0, q, v, xi, mass))?;
            } else if element.acts() && at(placed, q0, v0, |q, v| element.has_inertia(t0, q, v)) {
                return Err(AssemblyError::Unsupported { reason: INERTIA });
            }
        }
        Ok(())
    }

    /// The mean quasi-velocities to begin with, those of the mean velocities that the last steps let expect.
    fn guess(&mut self, assembly: &Assembly, (t0, h): (f64, f64), state: &AssemblyState) -> Result<(), AssemblyError> {
        let Self { frames, x, path: MeanPath { v, q1: middle, .. }, q0, v0, unused, .. } = self;
        predict(state, h, v0, v);
        for (middle, (q0, v)) in middle.iter_mut().zip(q0.iter().zip(&*v)) {
            *middle = q0 + 0.5 * h * v;
        }
        for body in &frames.bodies {
            let element = &assembly.placed()[body.element].element;
            let (q, v, x) = (&middle[body.coordinates()], &v[body.coordinates()], &mut x[body.quasi_velocities()]);
            element.rest(t0 + 0.5 * h, q, v, x, &mut unused[body.masses()])?;
        }
        Ok(())
    }

    /// The quasi-velocities at the end, `xi1 = 2 x - xi0 - 2 e`; returns the `kappa` that `x` and they ask for.
    fn finish(&mut self, assembly: &Assembly, t1: f64, near: bool) -> Result<f64, AssemblyError> {
        let Self { frames, projection, mass, xi0, x, xi1, momenta, path, end, v1, .. } = self;
        for body in &frames.bodies {
            let element = &assembly.placed()[body.element].element;
            let (q1, frame) = (&path.q1[body.coordinates()], &mut end[body.frames()]);
            element.frame(t1, q1, frame).ok_or(NO_BASIS)?;
        }
        for ((xi1, x), xi0) in xi1.iter_mut().zip(&*x).zip(&*xi0) {
            *xi1 = 2.0 * x - xi0;
        }
        frames.combine(end, xi1, v1);
        if !projection.has_rows() {
            return Ok(0.0);
        }
        path.project(assembly, frames, (projection, near), (t1, mass), (end, v1))?;
        let correction = &projection.linear.solution[..xi1.len()];
        for (xi1, d) in xi1.iter_mut().zip(correction) {
            *xi1 += d;
        }
        let difference = |i: usize| xi1[i] - xi0[i];
        frames.momenta(mass, &difference, momenta);
        let against: f64 = momenta.iter().zip(correction).map(|(p, d)| -0.5 * d * p).sum();
        frames.momenta(mass, &|i| x[i], momenta);
        let twice_kinetic: f64 = momenta.iter().zip(&*x).map(|(p, x)| p * x).sum();
        frames.combine(end, xi1, v1);
        Ok(if twice_kinetic > 0.0 { against / twice_kinetic } else { 0.0 })
    }

    /// By how much the constraint turns that turns most (rad).
    fn turn(&self, assembly: &Assembly, step: (f64, f64)) -> f64 {
        let turn = |placed: &PlacedElement| at(placed, &self.q0, &self.path.v, |q, v| placed.element.turn(step, q, v));
        assembly.placed().iter().map(turn).fold(0.0, larger)
    }

    /// Checks that the energy has changed by the work of the forces.
    fn check(&self, assembly: &Assembly, (t0, h): (f64, f64), work: f64) -> Result<(), AssemblyError> {
        let (mut defect, mut size) = (-work, 0.0);
        for placed in assembly.placed() {
            let before = at(placed, &self.q0, &self.v0, |q, v| placed.element.energies(t0, q, v));
            let after = at(placed, &self.path.q1, &self.v1, |q, v| placed.element.energies(t0 + h, q, v));
            defect += after[0] - before[0];
            size += after[1].max(before[1]);
        }
        let bound = Self::ROUNDINGS * f64::EPSILON * size;
        if defect.abs() <= bound { Ok(()) } else { self.check_at_rest(assembly, (t0, h), (defect, bound)) }
    }

    /// The same where the terms of the energy cancel, or where the motion is as small as the round-off of the place, as in the static
    /// methods.
    #[cold]
    fn check_at_rest(
        &self,
        assembly: &Assembly,
        (t0, h): (f64, f64),
        (defect, bound): (f64, f64),
    ) -> Result<(), AssemblyError> {
        let mut noise = 0.0;
        terms::for_each(
            assembly,
            (t0, h),
            |i| self.q0[i],
            |i| self.v0[i],
            |_, placed, momentum, _| {
                for (i, size) in placed.at.iter().zip(momentum) {
                    let way = (self.path.q1[*i] - self.q0[*i]).abs();
                    noise += f64::EPSILON * size / h.abs() * (way + f64::EPSILON * self.q0[*i].abs());
                }
            },
        );
        let bound = bound + Self::ROUNDINGS * noise + f64::MIN_POSITIVE;
        if defect.abs() <= bound { Ok(()) } else { Err(AssemblyError::Energy { defect, bound }) }
    }
}

const INERTIA: &str = "energy2 of assemblies needs parts whose inertia is in coordinates of their own";

impl AssemblyMethod for SparseEnergy {
    fn step(
        &mut self,
        assembly: &Assembly,
        t0: f64,
        h: f64,
        state: &mut AssemblyState,
    ) -> Result<AssemblyReport, AssemblyError> {
        self.begin(assembly, (t0, h), state)?;
        self.settling.near = rounding_of_place(&self.q0, h);
        /// Ends whose `kappa` differ by no more are near each other.
        const NEAR_ENDS: f64 = 1e-5;
        let (mut kappa, mut iterations, mut near) = (0.0, 0, false);
        self.guess(assembly, (t0, h), state)?;
        self.impulses.fill(0.0);
        let mut convergence = FixedPoint::<1, 1>::new(Self::PASSES).to(Self::SETTLED);
        let (mut first, mut done) = (true, false);
        let work = loop {
            let Self { frames, system, settling, rule, mass, xi0, x, impulses, path, start, q0, v0, .. } = self;
            system.factors_serve = near;
            let mut mean = SparseMeanEquations {
                assembly,
                frames,
                rule,
                step: (t0, h),
                state,
                mass,
                xi0,
                q0,
                kappa,
                path,
                work: 0.0,
            };
            let evaluate = |system: &mut Sparse, x: &[f64], impulses: &[f64], fresh: bool| {
                mean.evaluate(system, x, impulses, fresh)
            };
            let terms = |sizes: &mut [f64]| frames.add_terms(assembly, (t0, h), (q0, v0), start, sizes);
            iterations += system.newton((settling, Stage::Collocation), x, impulses, terms, evaluate)?;
            let work = mean.work;
            if first && !settling.certain {
                return Err(AssemblyError::Branch { turn: self.turn(assembly, (t0, h)) });
            }
            self.path.end(&self.frames, (assembly, t0, h), (&self.q0, state), &self.x)?;
            let change = self.finish(assembly, t0 + h, near)? - kappa;
            // The factor of `M x` is `2 - kappa`.
            // A change above rounding is still made, although it is the last.
            if done || change.abs() <= Self::SETTLED {
                break work;
            }
            let settled = convergence.see([[(change.abs(), 1.0)]], 0.0, || [[0.0]]);
            done = settled.map_err(|source| AssemblyError::Newton { stage: Stage::Collocation, source })?.is_some();
            kappa += change;
            near = change.abs() <= NEAR_ENDS;
            first = false;
        };
        let turn = self.turn(assembly, (t0, h));
        if turn > NEAR {
            return Err(AssemblyError::Branch { turn });
        }
        if !self.path.q1.iter().chain(&self.v1).all(|x| x.is_finite()) {
            return Err(AssemblyError::NotFinite);
        }
        self.check(assembly, (t0, h), work)?;
        for i in 0..state.len() {
            let (v, v1) = (self.path.v[i], self.v1[i]);
            state.advance(h, i, h * v, v1, (v1 - v) / (0.5 * h));
        }
        Ok(AssemblyReport { iterations, work: Some(work) })
    }
}
