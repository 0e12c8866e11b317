use crate::HardCaseError;
use dla::{Schedule, State};
use harness::stability::{Claim, Finding, Recorded, Recorder, Trial, VALUES, check, claims};
use harness::{Method, integrate_from};
use scene::{Built, RunSettings, Scene, SceneEffect, Visitor};
use sleigh::{Exact, Sleigh, SleighError, SleighState};

/// What the cases look at in a scene, by its place among the values of a node.
pub(crate) const PLACE: [usize; 2] = [0, 1];
pub(crate) const HEADING: usize = 2;
pub(crate) const SPEED: usize = 3;
pub(crate) const SPIN: usize = 4;
pub(crate) const ROTOR: usize = 5;
/// All of the sleigh.
pub(crate) const MOTION: [usize; 5] = [0, 1, 2, 3, 4];

/// A run to be made in a case.
#[derive(Debug, Clone)]
pub(crate) struct Setup {
    /// Mass (kg), inertia (kg m^2), offset (m).
    pub(crate) body: [f64; 3],
    pub(crate) start: SleighState,
    pub(crate) effects: Vec<SceneEffect>,
    pub(crate) step: f64,
    pub(crate) steps: u64,
    /// Steps that are taken to have been made before.
    pub(crate) from: u64,
    /// Every how many nodes are looked at.
    pub(crate) every: u64,
    /// Whether the run turns round at its end and goes back.
    pub(crate) back: bool,
}

impl Setup {
    /// The sleigh of the scenes, with this speed (m/s) and spin (rad/s), and nothing acting on it.
    pub(crate) fn new(speed: f64, turn_rate: f64, step: f64, duration: f64) -> Self {
        let start = SleighState { speed, turn_rate, ..SleighState::default() };
        let steps = (duration / step).round().max(1.0) as u64;
        Self { body: [1.0, 1.0, 0.5], start, effects: Vec::new(), step, steps, from: 0, every: 1, back: false }
    }

    pub(crate) fn with(mut self, effect: SceneEffect) -> Self {
        self.effects.push(effect);
        self
    }

    pub(crate) fn duration(&self) -> f64 {
        self.steps as f64 * self.step
    }

    pub(crate) fn sleigh(&self) -> Result<Sleigh, SleighError> {
        let [mass, inertia, offset] = self.body;
        Sleigh::new(mass, inertia, offset)
    }

    /// `kappa = U m a/J` (1/s), the rate at which a spin grows or dies out on a straight line; and `U/k`, the spin that
    /// would have all the energy (rad/s).
    pub(crate) fn rates(&self) -> Result<[f64; 2], SleighError> {
        let (sleigh, SleighState { speed, turn_rate, .. }) = (self.sleigh()?, self.start);
        let gyration = (sleigh.pivot_inertia() / sleigh.mass()).sqrt();
        let all = speed.hypot(gyration * turn_rate);
        Ok([(all * sleigh.spin_gain()).abs(), all / gyration])
    }

    pub(crate) fn exact(&self) -> Result<Exact, SleighError> {
        Exact::new(&self.sleigh()?, &self.start)
    }

    fn scene(&self) -> Result<Scene, SleighError> {
        Ok(Scene {
            name: String::new(),
            title: String::new(),
            sleigh: self.sleigh()?,
            start: self.start,
            run: RunSettings {
                method: String::new(),
                alpha: None,
                tolerance: None,
                step: self.step,
                duration: self.duration(),
            },
            effects: self.effects.clone(),
        })
    }
}

/// A method on the bench: makes the runs of a case and keeps what they showed.
#[derive(Debug)]
pub(crate) struct Lab {
    pub(crate) method: Method,
    pub(crate) trials: Vec<Trial>,
}

impl Lab {
    pub(crate) fn new(method: Method) -> Self {
        Self { method, trials: Vec::new() }
    }

    /// The order that the method has where the motion is smooth.
    pub(crate) fn order(&self) -> u32 {
        self.method.info().order
    }

    /// Whether its error is a tolerance instead of an order.
    pub(crate) fn is_adaptive(&self) -> bool {
        self.method.is_adaptive()
    }

    /// What a relative error may be: of the method over `length` time constants, with steps of `part` of one, and of
    /// rounding over so many steps.
    pub(crate) fn accuracy(&self, part: f64, length: f64, steps: u64) -> f64 {
        // An adaptive method has no error of its step, but its tolerance in each.
        let own = if self.is_adaptive() {
            Method::TOLERANCE * steps as f64
        } else {
            check::truncation(self.order(), part, length)
        };
        own + check::rounding(steps as usize, 1.0)
    }

    /// The constraint at the nodes, of a method that claims it.
    pub(crate) fn constraint(&self, run: &Recorded, speed: f64) -> Option<Finding> {
        let claimed = claims(self.method.info().kind, Claim::Constraint).is_ok();
        claimed.then(|| check::constraint(run, speed))
    }

    /// Makes a run without judging it.
    pub(crate) fn record(&self, setup: &Setup) -> Result<Recorded, HardCaseError> {
        Ok(setup.scene()?.visit(LabRecord { method: &self.method, setup })?)
    }

    /// Makes a run, and keeps what `check` finds in it.
    pub(crate) fn run<I: IntoIterator<Item = Finding>>(
        &mut self,
        label: impl Into<String>,
        setup: &Setup,
        check: impl FnOnce(&Recorded) -> I,
    ) -> Result<(), HardCaseError> {
        let run = self.record(setup)?;
        self.judge(label, &run, check(&run));
        Ok(())
    }

    /// Keeps what was found in a run.
    pub(crate) fn judge(&mut self, label: impl Into<String>, run: &Recorded, found: impl IntoIterator<Item = Finding>) {
        let mut trial = Trial::new(label, run);
        trial.add(found);
        self.trials.push(trial);
    }
}

struct LabRecord<'a> {
    method: &'a Method,
    setup: &'a Setup,
}

impl Visitor for LabRecord<'_> {
    type Output = Recorded;

    fn visit<const N: usize, const M: usize>(self, system: Built<'_, N, M>, q: [f64; N], v: [f64; N]) -> Recorded {
        let Self { method, setup } = self;
        // After place and heading are speed and turn rate.
        let rotor = system.named("rotor_rate");
        let look = |state: &State<N>| -> [f64; VALUES] {
            // The velocities in the angles that the method sees, the place with all its turns.
            let now = |k: usize| system.value(k, 0.0, state.q(), state.v());
            let [x, y, heading] = [0, 1, 2].map(|i| state.unwrapped()[i]);
            [x, y, heading, now(3), now(4), rotor.map_or(0.0, now)]
        };
        let mut state = State::new(q, v, system.angles());
        let mut recorder = Recorder::new(setup.every, &look);
        let end = setup.from + setup.steps;
        let schedule = Schedule { t0: 0.0, step: setup.step, steps: end };
        let mut outcome = integrate_from(setup.from, (&system).into(), method, &schedule, &mut state, &mut recorder);
        if setup.back && outcome.is_ok() {
            state = state.reversed();
            // As a part of the same run: at the beginning of another a slip would be taken from the velocity.
            let back = Schedule { steps: 2 * end, ..schedule };
            outcome = integrate_from(end, (&system).into(), method, &back, &mut state, &mut recorder);
        }
        recorder.recorded(outcome.err())
    }
}
