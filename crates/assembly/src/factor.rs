use crate::pattern::Pattern;
use dla::{AssemblyFault, StepError};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::{factor as dense, solve as dense_solve};
use faer::perm::{Perm, PermRef};
use faer::sparse::linalg::lu::simplicial;
use faer::sparse::linalg::{LuError, colamd};
use faer::sparse::{FaerError, SparseColMatRef};
use faer::{Conj, Mat, MatMut, Par, Spec};
use lagrangian::linear::larger;

/// Which factorisation solves the linear equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Solver {
    /// Dense up to [`Solver::SMALL`] unknowns, sparse beyond.
    #[default]
    Best,
    /// `faer`'s sparse elimination, by columns and with pivots. It follows the order of the assembly if that is a chain, else COLAMD.
    Sparse,
    /// `faer`'s dense elimination with partial pivoting.
    Dense,
}

impl Solver {
    /// Largest number of unknowns for which dense elimination is no slower.
    pub const SMALL: usize = 24;
}

/// Factorises matrices of one pattern, one after the other: the pattern is analysed once, and factors are replaced in place.
pub(crate) struct Factor {
    forward: Vec<u32>,
    inverse: Vec<u32>,
    memory: MemBuffer,
    kind: FactorKind,
}

enum FactorKind {
    Sparse { columns: Perm<u32>, factors: Box<simplicial::SimplicialLu<u32, f64>> },
    Dense { factors: Mat<f64> },
}

impl Factor {
    pub(crate) fn of(pattern: &Pattern, solver: Solver) -> Result<Self, StepError> {
        let n = pattern.unknowns();
        let sparse = solver == Solver::Sparse || solver == Solver::Best && n > Solver::SMALL;
        let (kind, scratch) = if sparse {
            let columns = order(pattern)?;
            let scratch = StackReq::any_of(&[
                simplicial::factorize_simplicial_numeric_lu_scratch::<u32, f64>(n, n),
                simplicial::solve_in_place_scratch::<u32, f64>(n, 1, Par::Seq),
            ]);
            (FactorKind::Sparse { columns, factors: Box::default() }, scratch)
        } else {
            let scratch = StackReq::any_of(&[
                dense::lu_in_place_scratch::<u32, f64>(n, n, Par::Seq, Spec::default()),
                dense_solve::solve_in_place_scratch::<u32, f64>(n, 1, Par::Seq),
            ]);
            (FactorKind::Dense { factors: Mat::zeros(n, n) }, scratch)
        };
        Ok(Self { forward: vec![0; n], inverse: vec![0; n], memory: buffer(scratch, n)?, kind })
    }

    /// Factorises the matrix with these values. Returns its smallest pivot relative to the largest entry of its column, or zero if no
    /// pivot is left.
    pub(crate) fn factorise(&mut self, pattern: &Pattern, values: &[f64]) -> Result<f64, StepError> {
        let Self { forward, inverse, memory, kind } = self;
        let (n, stack) = (pattern.unknowns(), MemStack::new(memory));
        let largest = |j: usize| pattern.column(values, j).fold(0.0, |most, (_, value)| larger(most, value));
        // Not a number counts as none.
        let least = |least: f64, pivot: f64| {
            if pivot < least {
                pivot
            } else if pivot.is_nan() {
                0.0
            } else {
                least
            }
        };
        match kind {
            FactorKind::Sparse { columns, factors } => {
                let matrix = SparseColMatRef::new(pattern.symbolic.as_ref(), values);
                let order = columns.as_ref();
                match simplicial::factorize_simplicial_numeric_lu(forward, inverse, factors, matrix, order, stack) {
                    Ok(()) => {}
                    Err(LuError::SymbolicSingular { .. }) => return Ok(0.0),
                    Err(LuError::Generic(error)) => return Err(refused(n, error)),
                }
                let upper = factors.u_factor_unsorted();
                let pivots = upper.col_ptr()[1..].iter().map(|end| upper.val()[*end as usize - 1].abs());
                let order = order.arrays().0;
                Ok(pivots.zip(order).map(|(pivot, j)| pivot / largest(*j as usize)).fold(f64::INFINITY, least))
            }
            FactorKind::Dense { factors } => {
                factors.fill(0.0);
                for j in 0..n {
                    for (i, value) in pattern.column(values, j) {
                        factors[(i, j)] = value;
                    }
                }
                dense::lu_in_place(factors.as_mut(), forward, inverse, Par::Seq, stack, Spec::default());
                Ok((0..n).map(|j| factors[(j, j)].abs() / largest(j)).fold(f64::INFINITY, least))
            }
        }
    }

    /// Solves in place with the current factors.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        let Self { forward, inverse, memory, kind } = self;
        let (n, stack) = (x.len(), MemStack::new(memory));
        let rows = PermRef::new_checked(forward, inverse, n);
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        match kind {
            FactorKind::Sparse { columns, factors } => {
                factors.solve_in_place_with_conj(rows, columns.as_ref(), Conj::No, x, Par::Seq, stack);
            }
            FactorKind::Dense { factors } => {
                let lu = factors.as_ref();
                dense_solve::solve_in_place_with_conj(lu, lu, rows, Conj::No, x, Par::Seq, stack);
            }
        }
    }
}

/// The order of the columns. Columns follow the assembly if the entries then stay near the diagonal, since memory is then read in order.
/// Otherwise COLAMD orders them, which fills in little in trees and other sparse patterns (Davis, Gilbert, Larimore and Ng 2004, ACM Trans.
/// Math. Softw. 30, 353-376).
fn order(pattern: &Pattern) -> Result<Perm<u32>, StepError> {
    const NARROW: f64 = 16.0;
    let n = pattern.unknowns();
    let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
    if pattern.width() <= NARROW {
        forward.copy_from_slice(&pattern.along);
        for (at, unknown) in forward.iter().enumerate() {
            inverse[*unknown as usize] = at as u32;
        }
    } else {
        let mut memory = buffer(colamd::order_scratch::<u32>(n, n, pattern.entries()), n)?;
        let (control, stack) = (colamd::Control::default(), MemStack::new(&mut memory));
        colamd::order(&mut forward, &mut inverse, pattern.symbolic.as_ref(), control, stack)
            .map_err(|error| refused(n, error))?;
    }
    Ok(Perm::new_checked(forward.into(), inverse.into(), n))
}

fn buffer(scratch: StackReq, unknowns: usize) -> Result<MemBuffer, StepError> {
    MemBuffer::try_new(scratch)
        .map_err(|_| AssemblyFault::Factorisation { unknowns, reason: "\"out of memory\"" }.into())
}

fn refused(unknowns: usize, error: FaerError) -> StepError {
    let reason = match error {
        FaerError::IndexOverflow => "IndexOverflow",
        FaerError::OutOfMemory => "OutOfMemory",
        _ => "another error of the library",
    };
    AssemblyFault::Factorisation { unknowns, reason }.into()
}
