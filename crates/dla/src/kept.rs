use crate::State;
use crate::derivatives::{COORDINATES, Derivatives, Row, counted, switch};
use crate::past::Past;
use crate::settle::LEAST;

/// What a step of the general form remembers of those before it, with which the search of the next one begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kept {
    /// Whether the next step may go on from the last.
    ready: bool,
    /// For how many steps it is not to be tried, and for how many where it fails again.
    pause: u32,
    next_pause: u32,
    /// Of `h D1 D2 L_d`, with the derivatives of the forces.
    pub(crate) block: Derivatives,
    /// Of the mass matrix.
    pub(crate) mass: Derivatives,
    /// The velocities at the last nodes.
    pub(crate) velocities: Past<COORDINATES>,
    /// Where the last step ended.
    q: Row,
}

/// `h D1 D2 L_d`, with the derivatives of the forces, and the mass matrix.
pub(crate) type Matrices<const N: usize> = ([[f64; N]; N], [[f64; N]; N]);

impl Kept {
    /// Of no step.
    pub(crate) const NONE: Self = Self {
        ready: false,
        pause: 0,
        next_pause: 1,
        block: Derivatives::NONE,
        mass: Derivatives::NONE,
        velocities: Past::new(),
        q: [0.0; COORDINATES],
    };

    /// Forgets all unless the last step ended in this state: what begins anew is to be the same whatever was before.
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

    /// Whether the next step may go on from the last.
    #[inline(always)]
    pub(crate) fn is_ready(&self) -> bool {
        self.ready
    }

    /// That a step of length `h` has ended at `q` with the velocity `v` and did not go on from one before; the next may, where its
    /// derivatives and mass matrix are given.
    #[inline(never)]
    pub(crate) fn begins<const N: usize, const M: usize>(
        &mut self,
        matrices: Option<Matrices<N>>,
        h: f64,
        q: &[f64; N],
        v: &[f64; N],
    ) {
        if N > COORDINATES || M > COORDINATES {
            return;
        }
        let given = matrices.filter(|_| self.pause == 0);
        self.pause = self.pause.saturating_sub(1);
        self.block.forget();
        self.mass.forget();
        self.ready = given.is_some_and(|(block, mass)| {
            // They are near enough to those of the next step, whose own search would hardly have taken more.
            let renewed = self.block.renew(&block).and(self.mass.renew(&mass));
            self.block.took::<N>(LEAST);
            self.mass.took::<N>(LEAST);
            renewed.is_some()
        });
        self.velocities.forget();
        self.ended(h, q, v);
    }

    /// That a step could not go on from the last.
    #[cold]
    pub(crate) fn fails(&mut self) {
        /// It is tried again after as many steps at most.
        const LONGEST: u32 = 64;
        (self.ready, self.pause) = (false, self.next_pause);
        self.next_pause = LONGEST.min(self.next_pause.saturating_mul(2));
    }

    /// That a step of length `h` that went on from the last has ended at `q` with the velocity `v`.
    #[inline(always)]
    pub(crate) fn ended<const N: usize>(&mut self, h: f64, q: &[f64; N], v: &[f64; N]) {
        let mut row = [0.0; COORDINATES];
        for i in 0..N {
            (self.q[i], row[i]) = (q[i], v[i]);
        }
        self.velocities.push(h, &row);
    }

    /// That a step went on from the last.
    #[inline(always)]
    pub(crate) fn succeeds(&mut self) {
        self.next_pause = 1;
    }

    /// All of it as numbers; none of no step.
    pub(crate) fn save(&self) -> Vec<f64> {
        if *self == Self::NONE {
            return Vec::new();
        }
        let mut numbers = Vec::new();
        let mut copy = *self;
        copy.visit(|x| numbers.push(*x));
        numbers
    }

    /// From what [`save`](Self::save) gave; of no step from anything else.
    pub(crate) fn load(numbers: &[f64]) -> Self {
        let mut kept = Self::NONE;
        let (mut numbers, mut filled) = (numbers.iter(), true);
        kept.visit(|x| match numbers.next() {
            Some(number) => *x = *number,
            None => filled = false,
        });
        if filled { kept } else { Self::NONE }
    }

    /// Every number of it, in a fixed order.
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
        q.iter_mut().for_each(visit);
    }
}
