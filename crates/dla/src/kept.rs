use crate::State;
use crate::derivatives::{COORDINATES, StepDerivatives, UnknownsRow, counted, switch};
use crate::past::Past;
use crate::settle::LEAST;
use crate::unknowns::Unknowns;
use lagrangian::{AdmissibleBasis, from_fn, mapped};

/// Predictors and frozen Jacobians that a step of the general form takes over from the steps before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kept {
    /// Whether the next step may be a predicted one.
    ready: bool,
    /// The number of steps without a prediction, now and after the next failure.
    pause: u32,
    next_pause: u32,
    /// The formulation of predicted steps.
    unknowns: Unknowns,
    /// The frozen Jacobian `h D1 D2 L_d`, with the derivatives of the forces; `W(q0)' h D1 D2 L_d W` in the basis.
    pub(crate) block: StepDerivatives,
    /// The frozen mass matrix; `W' M W` in the basis.
    pub(crate) mass: StepDerivatives,
    /// Predictor of the velocity at the end, in coordinates.
    pub(crate) velocities: Past<COORDINATES>,
    /// Predictors in the basis: of the mean velocity, of the mean quasi-velocities, and of the quasi-velocities at the end.
    pub(crate) ways: Past<COORDINATES, MORE>,
    pub(crate) means: Past<COORDINATES, MORE>,
    pub(crate) ends: Past<COORDINATES, MORE>,
    /// The state at the end of the last step.
    q: UnknownsRow,
    v: UnknownsRow,
}

/// The bases of admissible velocities at the beginning of a step, for its mean velocity, and at its end.
pub(crate) type Bases<const N: usize, const M: usize> = [AdmissibleBasis<f64, N, M>; 3];

/// `h D1 D2 L_d`, with the derivatives of the forces, and the mass matrix.
pub(crate) type Matrices<const N: usize> = ([[f64; N]; N], [[f64; N]; N]);

/// Predictors in the basis are of order 9. Velocities in coordinates turn with a body, so the mean velocity needs more orders there; and
/// the number of iterations depends on its error.
const MORE: usize = 9;

impl Kept {
    /// Before the first step.
    pub(crate) const NONE: Self = Self {
        ready: false,
        pause: 0,
        next_pause: 1,
        unknowns: Unknowns::UNDECIDED,
        block: StepDerivatives::NONE,
        mass: StepDerivatives::NONE,
        velocities: Past::new(),
        ways: Past::new(),
        means: Past::new(),
        ends: Past::new(),
        q: [0.0; COORDINATES],
        v: [0.0; COORDINATES],
    };

    /// Forgets all unless the last step ended in this state: a run must not depend on what its method was used for before.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only the very same state goes on")]
    pub(crate) fn follows<const N: usize>(&mut self, state: &State<N>) {
        let (q, v) = (&self.q, if self.unknowns.in_basis { self.v } else { self.velocities.last() });
        let mut same = N <= COORDINATES;
        for i in 0..N.min(COORDINATES) {
            same &= (q[i] == state.q()[i]) & (v[i] == state.v()[i]);
        }
        if !same {
            (self.ready, self.pause, self.next_pause, self.unknowns) = (false, 0, 1, Unknowns::UNDECIDED);
        }
    }

    /// Whether the next step may be a predicted one.
    #[inline(always)]
    pub(crate) fn is_ready(&self) -> bool {
        self.ready
    }

    /// Whether predicted steps are solved in the basis of admissible velocities.
    #[inline(always)]
    pub(crate) fn is_in_basis(&self) -> bool {
        self.unknowns.in_basis
    }

    /// Whether the next step made without memory is to give its Jacobians in the basis.
    pub(crate) fn wants_basis(&self) -> bool {
        self.unknowns.wanted
    }

