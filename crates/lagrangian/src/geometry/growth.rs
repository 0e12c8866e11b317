use crate::{Called, Dual, RowSpace, Scalar, System, from_fn, mapped};
use nalgebra::DMatrix;
use thiserror::Error;

/// A vector field on the configurations, `q' = X(q)`.
trait VectorField<const N: usize> {
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N];
}

impl<X: VectorField<N>, const N: usize> VectorField<N> for &X {
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        X::at(self, q)
    }
}

/// The Lie bracket `[X, Y] = (dY/dq) X - (dX/dq) Y`; its derivatives are dual numbers over whatever carries `q`, so that it is a field again.
struct LieBracket<X, Y>(X, Y);

impl<X: VectorField<N>, Y: VectorField<N>, const N: usize> VectorField<N> for LieBracket<X, Y> {
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        let along = |v: [S; N]| -> [_; N] { from_fn(|i| Called(Dual { re: q[i], eps: [v[i]] })) };
        let (of_y, of_x) = (self.1.at(&along(self.0.at(q))), self.0.at(&along(self.1.at(q))));
        from_fn(|i| of_y[i].0.eps[0] - of_x[i].0.eps[0])
    }
}

/// A field among those that span the admissible directions `ker A(q, t)`, at a fixed time.
///
/// Where the system gives a basis it is one of that. Elsewhere it is the solution of `A X = 0` with one of the free
/// coordinates moving at unit rate; which coordinates are free is chosen once, at one point, so that the field is smooth
/// about it as long as the rank of `A` stays.
struct AdmissibleField<'a, Sys, const N: usize, const M: usize> {
    system: &'a Sys,
    t: f64,
    index: usize,
    elimination: Elimination<M>,
}

/// Which rows of `A` are solved for which coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Elimination<const M: usize> {
    pivots: [(usize, usize); M],
    rank: usize,
}

/// Why a system has no admissible directions to take brackets of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum GrowthError {
    /// A constraint is not affine in the velocities.
    #[error("constraint {row} is not affine in the velocities: its admissible velocities are not a linear space")]
    Nonlinear {
        /// Which row, from 0.
        row: usize,
    },
    /// A coefficient of a constraint is infinite or not a number.
    #[error("the constraints are not finite at this point")]
    NotFinite,
}

/// How the admissible directions grow by their brackets at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Growth<const N: usize> {
    /// The growth vector `r_1 <= r_2 <= ..`: `r_k` is the rank of all brackets of up to `k` fields.
    ///
    /// It ends with the first `r_k = N`, or with [`Growth::DEPTH`] entries.
    pub dimensions: Vec<usize>,
    /// The brackets `[X_i, [X_j, .. X_k]]` by the numbers of their fields from 0, single fields first.
    pub brackets: Vec<(Vec<usize>, [f64; N])>,
}

impl<const N: usize> Growth<N> {
    /// Maximum number of fields in a bracket.
    pub const DEPTH: usize = 4;
    /// Singular values below this fraction of the largest count as zero. Exact derivatives leave rounding of some `1e-16` times the
    /// number of operations, from which a much weaker direction could not be told.
    pub const TOLERANCE: f64 = 1e-10;

    /// Whether the brackets span every direction: by the theorem of Chow and Rashevskii every place near the point is then
    /// reached along admissible directions.
    #[must_use]
    pub fn is_controllable(&self) -> bool {
        self.dimensions.last() == Some(&N)
    }

    /// How many fields the longest bracket that is needed has, where the system is controllable.
    #[must_use]
    pub fn degree(&self) -> Option<usize> {
        self.is_controllable().then_some(self.dimensions.len())
    }
}

/// The fields that span the admissible directions near `q`. What an affine constraint imposes besides is left out.
fn admissible_fields<'a, Sys: System<N, M>, const N: usize, const M: usize>(
    system: &'a Sys,
    t: f64,
    q: &[f64; N],
) -> Result<Vec<AdmissibleField<'a, Sys, N, M>>, GrowthError> {
    let nonlinear = system.nonlinear(t, q, &[0.0; N]).unwrap_or([None; M]);
    if let Some(row) = nonlinear.iter().position(Option::is_some) {
        return Err(GrowthError::Nonlinear { row });
    }
    let (a, _) = system.constraint(t, q);
    if a.iter().flatten().any(|x| !x.is_finite()) {
        return Err(GrowthError::NotFinite);
    }
    let elimination = Elimination::choose(a);
    let given = system.admissible_basis(t, q).is_some() && elimination.rank == M;
    let free = (0..N).filter(|j| !elimination.pivots[..elimination.rank].iter().any(|(_, pivot)| pivot == j));
    let numbers: Vec<usize> = if given { (0..N - M).collect() } else { free.map(|j| j + N).collect() };
    Ok(numbers.into_iter().map(|index| AdmissibleField { system, t, index, elimination }).collect())
}

