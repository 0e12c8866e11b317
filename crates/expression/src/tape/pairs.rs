use super::plan::{Item, Plan, SEARCHED, Step};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

/// Two parts that stand beside each other in lists, with the same sign or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Pair {
    a: u32,
    b: u32,
    opposite: bool,
}

impl Pair {
    fn of(x: Item, y: Item) -> Self {
        Self { a: x.part.min(y.part), b: x.part.max(y.part), opposite: x.negative != y.negative }
    }
}

/// The lists that have a pair, some of which may have lost it.
#[derive(Debug, Default)]
struct Places {
    count: u32,
    lists: Vec<usize>,
    /// The count with which the pair stands in the order; any other entry of the pair there is one that has been followed by another.
    ordered: u32,
}

#[derive(Debug, Default)]
struct Search {
    lists: Vec<(u32, Vec<Item>)>,
    places: HashMap<Pair, Places>,
    /// Counts are looked up again when a pair comes first: they may have become smaller.
    order: BinaryHeap<(u32, Reverse<Pair>)>,
}

impl Plan {
    /// Computes pairs that several products, or several sums, have in common once: the most frequent first.
    pub(crate) fn share_pairs(&mut self) {
        for products in [true, false] {
            let uses = self.uses();
            let mut search = Search::default();
            for (k, step) in self.steps.iter().enumerate() {
                match step {
                    Step::Product(items) if products && uses[k] > 0 => search.add(k, items),
                    Step::Sum(items) if !products && uses[k] > 0 => search.add(k, items),
                    _ => {}
                }
            }
            while let Some((pair, lists)) = search.next() {
                let items = vec![Item::positive(pair.a), Item { part: pair.b, negative: pair.opposite }];
                let new = self.push(if products { Step::Product(items) } else { Step::Sum(items) });
                search.replace(pair, &lists, new);
            }
            for (k, items) in search.lists {
                self.steps[k as usize] = if products { Step::Product(items) } else { Step::Sum(items) };
            }
        }
    }
}

impl Search {
    fn add(&mut self, step: usize, items: &[Item]) {
        // Of a part that stands there twice, since coefficients that are out of range together are kept apart, pairs could not be counted.
        let parts: HashSet<u32> = items.iter().map(|item| item.part).collect();
        if items.len() > SEARCHED || parts.len() < items.len() {
            return;
        }
        let list = self.lists.len();
        self.lists.push((step as u32, items.to_vec()));
        for (i, &x) in items.iter().enumerate() {
            for &y in &items[i + 1..] {
                self.found(Pair::of(x, y), list);
            }
        }
    }

    fn found(&mut self, pair: Pair, list: usize) {
        let places = self.places.entry(pair).or_default();
        places.count += 1;
        places.lists.push(list);
        if places.count > places.ordered.max(1) {
            places.ordered = places.count;
            self.order.push((places.count, Reverse(pair)));
        }
    }

    fn lost(&mut self, pair: Pair) {
        if let Some(places) = self.places.get_mut(&pair) {
            places.count -= 1;
        }
    }

    /// The most frequent pair that stands in several lists.
    fn next(&mut self) -> Option<(Pair, Vec<usize>)> {
        while let Some((count, Reverse(pair))) = self.order.pop() {
            let places = self.places.get_mut(&pair)?;
            if places.ordered != count {
                continue;
            }
            places.ordered = 0;
            if places.count == count {
                return Some((pair, std::mem::take(&mut places.lists)));
            }
            if places.count > 1 {
                places.ordered = places.count;
                self.order.push((places.count, Reverse(pair)));
            }
        }
        None
    }

    fn replace(&mut self, pair: Pair, lists: &[usize], new: u32) {
        for &list in lists {
            let items = &self.lists[list].1;
            let at = |part| items.iter().position(|item| item.part == part);
            let (Some(i), Some(j)) = (at(pair.a), at(pair.b)) else { continue };
            if Pair::of(items[i], items[j]) != pair {
                continue;
            }
            let mut items = items.clone();
            let (x, y) = (items[i], items[j]);
            items.remove(i.max(j));
            items.remove(i.min(j));
            self.lost(pair);
            let z = Item { part: new, negative: x.negative };
            for &other in &items {
                self.lost(Pair::of(x, other));
                self.lost(Pair::of(y, other));
                self.found(Pair::of(z, other), list);
            }
            items.push(z);
            self.lists[list].1 = items;
        }
    }
}
