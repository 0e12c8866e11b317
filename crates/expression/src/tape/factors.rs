use super::plan::{Item, Plan, Step};
use std::collections::{BTreeMap, HashSet};

/// Longer sums and products are left as they are.
pub(crate) const SEARCHED: usize = 64;

impl Plan {
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
