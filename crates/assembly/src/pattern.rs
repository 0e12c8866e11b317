use crate::Assembly;
use faer::sparse::SymbolicSparseColMat;

/// Where every number of every element goes in the matrix of the equations
///
/// ```text
/// K x + G' lambda = r      (coordinates)
/// C x             = c      (constraints)
/// ```
///
/// in compressed columns: found once, and never changed.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    pub(crate) symbolic: SymbolicSparseColMat<u32>,
    /// The unknowns along the assembly: each coordinate, and each constraint after the last coordinate that it takes part in.
    pub(crate) along: Vec<u32>,
    /// For each element in turn: the places of its block, of its `G'`, and of its `C`, each by the rows of the element.
    places: Vec<u32>,
    starts: Vec<usize>,
    /// The places of the diagonal below `C`, which is zero except in a search for dependent constraints.
    pub(crate) regular: Vec<u32>,
}

/// The places of one element.
pub(crate) struct MatrixPlaces<'a> {
    pub(crate) block: &'a [u32],
    pub(crate) transposed: &'a [u32],
    pub(crate) rows: &'a [u32],
}

impl Pattern {
    pub(crate) fn of(assembly: &Assembly) -> Self {
        let n = assembly.coordinates();
        let unknowns = n + assembly.rows();
        // Columns first, so that the sorted keys are the compressed columns.
        let (mut wanted, mut starts) = (Vec::<u64>::new(), vec![0]);
        let key = |row: usize, column: usize| (column * unknowns + row) as u64;
        for placed in assembly.placed() {
            let row = |k: usize| n + placed.row + k;
            if placed.element.acts() {
                wanted.extend(placed.at.iter().flat_map(|i| placed.at.iter().map(move |j| key(*i, *j))));
            }
            wanted.extend((0..placed.rows).flat_map(|k| placed.at.iter().map(move |i| key(*i, row(k)))));
            wanted.extend((0..placed.rows).flat_map(|k| placed.at.iter().map(move |i| key(row(k), *i))));
            starts.push(wanted.len());
        }
        let diagonal: Vec<u64> = (n..unknowns).map(|k| key(k, k)).collect();
        let mut sorted: Vec<u64> = wanted.iter().chain(&diagonal).copied().collect();
        sorted.sort_unstable();
        sorted.dedup();

        let mut columns = vec![0u32; unknowns + 1];
        for key in &sorted {
            columns[(*key as usize) / unknowns.max(1) + 1] += 1;
        }
        for j in 0..unknowns {
            columns[j + 1] += columns[j];
        }
        let rows = sorted.iter().map(|key| ((*key as usize) % unknowns.max(1)) as u32).collect();
        let place = |key: &u64| sorted.binary_search(key).unwrap_or(0) as u32;
        let (places, regular) = (wanted.iter().map(place).collect(), diagonal.iter().map(place).collect());
        let symbolic = SymbolicSparseColMat::new_checked(unknowns, unknowns, columns, None, rows);
        Self { symbolic, along: along(assembly), places, starts, regular }
    }

    /// Number of entries of the matrix.
    pub(crate) fn entries(&self) -> usize {
        self.symbolic.row_idx().len()
    }

    pub(crate) fn unknowns(&self) -> usize {
        self.symbolic.ncols()
    }

    /// The places of an element with `n` coordinates and `m` rows.
    #[inline(always)]
    pub(crate) fn places(&self, element: usize, (n, m): (usize, usize), acts: bool) -> MatrixPlaces<'_> {
        let all = &self.places[self.starts[element]..self.starts[element + 1]];
        let (block, constraints) = all.split_at(if acts { n * n } else { 0 });
        let (transposed, rows) = constraints.split_at(n * m);
        MatrixPlaces { block, transposed, rows }
    }

    /// The rows and the values of a column.
    #[inline(always)]
    pub(crate) fn column<'a>(&'a self, values: &'a [f64], j: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
        let range = self.symbolic.col_ptr()[j] as usize..self.symbolic.col_ptr()[j + 1] as usize;
        self.symbolic.row_idx()[range.clone()].iter().map(|i| *i as usize).zip(values[range].iter().copied())
    }

    /// How far the entries of a row or column lie from the diagonal on average, in the order along the assembly: a bound of what
    /// an elimination in that order fills in.
    pub(crate) fn width(&self) -> f64 {
        let n = self.unknowns();
        let (mut position, mut widths) = (vec![0usize; n], vec![0usize; n]);
        for (at, unknown) in self.along.iter().enumerate() {
            position[*unknown as usize] = at;
        }
        let columns = self.symbolic.col_ptr().windows(2).enumerate();
        for (j, range) in columns {
            for i in &self.symbolic.row_idx()[range[0] as usize..range[1] as usize] {
                let (a, b) = (position[j], position[*i as usize]);
                widths[a.max(b)] = widths[a.max(b)].max(a.abs_diff(b));
            }
        }
        widths.iter().sum::<usize>() as f64 / n.max(1) as f64
    }

    /// The product of the matrix with these values and a vector, subtracted: `r -= K x`.
    pub(crate) fn subtract_product(&self, values: &[f64], x: &[f64], r: &mut [f64]) {
        for (j, x) in x.iter().enumerate() {
            for (i, value) in self.column(values, j) {
                r[i] -= value * x;
            }
        }
    }
}

/// The unknowns in the order of the coordinates, each constraint after the last of its own.
fn along(assembly: &Assembly) -> Vec<u32> {
    let n = assembly.coordinates();
    let mut keyed: Vec<(usize, usize)> = (0..n).map(|i| (i, i)).collect();
    for placed in assembly.placed() {
        let last = placed.at.iter().copied().max().unwrap_or(0);
        keyed.extend((0..placed.rows).map(|k| (last, n + placed.row + k)));
    }
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, unknown)| unknown as u32).collect()
}
