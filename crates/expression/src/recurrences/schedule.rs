use super::lowered::Lowered;
use super::{Kind, Recurrences, Run, SeriesOperation, Start, WIDE};
use crate::Function;

/// The place of no sum.
const NONE: usize = usize::MAX;

impl Kind {
    /// The places whose coefficients of order `k` are the terms of its own, but for a sum over products.
    fn operands(self) -> ([u32; 3], usize) {
        match self {
            Self::Scaled { a, .. } | Self::Square { a } | Self::Root { a, .. } | Self::Integral { a, .. } => {
                ([a; 3], 1)
            }
            Self::Inverse { b, .. } => ([b; 3], 1),
            Self::Pick { a, .. } => ([a; 3], 1),
            Self::Sum { a, b, .. }
            | Self::Product { a, b }
            | Self::Quotient { a, b, .. }
            | Self::Choice { a, b, .. } => ([a, b, b], 2),
            Self::SumOfProduct { a, b, c, .. } => ([a, b, c], 3),
        }
    }

    /// The factors of its sum over products, if it has one, and whether the left one is weighted.
    fn factors(self, to: u32) -> Option<([u32; 2], bool)> {
        let sorted = |a: u32, b: u32| Some(([a.min(b), a.max(b)], false));
        match self {
            Self::Product { a, b } | Self::SumOfProduct { a, b, .. } => sorted(a, b),
            Self::Square { a } => sorted(a, a),
            Self::Quotient { b, .. } | Self::Inverse { b, .. } => sorted(b, to),
            Self::Root { .. } => sorted(to, to),
            Self::Integral { a, b, .. } => Some(([a, b], true)),
            Self::Scaled { .. } | Self::Sum { .. } | Self::Choice { .. } | Self::Pick { .. } => None,
        }
    }

    pub(super) fn terms(self) -> u32 {
        self.operands().1 as u32 + u32::from(self.factors(0).is_some())
    }
}

impl Lowered {
    /// The operations in an order in which each follows those that it needs, and as many with the same number of terms as possible follow one
    /// another: each change of the number costs a jump that the processor has to foresee.
    pub(super) fn scheduled(self, variables: &[u32]) -> Recurrences {
        let (plain, sums, of_operation) = self.sums();
        let (order, sudden) = (self.ordered(), self.is_sudden());
        let (mut runs, mut terms, mut operations) = (Vec::<Run>::new(), Vec::new(), Vec::new());
        for k in order {
            let SeriesOperation { kind, terms: of_kind, .. } = self.operations[k];
            let of_kind = of_kind as usize;
            let (operands, n) = kind.operands();
            terms.extend(&operands[..n]);
            if of_operation[k] != NONE {
                terms.push(self.places + of_operation[k] as u32);
            }
            operations.push(self.operations[k]);
            let picks = matches!(self.operations[k].kind, Kind::Pick { .. });
            match runs.last_mut() {
                Some(run) if run.terms == of_kind && run.picks == picks => run.end += 1,
                _ => runs.push(Run { terms: of_kind, picks, end: operations.len() }),
            }
        }
        Recurrences {
            results: operations.iter().map(|operation| operation.to).collect(),
            operations: operations.into(),
            runs: runs.into(),
            terms: terms.into(),
            sums: sums.into(),
            plain,
            corners: self.corners.into(),
            sudden,
            constants: self.constants.into(),
            places: self.places as usize,
            inputs: self.inputs as usize,
            variables: variables.into(),
            rates: self.outputs.into(),
        }
    }

    /// Whether a function other than a sine and a cosine depends on time.
    fn is_sudden(&self) -> bool {
        let mut timed = vec![false; self.places as usize];
        timed[0] = true;
        // Operations stand in no order: until nothing changes.
        let mut changed = true;
        while changed {
            changed = false;
            for operation in &self.operations {
                let now = self.needs(operation.kind).iter().any(|place| timed[*place as usize]);
                changed |= now && !std::mem::replace(&mut timed[operation.to as usize], now);
            }
        }
        self.operations.iter().any(|operation| match operation.kind {
            Kind::Integral { start: Start::Call(Function::Sin | Function::Cos, _), .. } => false,
            Kind::Integral { a, .. } => timed[a as usize],
            _ => false,
        })
    }

    fn ordered(&self) -> Vec<usize> {
        let all = &self.operations;
        let mut maker = vec![None; self.places as usize];
        for (k, operation) in all.iter().enumerate() {
            maker[operation.to as usize] = Some(k);
        }
        let (mut left, mut users) = (vec![0; all.len()], vec![Vec::new(); all.len()]);
        for (k, operation) in all.iter().enumerate() {
            for needed in self.needs(operation.kind).into_iter().filter_map(|place| maker[place as usize]) {
                left[k] += 1;
                users[needed].push(k);
            }
        }
        let mut ready = vec![Vec::new(); 5];
        for (k, operation) in all.iter().enumerate().filter(|&(k, _)| left[k] == 0) {
            ready[operation.terms as usize].push(k);
        }
        let mut order = Vec::new();
        while let Some(terms) = (1..ready.len()).max_by_key(|&terms| ready[terms].len())
            && !ready[terms].is_empty()
        {
            while let Some(k) = ready[terms].pop() {
                order.push(k);
                for &user in &users[k] {
                    left[user] -= 1;
                    if left[user] == 0 {
                        ready[all[user].terms as usize].push(user);
                    }
                }
            }
        }
        order
    }

    /// The places that an operation needs before its own.
    fn needs(&self, kind: Kind) -> Vec<u32> {
        let (operands, n) = kind.operands();
        let mut all = operands[..n].to_vec();
        match kind {
            Kind::Integral { start: Start::Call(_, second), .. } => all.push(second),
            Kind::Choice { corner, .. } | Kind::Pick { corner, .. } => all.push(self.corners[corner as usize].argument),
            _ => {}
        }
        all
    }

    /// The sums over products of all operations, by blocks of which the first have no weights, and the place of the sum of each operation.
    /// Equal sums are one.
    fn sums(&self) -> (usize, Vec<[[u32; WIDE]; 2]>, Vec<usize>) {
        let mut lists: [Vec<[u32; 2]>; 2] = [Vec::new(), Vec::new()];
        let find = |operation: &SeriesOperation| {
            let (factors, weighted) = operation.kind.factors(operation.to)?;
            let list = &mut lists[usize::from(weighted)];
            let at = list.iter().position(|other| *other == factors).unwrap_or(list.len());
            if at == list.len() {
                list.push(factors);
            }
            Some((weighted, at))
        };
        let found: Vec<_> = self.operations.iter().map(find).collect();
        let plain = lists[0].len().div_ceil(WIDE);
        let of = |found: &Option<(bool, usize)>| {
            found.map_or(NONE, |(weighted, at)| at + if weighted { plain * WIDE } else { 0 })
        };
        let block = |part: &[[u32; 2]]| {
            [0, 1].map(|side| std::array::from_fn(|j| part.get(j).map_or(0, |factors| factors[side])))
        };
        let blocks = lists.iter().flat_map(|list| list.chunks(WIDE).map(block)).collect();
        (plain, blocks, found.iter().map(of).collect())
    }
}
