#![allow(clippy::float_cmp, reason = "a coefficient is one where its bits are")]

use super::operation::{Instruction, Operation};
use super::plan::{Item, Plan, Step};
use crate::graph::{Expression, Graph};
use crate::{Error, Function};
use std::collections::HashMap;

/// Operations one after another, each with a place of its own for its result; the inputs come first.
#[derive(Debug, Default)]
pub(crate) struct Program {
    pub(crate) instructions: Vec<Instruction>,
    pub(crate) constants: Vec<f64>,
    pub(crate) inputs: u32,
    pub(crate) places: u32,
    numbers: HashMap<u64, u32>,
    /// Where the results of steps are.
    results: Vec<Option<u32>>,
    /// Steps for the sine and the cosine of a step.
    circles: HashMap<u32, [Option<u32>; 2]>,
}

impl Program {
    pub(crate) fn new(graph: &Graph, outputs: &[Expression]) -> Result<Self, Error> {
        let mut plan = Plan::new(graph, outputs)?;
        plan.take_factors_out();
        plan.share_pairs();
        let uses = plan.uses();
        let mut program = Self { results: vec![None; plan.steps.len()], ..Self::default() };
        for (k, step) in plan.steps.iter().enumerate().filter(|&(k, _)| uses[k] > 0) {
            match *step {
                Step::Variable(variable) => {
                    program.results[k] = Some(variable);
                    program.inputs = program.inputs.max(variable + 1);
                }
                Step::Call(Function::Sin, a, _) => program.circles.entry(a).or_default()[0] = Some(k as u32),
                Step::Call(Function::Cos, a, _) => program.circles.entry(a).or_default()[1] = Some(k as u32),
                _ => {}
            }
        }
        program.places = program.inputs;
        for (k, &output) in plan.outputs.iter().enumerate() {
            let a = program.computed(&plan, output);
            program.instructions.push(Instruction { to: k as u32, operation: Operation::Output { a } });
        }
        program.join_products();
        Ok(program)
    }

    /// The place of a step, after all that it needs: a search with a list of its own, however deep steps are within each other.
    fn computed(&mut self, plan: &Plan, step: u32) -> u32 {
        let mut waiting = vec![(step, false)];
        while let Some((step, ready)) = waiting.pop() {
            if self.results[step as usize].is_some() {
                continue;
            }
            if ready {
                let place = self.emitted(&plan.steps[step as usize]);
                // A sine or a cosine may have been noted with its partner.
                self.results[step as usize].get_or_insert(place);
            } else {
                waiting.push((step, true));
                waiting.extend(plan.steps[step as usize].parts().into_iter().rev().map(|part| (part, false)));
            }
        }
        self.result(step)
    }

    fn result(&self, step: u32) -> u32 {
        self.results[step as usize].unwrap_or(0)
    }

    fn emit(&mut self, operation: Operation) -> u32 {
        let to = self.new_place();
        self.instructions.push(Instruction { to, operation });
        to
    }

    fn new_place(&mut self) -> u32 {
        self.places += 1;
        self.places - 1
    }

    fn number(&mut self, x: f64) -> u32 {
        let next = self.constants.len() as u32;
        let k = *self.numbers.entry(x.to_bits()).or_insert(next);
        if k == next {
            self.constants.push(x);
        }
        k
    }

