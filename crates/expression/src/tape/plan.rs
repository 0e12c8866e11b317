use crate::graph::{Expression, Graph, NodeKind};
use crate::{Error, Function};
use std::collections::{BTreeMap, HashMap, HashSet};

/// A part of a sum or of a product.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Item {
    pub(crate) part: u32,
    pub(crate) negative: bool,
}

impl Item {
    pub(crate) fn positive(part: u32) -> Self {
        Self { part, negative: false }
    }
}

/// What is to be computed from other steps.
#[derive(Debug, Clone)]
pub(crate) enum Step {
    Constant(f64),
    Variable(u32),
    /// A constant and parts with their coefficients.
    Combination(f64, Vec<(u32, f64)>),
    Sum(Vec<Item>),
    Product(Vec<Item>),
    Divide(u32, u32),
    Invert(u32),
    Square(u32),
    /// The root of a sum of squares.
    Length(u32),
    Whole(u32, i32),
    Real(u32, f64),
    /// A positive power of a base that may be zero in a whole region.
    Flat(u32, f64),
    Call(Function, u32, u32),
}

impl Step {
    pub(crate) fn parts(&self) -> Vec<u32> {
        match self {
            Self::Constant(_) | Self::Variable(_) => Vec::new(),
            Self::Combination(_, parts) => parts.iter().map(|&(part, _)| part).collect(),
            Self::Sum(items) | Self::Product(items) => items.iter().map(|item| item.part).collect(),
            Self::Call(function, a, b) if function.arguments() == 2 => vec![*a, *b],
            Self::Divide(a, b) => vec![*a, *b],
            Self::Invert(a)
            | Self::Square(a)
            | Self::Length(a)
            | Self::Whole(a, _)
            | Self::Real(a, _)
            | Self::Flat(a, _)
            | Self::Call(_, a, _) => vec![*a],
        }
    }
}

/// Powers that several steps have in common.
#[derive(Debug, PartialEq, Eq, Hash)]
enum Shared {
    Power(u32, i32),
    Root(u32),
    Inverse(u32),
}

/// Steps for some expressions: sums and products are lists still, in which common parts can be looked for.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) steps: Vec<Step>,
    pub(crate) outputs: Vec<u32>,
    shared: HashMap<Shared, u32>,
}

/// Common factors and pairs are not searched in longer sums and products.
pub(crate) const SEARCHED: usize = 64;

/// Higher powers are left to the function for them; it takes as many products, one after another.
const HIGH: i32 = 16;

impl Plan {
    pub(crate) fn new(graph: &Graph, outputs: &[Expression]) -> Result<Self, Error> {
        graph.check()?;
        let live = graph.reached(outputs, |_| true);
        // A number that several products are divided by is inverted once.
        let mut divides: HashMap<(Expression, bool), u32> = HashMap::new();
        for &e in &live {
            if let NodeKind::Product(factors) = graph.kind(e) {
                for &(base, halves) in factors.iter().filter(|(_, halves)| *halves < 0) {
                    for root in [false, true] {
                        let has = if root { halves % 2 != 0 } else { halves < -1 };
                        *divides.entry((base, root)).or_default() += u32::from(has);
                    }
                }
            }
        }
        let often = |base, root| divides.get(&(base, root)).is_some_and(|&count| count > 1);
        let mut plan = Self { steps: Vec::new(), outputs: Vec::new(), shared: HashMap::new() };
        let mut steps: HashMap<Expression, u32> = HashMap::new();
        for &e in &live {
            let of = |e: &Expression| steps.get(e).copied().unwrap_or(0);
            let step = match graph.kind(e) {
                NodeKind::Constant(x) => plan.push(Step::Constant(x.value())),
                NodeKind::Variable(k) => plan.push(Step::Variable(*k)),
                NodeKind::Sum { constant, terms } => {
                    let terms: Vec<_> = terms.iter().map(|(term, c)| (of(term), c.value())).collect();
                    plan.sum(constant.value(), &terms)
                }
                NodeKind::Product(factors) => {
                    let (mut above, mut below) = (Vec::new(), Vec::new());
                    for &(base, halves) in factors {
                        let part = of(&base);
                        let root = (halves % 2 != 0).then(|| {
                            let step = match (graph.is_square(base), graph.is_flat(base)) {
                                (true, _) => Step::Length(part),
                                (_, true) => Step::Flat(part, 0.5),
                                _ => Step::Call(Function::Sqrt, part, part),
                            };
                            plan.once(Shared::Root(part), step)
                        });
                        for (part, n, is_root) in [(Some(part), halves / 2, false), (root, halves % 2, true)] {
                            let Some(part) = part.filter(|_| n != 0) else { continue };
                            if n > 0 {
                                above.push(Item::positive(plan.power(part, n)));
                            } else if often(base, is_root) {
                                let inverse = plan.inverse(part);
                                above.push(Item::positive(plan.power(inverse, -n)));
                            } else {
                                below.push(Item::positive(plan.power(part, -n)));
                            }
                        }
                    }
                    plan.quotient(above, below)
                }
                NodeKind::Power(base, p) if p.value() > 0.0 && graph.is_flat(*base) => {
                    plan.push(Step::Flat(of(base), p.value()))
                }
                NodeKind::Power(base, p) => plan.push(Step::Real(of(base), p.value())),
                NodeKind::Call(function, [a, b]) => plan.push(Step::Call(*function, of(a), of(b))),
            };
            steps.insert(e, step);
        }
        // An expression of another graph has no step.
        let not_a_number = plan.push(Step::Constant(f64::NAN));
        plan.outputs = outputs.iter().map(|e| steps.get(e).copied().unwrap_or(not_a_number)).collect();
        Ok(plan)
    }

