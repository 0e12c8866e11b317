use dla::{Mechanism, Size};
use lagrangian::{Scalar, Seeded};
use nalgebra::DMatrix;

/// The reduced equations in one list, `q' = W xi + v_b` and `xi'`, with derivatives in eight directions; `None` if the system has no basis,
/// or its equations are degenerate.
pub(super) fn slope(system: &dyn Mechanism, t: f64, z: &[Seeded]) -> Option<Vec<Seeded>> {
    let (q, xi) = z.split_at_checked(system.size().n)?;
    system.reduced_flow(t, q, xi).map(|flow| flow.concat())
}

/// The divergence of the reduced equations in the coordinates `(q, xi)` (1/s): the rate at which the flow makes volumes grow, without what
/// it does across the constraints on positions, along their orthonormal normals in the coordinates; and the rates `xi'`.
pub(super) fn divergence(
    system: &dyn Mechanism,
    (variables, normals): (&Variables, Option<&DMatrix<f64>>),
    t: f64,
    (q, xi): (&[f64], &[f64]),
) -> Option<(f64, Vec<f64>)> {
    let Size { n, m } = system.size();
    let z = [q, xi].concat();
    let (mut sum, mut rates) = (0.0, vec![0.0; n]);
    for block in variables.blocks() {
        let slope = slope(system, t, &block.seeded(&z))?;
        rates = admissible(slope.iter().skip(n).map(|rate| rate.re).collect(), n - m);
        // The derivative of each variable's rate in the variable itself.
        sum += block.all().map(|(direction, variable)| slope[variable].eps[direction]).sum::<f64>();
        let Some(normals) = normals else { continue };
        for (direction, j) in block.all().filter(|(_, variable)| *variable < normals.nrows()) {
            let across = |i: usize| normals.row(i).dot(&normals.row(j));
            sum -= (0..normals.nrows()).map(|i| across(i) * slope[i].eps[direction]).sum::<f64>();
        }
    }
    Some((sum, rates))
}

/// The variables of the reduced equations: `N` coordinates and their quasi-velocities, numbered `N + a`, without variables that only fill
/// up a shape.
#[derive(Debug, Clone)]
pub(super) struct Variables {
    numbers: Vec<usize>,
    /// The number of coordinates among them, which stand first.
    pub(super) coordinates: usize,
}

/// Some of the variables, no more than there are directions to be seeded in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block<'a> {
    variables: &'a [usize],
    /// The index of its first variable among all.
    pub(super) first: usize,
}

impl Variables {
    /// The variables of the first coordinates and constraints of a system, in the numbers `own`.
    pub(super) fn new(system: &dyn Mechanism, own: (usize, usize)) -> Self {
        let (coordinates, free) = own_counts(system, own);
        let n = system.size().n;
        Self { numbers: (0..coordinates).chain(n..n + free).collect(), coordinates }
    }

    pub(super) fn numbers(&self) -> &[usize] {
        &self.numbers
    }

    pub(super) fn count(&self) -> usize {
        self.numbers.len()
    }

    pub(super) fn blocks(&self) -> impl Iterator<Item = Block<'_>> {
        let parts = self.numbers.chunks(DIRECTIONS).enumerate();
        parts.map(|(k, variables)| Block { variables, first: k * DIRECTIONS })
    }
}

impl Block<'_> {
    /// The directions with their variables.
    pub(super) fn all(&self) -> impl Iterator<Item = (usize, usize)> {
        self.variables.iter().copied().enumerate()
    }

    /// Configuration and quasi-velocities, each of these variables seeded in its direction.
    pub(super) fn seeded(&self, z: &[f64]) -> Vec<Seeded> {
        let mut numbers: Vec<Seeded> = z.iter().copied().map(Seeded::constant).collect();
        for (direction, variable) in self.all() {
            if let Some(number) = numbers.get_mut(variable) {
                number.eps[direction] = 1.0;
            }
        }
        numbers
    }
}

/// The number of directions for seeds.
const DIRECTIONS: usize = 8;

/// The numbers of own coordinates and own quasi-velocities of a system with `n` own coordinates and `m` own constraints.
pub(super) fn own_counts(system: &dyn Mechanism, (n, m): (usize, usize)) -> (usize, usize) {
    let all = system.size();
    (n.min(all.n), n.saturating_sub(m).min(all.n - all.m))
}

/// Quasi-velocities with zeros from the index `count` on, where they do not count.
pub(super) fn admissible(mut xi: Vec<f64>, count: usize) -> Vec<f64> {
    xi.iter_mut().skip(count).for_each(|xi| *xi = 0.0);
    xi
}

/// One velocity of `n`, with zeros at all other indices.
pub(super) fn single(n: usize, place: usize, value: f64) -> Vec<f64> {
    (0..n).map(|k| if k == place { value } else { 0.0 }).collect()
}

/// The first `n` of some numbers, with not a number in the places that they lack.
pub(super) fn filled(n: usize, x: &[f64]) -> Vec<f64> {
    (0..n).map(|i| x.get(i).copied().unwrap_or(f64::NAN)).collect()
}