    fn emitted(&mut self, step: &Step) -> u32 {
        match *step {
            Step::Constant(x) => {
                let k = self.number(x);
                self.emit(Operation::Constant { k })
            }
            Step::Variable(variable) => variable,
            Step::Combination(constant, ref parts) => self.combination(constant, parts),
            Step::Sum(ref items) => {
                let coefficient = |item: &Item| if item.negative { -1.0 } else { 1.0 };
                let parts: Vec<_> = items.iter().map(|item| (item.part, coefficient(item))).collect();
                self.combination(0.0, &parts)
            }
            Step::Product(ref items) => {
                let mut places = items.iter().map(|item| self.results[item.part as usize].unwrap_or(0));
                let first = places.next().unwrap_or(0);
                places.collect::<Vec<_>>().into_iter().fold(first, |a, b| self.emit(Operation::Multiply { a, b }))
            }
            Step::Divide(a, b) => self.emit(Operation::Divide { a: self.result(a), b: self.result(b) }),
            Step::Invert(a) => self.emit(Operation::Invert { a: self.result(a) }),
            Step::Square(a) => self.emit(Operation::Square { a: self.result(a) }),
            Step::Length(a) => self.emit(Operation::Length { a: self.result(a) }),
            Step::Whole(a, n) => self.emit(Operation::Whole { a: self.result(a), n }),
            Step::Real(a, p) => {
                let k = self.number(p);
                self.emit(Operation::Real { a: self.result(a), k })
            }
            Step::Flat(a, p) => {
                let k = self.number(p);
                self.emit(Operation::Flat { a: self.result(a), k })
            }
            Step::Call(function, u, v) => {
                let (a, b) = (self.result(u), self.result(v));
                if let (Function::Sin | Function::Cos, Some(&[Some(sin), Some(cos)])) = (function, self.circles.get(&u))
                {
                    let both = [self.new_place(), self.new_place()];
                    let operation = Operation::SinCos { a, cos: both[1] };
                    self.instructions.push(Instruction { to: both[0], operation });
                    self.results[sin as usize] = Some(both[0]);
                    self.results[cos as usize] = Some(both[1]);
                    return both[usize::from(function == Function::Cos)];
                }
                self.emit(Operation::Call { function, a, b })
            }
        }
    }

    /// A constant and parts with coefficients, from the first part that need not be turned round.
    fn combination(&mut self, constant: f64, parts: &[(u32, f64)]) -> u32 {
        let start = parts.iter().position(|&(_, c)| c == 1.0).or_else(|| parts.iter().position(|&(_, c)| c > 0.0));
        let first = start.unwrap_or(0);
        let Some(&(part, c)) = parts.get(first) else {
            let k = self.number(constant);
            return self.emit(Operation::Constant { k });
        };
        let a = self.result(part);
        let mut constant = constant;
        let mut sum = if c == 1.0 {
            a
        } else if c == -1.0 && constant != 0.0 {
            let k = self.number(std::mem::take(&mut constant));
            self.emit(Operation::From { a, k })
        } else if c == -1.0 {
            self.emit(Operation::Negate { a })
        } else {
            let k = self.number(c);
            self.emit(Operation::Times { a, k })
        };
        for (_, &(part, c)) in parts.iter().enumerate().filter(|&(i, _)| i != first) {
            let (a, b) = (sum, self.result(part));
            sum = if c == 1.0 {
                self.emit(Operation::Add { a, b })
            } else if c == -1.0 {
                self.emit(Operation::Subtract { a, b })
            } else {
                let k = self.number(c);
                self.emit(Operation::PlusTimes { a, b, k })
            };
        }
        if constant != 0.0 {
            let k = self.number(constant);
            sum = self.emit(Operation::Plus { a: sum, k });
        }
        sum
    }

    /// How often each place is read.
    pub(crate) fn reads(&self) -> Vec<u32> {
        let mut reads = vec![0; self.places as usize];
        for instruction in &self.instructions {
            let [a, b, c] = instruction.operation.reads();
            for (place, new) in [(a, true), (b, b != a), (c, c != b && c != a)] {
                if let Some(count) = reads.get_mut(place as usize).filter(|_| new) {
                    *count += 1;
                }
            }
        }
        reads
    }

    /// Makes one operation of a product and the sum that alone needs it: half as many to choose from at run time.
    fn join_products(&mut self) {
        let reads = self.reads();
        let mut products: HashMap<u32, (usize, u32, u32)> = HashMap::new();
        let mut gone = vec![false; self.instructions.len()];
        for at in 0..self.instructions.len() {
            let Instruction { to, operation } = self.instructions[at];
            let mut join = |p: u32, c: u32, minus: bool| {
                let (product, a, b) = products.remove(&p).filter(|_| p != c)?;
                gone[product] = true;
                Some(if minus { Operation::MinusProduct { a, b, c } } else { Operation::PlusProduct { a, b, c } })
            };
            let joined = match operation {
                Operation::Multiply { a, b } if reads[to as usize] == 1 => {
                    products.insert(to, (at, a, b));
                    None
                }
                Operation::Add { a, b } => join(b, a, false).or_else(|| join(a, b, false)),
                Operation::Subtract { a, b } => join(b, a, true),
                _ => None,
            };
            if let Some(operation) = joined {
                self.instructions[at].operation = operation;
            }
        }
        let mut gone = gone.into_iter();
        self.instructions.retain(|_| !gone.next().unwrap_or(false));
    }
}