    /// Records a step of length `h` that was made without memory, and ended at `q` with the velocity `v`. The next step may be a predicted
    /// one if the Jacobian and the mass matrix of this step are given; it is solved in the basis if the bases are given too.
    #[inline(never)]
    pub(crate) fn begins<const N: usize, const M: usize>(
        &mut self,
        matrices: Option<Matrices<N>>,
        basis: Option<Bases<N, M>>,
        h: f64,
        (q, v): (&[f64; N], &[f64; N]),
        mean: &[f64; N],
    ) {
        if N > COORDINATES || M > COORDINATES {
            return;
        }
        let given = matrices.filter(|_| self.pause == 0);
        self.pause = self.pause.saturating_sub(1);
        self.block.forget();
        self.mass.forget();
        self.unknowns.begin(basis.is_some());
        self.velocities.forget();
        for past in [&mut self.ways, &mut self.means, &mut self.ends] {
            past.forget();
        }
        let (mut node, mut middle) = (*v, *mean);
        self.ready = given.is_some_and(|(mut block, mut mass)| {
            if let Some([start, middle_of_step, end]) = &basis {
                // The quasi-velocities of `v = W xi`: `(W0' K W) xi = W0' K v`.
                node = end.products(&image(&mass, v));
                middle = start.products(&image(&block, mean));
                block = in_bases(&block, start, middle_of_step);
                mass = in_bases(&mass, end, end);
            }
            // The next step has nearly the same Jacobians; fresh ones would hardly save a correction.
            let renewed = self.block.renew(&block).and(self.mass.renew(&mass));
            self.block.took::<N>(LEAST);
            self.mass.took::<N>(LEAST);
            if basis.is_some() {
                let dimension = AdmissibleBasis::<f64, N, M>::DIMENSION;
                node = self.mass.times_first(dimension, &node);
                middle = self.block.times_first(dimension, &middle);
            }
            renewed.is_some()
        });
        self.velocities.push(h, &row(v));
        if basis.is_some() {
            self.ended_in_basis(h, (q, v), mean, [&middle, &node]);
        }
        self.q = row(q);
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

    /// As [`Self::ended`], in the basis: with the mean velocity `way`, its quasi-velocities, and the quasi-velocities at the end.
    #[inline(always)]
    pub(crate) fn ended_in_basis<const N: usize>(
        &mut self,
        h: f64,
        (q, v): (&[f64; N], &[f64; N]),
        way: &[f64; N],
        [mean, end]: [&[f64; N]; 2],
    ) {
        self.ways.push(h, &row(way));
        self.means.push(h, &row(mean));
        self.ends.push(h, &row(end));
        (self.q, self.v) = (row(q), row(v));
    }

    /// Records that a predicted step succeeded.
    #[inline(always)]
    pub(crate) fn succeeds(&mut self) {
        self.next_pause = 1;
        // While predictors have few steps, corrections are large and say nothing of the formulation.
        if !self.unknowns.decided
            && if self.unknowns.in_basis { self.ends.is_full() } else { self.velocities.is_full() }
        {
            self.ready = !self.unknowns.are_to_change(self.block.stale);
        }
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
        let Self { ready, pause, next_pause, unknowns, block, mass, velocities, ways, means, ends, q, v } = self;
        for derivatives in [block, mass] {
            derivatives.visit(&mut visit);
        }
        for number in [pause, next_pause] {
            counted(number, &mut visit);
        }
        switch(ready, &mut visit);
        unknowns.visit(&mut visit);
        velocities.visit(&mut visit);
        for past in [ways, means, ends] {
            past.visit(&mut visit);
        }
        for row in [q, v] {
            row.iter_mut().for_each(&mut visit);
        }
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

/// `K x`.
fn image<const N: usize>(matrix: &[[f64; N]; N], x: &[f64; N]) -> [f64; N] {
    mapped(matrix, |row| (0..N).map(|j| row[j] * x[j]).sum())
}

/// `V' K W`, and ones on the diagonal beyond the dimension of the bases.
pub(crate) fn in_bases<const N: usize, const M: usize>(
    matrix: &[[f64; N]; N],
    v: &AdmissibleBasis<f64, N, M>,
    w: &AdmissibleBasis<f64, N, M>,
) -> [[f64; N]; N] {
    let mut reduced = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
    for (j, w) in w.vectors().iter().enumerate() {
        let column = v.products(&image(matrix, w));
        for i in 0..AdmissibleBasis::<f64, N, M>::DIMENSION {
            reduced[i][j] = column[i];
        }
    }
    reduced
}