    pub(crate) fn push(&mut self, step: Step) -> u32 {
        self.steps.push(step);
        self.steps.len() as u32 - 1
    }

    /// A sum whose terms with the same coefficient, but for signs, are added before they are multiplied.
    fn sum(&mut self, constant: f64, terms: &[(u32, f64)]) -> u32 {
        let mut groups: Vec<(f64, Vec<Item>)> = Vec::new();
        let mut places: HashMap<u64, usize> = HashMap::new();
        for &(part, c) in terms {
            let place = *places.entry(c.abs().to_bits()).or_insert(groups.len());
            if place == groups.len() {
                groups.push((c, Vec::new()));
            }
            let (first, items) = &mut groups[place];
            items.push(Item { part, negative: (c < 0.0) != (*first < 0.0) });
        }
        let mut parts = Vec::new();
        for (mut c, mut items) in groups {
            // Turned round where that leaves a term to begin with.
            if c < 0.0 && items.iter().any(|item| item.negative) {
                c = -c;
                items.iter_mut().for_each(|item| item.negative = !item.negative);
            }
            parts.push(match items[..] {
                [Item { part, .. }] => (part, c),
                _ => (self.push(Step::Sum(items)), c),
            });
        }
        match parts[..] {
            [(part, 1.0)] if constant == 0.0 => part,
            _ => self.push(Step::Combination(constant, parts)),
        }
    }

    fn quotient(&mut self, above: Vec<Item>, below: Vec<Item>) -> u32 {
        let (above, below) = (self.distinct(above), self.distinct(below));
        if below.is_empty() {
            return self.list(above);
        }
        let divisor = self.list(below);
        if above.is_empty() {
            return self.push(Step::Invert(divisor));
        }
        let dividend = self.list(above);
        self.push(Step::Divide(dividend, divisor))
    }

    /// The factors, none of them twice: the root of `x` may stand there for itself, and for `sqrt(x)^1.5`.
    fn distinct(&mut self, mut items: Vec<Item>) -> Vec<Item> {
        loop {
            let again = |at: &usize| items[..*at].contains(&items[*at]);
            let Some(second) = (1..items.len()).find(again) else { return items };
            let Item { part, .. } = items.remove(second);
            items.retain(|item| item.part != part);
            items.push(Item::positive(self.power(part, 2)));
        }
    }

    /// A product of at least one item.
    pub(crate) fn list(&mut self, items: Vec<Item>) -> u32 {
        match items[..] {
            [Item { part, .. }] => part,
            _ => self.push(Step::Product(items)),
        }
    }

    fn power(&mut self, part: u32, n: i32) -> u32 {
        if n == 1 {
            return part;
        }
        if let Some(&there) = self.shared.get(&Shared::Power(part, n)) {
            return there;
        }
        let step = if n > HIGH {
            self.push(Step::Whole(part, n))
        } else if n % 2 == 0 {
            let half = self.power(part, n / 2);
            self.push(Step::Square(half))
        } else {
            let even = self.power(part, n - 1);
            self.push(Step::Product(vec![Item::positive(even), Item::positive(part)]))
        };
        self.shared.insert(Shared::Power(part, n), step);
        step
    }