/// The growth vector of the admissible directions of a system, with the brackets behind it.
///
/// Brackets are nested to the right; by the Jacobi identity these span all brackets of the same length. The rank is the number of singular
/// values above [`Growth::TOLERANCE`]. (Bellaiche 1996, The tangent space in sub-Riemannian geometry, section 2.)
///
/// # Errors
/// [`GrowthError`].
pub fn growth<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
    t: f64,
    q: &[f64; N],
) -> Result<Growth<N>, GrowthError> {
    let fields = admissible_fields(system, t, q)?;
    let mut growth = Growth { dimensions: Vec::new(), brackets: Vec::new() };
    let mut words: Vec<Vec<usize>> = (0..fields.len()).map(|i| vec![i]).collect();
    for _ in 0..Growth::<N>::DEPTH {
        let values = words.iter().map(|word| (word.clone(), bracket(&fields, word, q)));
        growth.brackets.extend(values);
        growth.dimensions.push(rank(&growth.brackets));
        if growth.is_controllable() || fields.is_empty() {
            break;
        }
        words =
            (0..fields.len()).flat_map(|i| words.iter().map(move |word| [&[i], word.as_slice()].concat())).collect();
        // `[X, X] = 0`, and `[Y, X] = -[X, Y]`.
        words.retain(|word| word[word.len() - 2] < word[word.len() - 1]);
    }
    Ok(growth)
}

/// The bracket of the fields with these numbers, nested to the right; at most [`Growth::DEPTH`] of them.
fn bracket<X: VectorField<N>, const N: usize>(fields: &[X], word: &[usize], q: &[f64; N]) -> [f64; N] {
    match *word {
        [a] => fields[a].at(q),
        [a, b] => LieBracket(&fields[a], &fields[b]).at(q),
        [a, b, c] => LieBracket(&fields[a], LieBracket(&fields[b], &fields[c])).at(q),
        [a, b, c, d] => LieBracket(&fields[a], LieBracket(&fields[b], LieBracket(&fields[c], &fields[d]))).at(q),
        _ => [0.0; N],
    }
}

fn rank<const N: usize>(vectors: &[(Vec<usize>, [f64; N])]) -> usize {
    if vectors.is_empty() {
        return 0;
    }
    let values = DMatrix::from_fn(N, vectors.len(), |i, j| vectors[j].1[i]).singular_values();
    let largest = values.iter().copied().fold(0.0, f64::max);
    values.iter().filter(|value| **value > Growth::<N>::TOLERANCE * largest).count()
}

impl<const M: usize> Elimination<M> {
    /// The pivots of Gauss-Jordan elimination: each is the largest remaining entry, relative to the size of its row.
    fn choose<const N: usize>(a: [[f64; N]; M]) -> Self {
        let mut left = a.map(|row| {
            let size = crate::linear::largest(&row);
            if size > 0.0 { mapped(&row, |x| x / size) } else { row }
        });
        let mut chosen = Self { pivots: [(0, 0); M], rank: 0 };
        for step in 0..M {
            let done = &chosen.pivots[..step];
            let open = (0..M).filter(|k| done.iter().all(|(row, _)| row != k));
            let entries = open.flat_map(|k| (0..N).map(move |j| (k, j)));
            let Some((k, j)) = entries.max_by(|x, y| left[x.0][x.1].abs().total_cmp(&left[y.0][y.1].abs())) else {
                break;
            };
            if left[k][j].abs() <= RowSpace::<N, M>::ROUNDING {
                break;
            }
            chosen.pivots[step] = (k, j);
            chosen.rank += 1;
            take_off(&mut left, k, j);
        }
        chosen
    }
}

/// One step of Gauss-Jordan elimination with the entry `(k, j)`.
#[inline(always)]
fn take_off<S: Scalar, const N: usize, const M: usize>(a: &mut [[S; N]; M], k: usize, j: usize) {
    let pivot = a[k][j];
    let row: [S; N] = from_fn(|i| a[k][i] / pivot);
    for (other, line) in a.iter_mut().enumerate() {
        let factor = line[j];
        *line = if other == k { row } else { from_fn(|i| line[i] - factor * row[i]) };
    }
}

impl<Sys: System<N, M>, const N: usize, const M: usize> VectorField<N> for AdmissibleField<'_, Sys, N, M> {
    fn at<S: Scalar>(&self, q: &[S; N]) -> [S; N] {
        let t = S::constant(self.t);
        let Some(free) = self.index.checked_sub(N) else {
            let basis = self.system.admissible_basis(t, q);
            return basis.and_then(|basis| basis.vectors().get(self.index).copied()).unwrap_or([S::zero(); N]);
        };
        let (mut a, _) = self.system.constraint(t, q);
        let pivots = &self.elimination.pivots[..self.elimination.rank];
        for (k, j) in pivots {
            take_off(&mut a, *k, *j);
        }
        let mut x: [S; N] = from_fn(|i| S::constant(f64::from(u8::from(i == free))));
        for (k, j) in pivots {
            x[*j] = -a[*k][free];
        }
        x
    }
}
