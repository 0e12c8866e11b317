use dla::SeededMechanics;
use lagrangian::{Gradients, Scalar, Seeded, from_fn};
use nalgebra::DMatrix;

/// `q' = W xi + v_b` and `xi'`.
pub(super) type Slope<const N: usize> = [[Seeded; N]; 2];

/// The reduced equations with derivatives in eight directions; an object, so that what uses it is compiled once.
pub(super) trait ReducedFlow<const N: usize, const M: usize> {
    /// The slopes at a point; none where the system has no basis, or its equations are degenerate.
    fn slope(&self, t: f64, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<Slope<N>>;
}

/// The reduced equations of a system: by hand where it knows them, else from its Lagrangian.
#[derive(Debug)]
pub(super) struct Flow<'a, const N: usize, const M: usize>(pub(super) &'a dyn SeededMechanics<N, M>);

impl<const N: usize, const M: usize> ReducedFlow<N, M> for Flow<'_, N, M> {
    fn slope(&self, t: f64, q: &[Seeded; N], xi: &[Seeded; N]) -> Option<Slope<N>> {
        let t = Seeded::constant(t);
        let velocity = self.0.velocity_seeded(t, q, xi)?;
        let rate = match self.0.reduced_motion_seeded(t, q, xi) {
            Some(rate) => from_fn(|a| if a < N - M { rate[a] } else { Seeded::zero() }),
            None => implicit(&*self.0.gradients(), t, q, xi)?,
        };
        Some([velocity, rate])
    }
}

/// The rates `xi'` that solve `w_a . (d/dt L_v - L_q - F) = 0` along `v' = W xi' + (W' xi + v_b')`, in which they are linear.
fn implicit<const N: usize, const M: usize>(
    model: &dyn Gradients<N, M>,
    t: Seeded,
    q: &[Seeded; N],
    xi: &[Seeded; N],
) -> Option<[Seeded; N]> {
    let basis = model.basis(t, q)?;
    let residual = |rate: &[Seeded; N]| -> Option<[Seeded; N]> {
        let (v, acceleration) = model.turned(t, q, xi, rate)?;
        let (forces, _) = model.motion(t, q, &v, &acceleration, &[Seeded::zero(); M]);
        let along = |w: &[Seeded; N]| (0..N).fold(Seeded::zero(), |sum, i| sum + w[i] * forces[i]);
        Some(from_fn(|a| basis.vectors().get(a).map_or(Seeded::zero(), along)))
    };
    let free = residual(&[Seeded::zero(); N])?;
    let mut mass = [[Seeded::zero(); N]; N];
    for b in 0..N - M {
        let unit = from_fn(|a| Seeded::constant(if a == b { 1.0 } else { 0.0 }));
        let moved = residual(&unit)?;
        for a in 0..N - M {
            mass[a][b] = moved[a] - free[a];
        }
    }
    // The reduced mass matrix is symmetric and positive: no pivots are needed.
    let mut rate = free.map(|f| -f);
    for k in 0..N - M {
        for l in k + 1..N - M {
            let factor = mass[l][k] / mass[k][k];
            for m in k..N - M {
                mass[l][m] -= factor * mass[k][m];
            }
            rate[l] -= factor * rate[k];
        }
    }
    for k in (0..N - M).rev() {
        for l in k + 1..N - M {
            rate[k] -= mass[k][l] * rate[l];
        }
        rate[k] = rate[k] / mass[k][k];
    }
    Some(rate)
}

/// The divergence of the reduced equations in the coordinates `(q, xi)` (1/s): the rate at which the flow makes volumes grow, without what
/// it does across the constraints on positions, along their orthonormal normals in the coordinates; and the rates `xi'`.
pub(super) fn divergence<const N: usize, const M: usize>(
    flow: &dyn ReducedFlow<N, M>,
    (variables, normals): (&Variables, Option<&DMatrix<f64>>),
    t: f64,
    q: &[f64; N],
    xi: &[f64; N],
) -> Option<(f64, [f64; N])> {
    let xi = admissible::<N, M>(xi);
    let (mut sum, mut rates) = (0.0, [0.0; N]);
    for block in variables.blocks() {
        let slope = flow.slope(t, &block.seeded(q, 0), &block.seeded(&xi, N))?;
        rates = from_fn(|a| if a < N - M { slope[1][a].re } else { 0.0 });
        // Of each variable the derivative of its own rate.
        sum += block.all().map(|(direction, variable)| entry(&slope, variable).eps[direction]).sum::<f64>();
        let Some(normals) = normals else { continue };
        for (direction, j) in block.all().filter(|(_, variable)| *variable < normals.nrows()) {
            let across = |i: usize| normals.row(i).dot(&normals.row(j));
            sum -= (0..normals.nrows()).map(|i| across(i) * slope[0][i].eps[direction]).sum::<f64>();
        }
    }
    Some((sum, rates))
}

/// The component of a slope, or of an increment, that belongs to a variable.
pub(super) fn entry<const N: usize>([of_q, of_xi]: &Slope<N>, variable: usize) -> &Seeded {
    if variable < N { &of_q[variable] } else { &of_xi[variable - N] }
}

/// The variables of the reduced equations: of `N` coordinates and their quasi-velocities, numbered `N + a`, those that are not there to
/// fill up a shape.
#[derive(Debug, Clone)]
pub(super) struct Variables(Vec<usize>);

/// Some of the variables, no more than there are directions to be seeded in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block<'a> {
    variables: &'a [usize],
    /// The place of the first among all.
    pub(super) first: usize,
}

impl Variables {
    /// Of a shape of `N` coordinates those of `n` coordinates and `m` constraints, which stand first.
    pub(super) fn new<const N: usize>((n, m): (usize, usize)) -> Self {
        Self((0..n.min(N)).chain(N..N + n.saturating_sub(m).min(N)).collect())
    }

    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    /// How many of them are coordinates.
    pub(super) fn coordinates<const N: usize>(&self) -> usize {
        self.0.iter().filter(|variable| **variable < N).count()
    }

    /// The variable in that place.
    pub(super) fn at(&self, place: usize) -> usize {
        self.0[place]
    }

    pub(super) fn blocks(&self) -> impl Iterator<Item = Block<'_>> {
        let parts = self.0.chunks(DIRECTIONS).enumerate();
        parts.map(|(k, variables)| Block { variables, first: k * DIRECTIONS })
    }
}

impl Block<'_> {
    /// The directions with their variables.
    pub(super) fn all(&self) -> impl Iterator<Item = (usize, usize)> {
        self.variables.iter().copied().enumerate()
    }

    /// The variables from `first` on, each seeded in its direction where it is one of these.
    pub(super) fn seeded<const N: usize>(&self, x: &[f64; N], first: usize) -> [Seeded; N] {
        let mut numbers = x.map(Seeded::constant);
        for (direction, variable) in self.all() {
            if let Some(number) = variable.checked_sub(first).and_then(|i| numbers.get_mut(i)) {
                number.eps[direction] = 1.0;
            }
        }
        numbers
    }
}

/// What seeds there are directions for.
const DIRECTIONS: usize = 8;

/// Quasi-velocities with zeros in the places that do not count.
pub(super) fn admissible<const N: usize, const M: usize>(xi: &[f64; N]) -> [f64; N] {
    from_fn(|a| if a < N - M { xi[a] } else { 0.0 })
}
