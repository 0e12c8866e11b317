use crate::State;
use crate::derivatives::{COORDINATES, LEAST, StepDerivatives, UnknownsRow, counted, switch};
use crate::past::Past;

/// Predictors and frozen Jacobians that a step of the general form takes over from the steps before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kept {
    /// Whether the next step may be a predicted one.
    ready: bool,
    /// The number of steps without a prediction, now and after the next failure.
    pause: u32,
    next_pause: u32,
    /// The frozen Jacobian `h D1 D2 L_d`, with the derivatives of the forces.
    pub(crate) block: StepDerivatives,
    /// The frozen mass matrix.
    pub(crate) mass: StepDerivatives,
    /// Predictor of the velocity at the end.
    pub(crate) velocities: Past<COORDINATES>,
    /// The configuration at the end of the last step.
    q: UnknownsRow,
}

/// `h D1 D2 L_d`, with the derivatives of the forces, and the mass matrix.
pub(crate) type Matrices<const N: usize> = ([[f64; N]; N], [[f64; N]; N]);

impl Kept {
    /// Before the first step.
    pub(crate) const NONE: Self = Self {
        ready: false,
        pause: 0,
        next_pause: 1,
        block: StepDerivatives::NONE,
        mass: StepDerivatives::NONE,
        velocities: Past::new(),
        q: [0.0; COORDINATES],
    };

    /// Forgets all unless the last step ended in this state: a run must not depend on what its method was used for before.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only the very same state goes on")]
    pub(crate) fn follows<const N: usize>(&mut self, state: &State<N>) {
        let (q, v) = (&self.q, self.velocities.last());
        let mut same = N <= COORDINATES;
        for i in 0..N.min(COORDINATES) {
            same &= (q[i] == state.q()[i]) & (v[i] == state.v()[i]);
        }
        if !same {
            (self.ready, self.pause, self.next_pause) = (false, 0, 1);
        }
    }

    /// Whether the next step may be a predicted one.
    #[inline(always)]
    pub(crate) fn is_ready(&self) -> bool {
        self.ready
    }

    /// Records a step of length `h` that was made without memory, and ended at `q` with the velocity `v`. The next step may be a predicted
    /// one if the Jacobian and the mass matrix of this step are given.
    #[inline(never)]
    pub(crate) fn begins<const N: usize>(
        &mut self,
        matrices: Option<Matrices<N>>,
        h: f64,
        (q, v): (&[f64; N], &[f64; N]),
    ) {
        if N > COORDINATES {
            return;
        }
        let given = matrices.filter(|_| self.pause == 0);
        self.pause = self.pause.saturating_sub(1);
        self.block.forget();
        self.mass.forget();
        self.velocities.forget();
        self.ready = given.is_some_and(|(block, mass)| {
            // The next step has nearly the same Jacobians; fresh ones would hardly save a correction.
            let renewed = self.block.renew(&block).and(self.mass.renew(&mass));
            self.block.took::<N>(LEAST);
            self.mass.took::<N>(LEAST);
            renewed.is_some()
        });
        self.ended(h, q, v);
    }

    /// Records that a predicted step failed.
    #[cold]
    pub(crate) fn fails(&mut self) {
        /// A prediction is tried again after at most this number of steps.
        const LONGEST: u32 = 64;
        (self.ready, self.pause) = (false, self.next_pause);
        self.next_pause = LONGEST.min(self.next_pause.saturating_mul(2));
    }

    /// Records a predicted step of length `h` that ended at `q` with the velocity `v`.
    #[inline(always)]
    pub(crate) fn ended<const N: usize>(&mut self, h: f64, q: &[f64; N], v: &[f64; N]) {
        self.velocities.push(h, &row(v));
        self.q = row(q);
    }

    /// Records that a predicted step succeeded.
    #[inline(always)]
    pub(crate) fn succeeds(&mut self) {
        self.next_pause = 1;
    }

    /// All of it as numbers; an empty list before the first step.
    pub(crate) fn save(&self) -> Vec<f64> {
        if *self == Self::NONE {
            return Vec::new();
        }
        let mut numbers = Vec::new();
        let mut copy = *self;
        copy.visit(|x| numbers.push(*x));
        numbers
    }

    /// Restores the numbers of [`save`](Self::save); any other list gives the memory before the first step.
    pub(crate) fn load(numbers: &[f64]) -> Self {
        let mut kept = Self::NONE;
        let (mut numbers, mut filled) = (numbers.iter(), true);
        kept.visit(|x| match numbers.next() {
            Some(number) => *x = *number,
            None => filled = false,
        });
        if filled { kept } else { Self::NONE }
    }

    /// Visits every number of it, in a fixed order.
    fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        let Self { ready, pause, next_pause, block, mass, velocities, q } = self;
        for derivatives in [block, mass] {
            derivatives.visit(&mut visit);
        }
        for number in [pause, next_pause] {
            counted(number, &mut visit);
        }
        switch(ready, &mut visit);
        velocities.visit(&mut visit);
        q.iter_mut().for_each(&mut visit);
    }
}

#[inline(always)]
fn row<const N: usize>(x: &[f64; N]) -> UnknownsRow {
    let mut row = [0.0; COORDINATES];
    for (place, x) in row.iter_mut().zip(x) {
        *place = *x;
    }
    row
}
