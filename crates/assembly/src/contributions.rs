use crate::Assembly;
use crate::assembly::PlacedElement;
use crate::element::{ElementBlocks, WIDEST};
use crate::pattern::Pattern;

/// The contributions of the elements at one point, each in its own place, and the matrix and vectors made of them.
#[derive(Debug)]
pub(crate) struct Contributions {
    /// For each element in turn: momentum, level, block and rows.
    each: Vec<f64>,
    starts: Vec<usize>,
    /// Number of elements from which on they are evaluated in parallel.
    pub(crate) parallel: usize,
}

/// The question put to each element.
pub(crate) type Ask<'a> = dyn Fn(&PlacedElement, ElementBlocks<'_>) + Sync + 'a;

impl Contributions {
    pub(crate) fn of(assembly: &Assembly, parallel: usize) -> Self {
        let mut starts = vec![0];
        for placed in assembly.placed() {
            let (n, m) = placed.element.size();
            let block = if placed.element.acts() { n * n } else { 0 };
            starts.push(starts[starts.len() - 1] + n + m + block + m * n);
        }
        Self { each: vec![0.0; starts[starts.len() - 1]], starts, parallel }
    }

    /// Asks every element, with or without derivatives, in parallel if there are many. The result does not depend on the order of the
    /// answers.
    pub(crate) fn ask(&mut self, assembly: &Assembly, derivatives: bool, ask: &Ask<'_>) {
        let elements = assembly.placed();
        let parallel = elements.len() >= self.parallel && rayon::current_num_threads() > 1;
        let grain = if parallel { PIECE } else { usize::MAX };
        ask_all(elements, &self.starts, &mut self.each, (ask, derivatives), grain);
    }

    /// The contributions of an element.
    #[inline(always)]
    fn one(&self, k: usize, placed: &PlacedElement) -> Answer<'_> {
        let (n, m) = (placed.at.len(), placed.rows);
        let all = &self.each[self.starts[k]..self.starts[k + 1]];
        let (momentum, rest) = all.split_at(n);
        let (level, rest) = rest.split_at(m);
        let (block, rows) = rest.split_at(rest.len() - m * n);
        Answer { momentum, level, block, rows }
    }

    /// Adds `sign` times the momenta to the first part of a vector.
    pub(crate) fn add_momenta(&self, assembly: &Assembly, sign: f64, to: &mut [f64]) {
        for (k, placed) in assembly.placed().iter().enumerate().filter(|(_, placed)| placed.element.acts()) {
            for (i, p) in placed.at.iter().zip(self.one(k, placed).momentum) {
                to[*i] += sign * p;
            }
        }
    }

    /// Writes the levels of the constraints, in the order of their rows.
    pub(crate) fn write_levels(&self, assembly: &Assembly, to: &mut [f64]) {
        for (k, placed) in assembly.placed().iter().enumerate() {
            to[placed.row..placed.row + placed.rows].copy_from_slice(self.one(k, placed).level);
        }
    }

    /// Writes the blocks, and the rows where `MatrixPart` says.
    pub(crate) fn write_matrix(&self, assembly: &Assembly, pattern: &Pattern, part: MatrixPart, values: &mut [f64]) {
        if part != MatrixPart::Transposed {
            blank(assembly, pattern, values);
        }
        for (k, placed) in assembly.placed().iter().enumerate() {
            let (size, acts) = (placed.element.size(), placed.element.acts());
            let (places, answer) = (pattern.places(k, size, acts), self.one(k, placed));
            if part != MatrixPart::Transposed {
                for (place, x) in places.block.iter().zip(answer.block) {
                    values[*place as usize] += x;
                }
                for (place, x) in places.rows.iter().zip(answer.rows) {
                    values[*place as usize] = *x;
                }
            }
            if part != MatrixPart::ElementBlocks {
                for (place, x) in places.transposed.iter().zip(answer.rows) {
                    values[*place as usize] = *x;
                }
            }
        }
    }
}

/// Which part of the matrix is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MatrixPart {
    /// `G'` alone.
    Transposed,
    /// `K` and `C`.
    ElementBlocks,
    /// All, `G` and `C` the same.
    All,
}

struct Answer<'a> {
    momentum: &'a [f64],
    level: &'a [f64],
    block: &'a [f64],
    rows: &'a [f64],
}

/// The blocks of elements are sums: first zero.
fn blank(assembly: &Assembly, pattern: &Pattern, values: &mut [f64]) {
    for (k, placed) in assembly.placed().iter().enumerate() {
        for place in pattern.places(k, placed.element.size(), placed.element.acts()).block {
            values[*place as usize] = 0.0;
        }
    }
}

/// Largest number of elements that a single task evaluates.
const PIECE: usize = 512;

fn ask_all(elements: &[PlacedElement], starts: &[usize], out: &mut [f64], ask: (&Ask<'_>, bool), grain: usize) {
    if elements.len() > grain {
        let half = elements.len() / 2;
        let (first, last) = elements.split_at(half);
        let (left, right) = out.split_at_mut(starts[half] - starts[0]);
        rayon::join(
            || ask_all(first, &starts[..=half], left, ask, grain),
            || ask_all(last, &starts[half..], right, ask, grain),
        );
        return;
    }
    for (k, placed) in elements.iter().enumerate() {
        let (n, m) = (placed.at.len(), placed.rows);
        let all = &mut out[starts[k] - starts[0]..starts[k + 1] - starts[0]];
        let (momentum, rest) = all.split_at_mut(n);
        let (level, rest) = rest.split_at_mut(m);
        let rest = if ask.1 { rest } else { &mut [] };
        let (block, rows) = rest.split_at_mut(rest.len().saturating_sub(m * n));
        ask.0(placed, ElementBlocks { momentum, level, block, rows, derivatives: ask.1 });
    }
}

/// Calls `then` with the numbers of the coordinates of an element. A wide element has the numbers themselves, others have copies.
#[inline(always)]
pub(crate) fn gathered<T>(placed: &PlacedElement, from: &[f64], then: impl FnOnce(&[f64]) -> T) -> T {
    if let Some(own) = placed.wide() {
        return then(&from[own]);
    }
    let mut local = [0.0; WIDEST];
    placed.gather(|i| from[i], &mut local);
    then(&local[..placed.at.len()])
}

/// Gathers the coordinates and velocities of an element, and calls `then` with them.
#[inline(always)]
pub(crate) fn at<T>(placed: &PlacedElement, q: &[f64], v: &[f64], then: impl FnOnce(&[f64], &[f64]) -> T) -> T {
    gathered(placed, q, |q| gathered(placed, v, |v| then(q, v)))
}
