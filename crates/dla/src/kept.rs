use crate::State;
use crate::past::Past;
use lagrangian::linear::{Inverse, Singular};
use std::array::from_fn;

/// Systems of more coordinates or constraints are not remembered.
const COORDINATES: usize = 8;

type Row = [f64; COORDINATES];

/// The inverse of a matrix of derivatives, by columns, which serves several steps.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub(crate) struct Derivatives {
    columns: [Row; COORDINATES],
    /// Whether it is time for new ones.
    pub(crate) stale: bool,
    /// The corrections that the first search with them took, and how many more all took after it.
    least: u32,
    more: u32,
    /// How many they were.
    searches: u32,
    /// For how many searches each is to have its own.
    own: u32,
}

impl Derivatives {
    const NONE: Self = Self { columns: [[0.0; COORDINATES]; COORDINATES], stale: true, least: 0, more: 0, searches: 0, own: 0 };

    /// New ones, given by rows.
    ///
    /// # Errors
    /// [`Singular`] where they have no inverse.
    #[inline(never)]
    pub(crate) fn renew<const N: usize>(&mut self, matrix: &[[f64; N]; N]) -> Result<(), Singular> {
        let inverse = Inverse::new(matrix)?;
        for (j, column) in self.columns.iter_mut().take(N).enumerate() {
            let unit = from_fn(|i| f64::from(u8::from(i == j)));
            column[..N].copy_from_slice(&inverse.solve(&unit));
        }
        (self.stale, self.more, self.searches) = (false, 0, 0);
        Ok(())
    }

    /// The product of the inverse with a vector.
    #[inline(always)]
    pub(crate) fn times<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        if N <= 4 { self.times_of::<N, N>(x) } else { self.times_of::<N, COORDINATES>(x) }
    }

    /// The same by columns of `W` places: beyond four whole registers are quicker.
    #[inline(always)]
    fn times_of<const N: usize, const W: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let mut sum = [0.0; W];
        for (column, x) in self.columns.iter().zip(x) {
            for i in 0..W {
                sum[i] += column[i] * x;
            }
        }
        from_fn(|i| sum[i])
    }

    /// That a search with them took so many corrections. They are to be renewed where they have cost more than that.
    #[inline(always)]
    pub(crate) fn took<const N: usize>(&mut self, corrections: u32) {
        /// So many searches in a row have their own where a second one is not worth it.
        const OWN: u32 = 16;
        // About as many corrections take the time of new derivatives.
        let price = const { (N * N * N).div_ceil(27) as u32 };
        self.searches = self.searches.saturating_add(1);
        if self.searches == 1 {
            self.least = corrections;
            self.stale = self.own > 0;
            self.own = self.own.saturating_sub(1);
            return;
        }
        self.more = self.more.saturating_add(corrections.saturating_sub(self.least));
        self.stale = self.more >= price;
        if self.stale && self.searches == 2 {
            self.own = OWN;
        }
    }
}

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
    /// Whether it is the same everywhere.
    pub(crate) constant: bool,
    /// The velocities at the last nodes.
    pub(crate) velocities: Past<COORDINATES>,
    /// Where the last step ended, how fast, with what momenta, and the rows of the constraint there.
    q: Row,
    v: Row,
    p: Row,
    rows: [Row; COORDINATES],
}

impl Kept {
    /// Of no step.
    pub(crate) const NONE: Self = Self {
        ready: false,
        pause: 0,
        next_pause: 1,
        block: Derivatives::NONE,
        mass: Derivatives::NONE,
        constant: false,
        velocities: Past::new(),
        q: [0.0; COORDINATES],
        v: [0.0; COORDINATES],
        p: [0.0; COORDINATES],
        rows: [[0.0; COORDINATES]; COORDINATES],
    };

    /// Whether a step that has ended otherwise is one that the next may go on from.
    #[inline(always)]
    pub(crate) fn begins<const N: usize, const M: usize>(&mut self, possible: bool) -> bool {
        self.ready = false;
        if self.pause > 0 {
            self.pause -= 1;
            return false;
        }
        possible && N <= COORDINATES && M <= COORDINATES
    }

    /// The next step may go on.
    pub(crate) fn begin(&mut self, constant: bool) {
        (self.ready, self.constant) = (true, constant);
        (self.block.stale, self.mass.stale) = (true, true);
    }

    /// That a step could not go on from the last.
    #[cold]
    pub(crate) fn fails(&mut self) {
        /// It is tried again after as many steps at most.
        const LONGEST: u32 = 64;
        (self.ready, self.pause) = (false, self.next_pause);
        self.next_pause = LONGEST.min(self.next_pause.saturating_mul(2));
    }

    /// That a step of length `h` has ended in the state, with momenta and rows of the constraint.
    #[inline(always)]
    pub(crate) fn ended<const N: usize, const M: usize>(
        &mut self,
        h: f64,
        state: &State<N>,
        p: &[f64; N],
        rows: &[[f64; N]; M],
    ) {
        self.q[..N].copy_from_slice(state.q());
        self.v[..N].copy_from_slice(state.v());
        self.p[..N].copy_from_slice(p);
        for k in 0..M {
            self.rows[k][..N].copy_from_slice(&rows[k]);
        }
        if !self.constant {
            self.velocities.push(h, &self.v);
        }
    }

    /// That a step went on from the last.
    #[inline(always)]
    pub(crate) fn succeeds(&mut self) {
        self.next_pause = 1;
    }

    /// The momenta and the rows of the constraint where the last step ended, if that is this state and the next may go on.
    #[inline(always)]
    #[allow(clippy::float_cmp, reason = "only the very same state goes on")]
    pub(crate) fn goes_on<const N: usize, const M: usize>(&self, state: &State<N>) -> Option<([f64; N], [[f64; N]; M])> {
        if N > COORDINATES || M > COORDINATES || !self.ready {
            return None;
        }
        let same = self.q[..N] == state.q()[..] && self.v[..N] == state.v()[..];
        same.then(|| (from_fn(|i| self.p[i]), from_fn(|k| from_fn(|i| self.rows[k][i]))))
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
        let Self { ready, pause, next_pause, block, mass, constant, velocities, q, v, p, rows } = self;
        for derivatives in [block, mass] {
            let Derivatives { columns, stale, least, more, searches, own } = derivatives;
            columns.as_flattened_mut().iter_mut().for_each(&mut visit);
            switch(stale, &mut visit);
            for count in [least, more, searches, own] {
                counted(count, &mut visit);
            }
        }
        for number in [pause, next_pause] {
            counted(number, &mut visit);
        }
        for flag in [ready, constant] {
            switch(flag, &mut visit);
        }
        velocities.visit(&mut visit);
        for row in [q, v, p].into_iter().chain(rows) {
            row.iter_mut().for_each(&mut visit);
        }
    }
}

fn counted(count: &mut u32, visit: &mut impl FnMut(&mut f64)) {
    let mut number = f64::from(*count);
    visit(&mut number);
    // What is no count becomes one.
    *count = number as u32;
}

fn switch(flag: &mut bool, visit: &mut impl FnMut(&mut f64)) {
    let mut number = f64::from(u8::from(*flag));
    visit(&mut number);
    *flag = number != 0.0;
}