    fn inverse(&mut self, part: u32) -> u32 {
        self.once(Shared::Inverse(part), Step::Invert(part))
    }

    fn once(&mut self, key: Shared, step: Step) -> u32 {
        if let Some(&there) = self.shared.get(&key) {
            return there;
        }
        let new = self.push(step);
        self.shared.insert(key, new);
        new
    }

    /// How many steps and outputs use each step, of those that an output needs.
    pub(crate) fn uses(&self) -> Vec<u32> {
        let mut uses = vec![0; self.steps.len()];
        let mut waiting = self.outputs.clone();
        while let Some(step) = waiting.pop() {
            uses[step as usize] += 1;
            if uses[step as usize] == 1 {
                waiting.extend(self.steps[step as usize].parts());
            }
        }
        uses
    }

    /// Takes common factors out of sums: `a x + a y` is `a (x + y)`. Only of products that nothing else uses, so that every one saves a
    /// multiplication.
    pub(crate) fn take_factors_out(&mut self) {
        let mut uses = self.uses();
        let sum = |(k, step): (usize, &Step)| (matches!(step, Step::Sum(_)) && uses[k] > 0).then_some(k as u32);
        let mut waiting: Vec<u32> = self.steps.iter().enumerate().filter_map(sum).collect();
        while let Some(step) = waiting.pop() {
            let Step::Sum(items) = &self.steps[step as usize] else { continue };
            if items.len() > SEARCHED {
                continue;
            }
            let mut items = items.clone();
            while let Some(factored) = self.factored(&mut items, &uses, &mut waiting) {
                items.push(factored);
                // What is new is used once.
                uses.resize(self.steps.len(), 1);
            }
            self.steps[step as usize] = Step::Sum(items);
        }
    }

    /// The factors of a product that only this sum uses.
    fn own_factors(&self, item: Item, uses: &[u32]) -> Option<&[Item]> {
        match &self.steps[item.part as usize] {
            Step::Product(factors) if uses[item.part as usize] == 1 && factors.len() <= SEARCHED => Some(factors),
            _ => None,
        }
    }

    /// Takes the terms with the most common factor out of the list, and makes one term of them.
    fn factored(&mut self, items: &mut Vec<Item>, uses: &[u32], waiting: &mut Vec<u32>) -> Option<Item> {
        let mut counts: BTreeMap<u32, u32> = BTreeMap::new();
        for &item in items.iter() {
            for factor in self.own_factors(item, uses).unwrap_or_default() {
                *counts.entry(factor.part).or_default() += 1;
            }
        }
        let (&factor, &count) = counts.iter().max_by_key(|&(&part, &count)| (count, u32::MAX - part))?;
        if count < 2 {
            return None;
        }
        let has = |plan: &Self, item: Item, factor: u32| {
            plan.own_factors(item, uses).is_some_and(|factors| factors.iter().any(|f| f.part == factor))
        };
        let (chosen, others): (Vec<_>, Vec<_>) = items.iter().partition(|&&item| has(self, item, factor));
        let first = *chosen.first()?;
        let mut common = self.own_factors(first, uses)?.to_vec();
        common.retain(|f| chosen.iter().all(|&item| has(self, item, f.part)));
        let taken: HashSet<u32> = common.iter().map(|f| f.part).collect();
        let (mut constant, mut rests) = (0.0, Vec::new());
        for item in chosen {
            let negative = item.negative != first.negative;
            let rest = self.own_factors(item, uses)?.iter().filter(|f| !taken.contains(&f.part)).copied().collect();
            if Vec::is_empty(&rest) {
                constant += if negative { -1.0 } else { 1.0 };
            } else {
                rests.push(Item { part: self.list(rest), negative });
            }
        }
        let sum = self.push(Step::Sum(rests));
        waiting.push(sum);
        let inner = if constant == 0.0 { sum } else { self.push(Step::Combination(constant, vec![(sum, 1.0)])) };
        common.push(Item::positive(inner));
        *items = others;
        Some(Item { part: self.list(common), negative: first.negative })
    }
}
