use super::Tape;
use super::operation::{Instruction, Operation};
use super::program::Program;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Registers that hold no number any more, the first of them first.
#[derive(Debug, Default)]
struct Free {
    again: BinaryHeap<Reverse<u32>>,
    next: u32,
}

impl Free {
    fn take(&mut self) -> u32 {
        self.again.pop().map_or_else(
            || {
                self.next += 1;
                self.next - 1
            },
            |Reverse(register)| register,
        )
    }
}

/// The operations with their results in as few registers as live at the same time. The inputs have the first ones, in their order.
pub(crate) fn assigned(program: Program, outputs: usize) -> Tape {
    let mut last_read = vec![0; program.places as usize];
    for (at, instruction) in program.instructions.iter().enumerate() {
        for place in instruction.operation.reads() {
            if let Some(last) = last_read.get_mut(place as usize) {
                *last = at;
            }
        }
    }
    let mut registers: Vec<u32> = (0..program.places).collect();
    let mut free = Free { again: BinaryHeap::new(), next: program.inputs };
    // An input that no operation reads is there only because a later one is read.
    let mut read = vec![false; program.inputs as usize];
    for instruction in &program.instructions {
        for place in instruction.operation.reads() {
            if let Some(read) = read.get_mut(place as usize) {
                *read = true;
            }
        }
    }
    free.again.extend((0..program.inputs).filter(|&k| !read[k as usize]).map(Reverse));
    let mut instructions = Vec::with_capacity(program.instructions.len());
    for (at, &Instruction { to, operation }) in program.instructions.iter().enumerate() {
        let mut operation_in = operation.map(|place| registers[place as usize]);
        let mut reads = operation.reads();
        reads.sort_unstable();
        for (i, &place) in reads.iter().enumerate() {
            let again = i > 0 && reads[i - 1] == place;
            if !again && last_read.get(place as usize) == Some(&at) {
                free.again.push(Reverse(registers[place as usize]));
            }
        }
        if let Operation::Output { .. } = operation {
            instructions.push(Instruction { to, operation: operation_in });
            continue;
        }
        let register = free.take();
        registers[to as usize] = register;
        if let (Operation::SinCos { cos, .. }, Operation::SinCos { cos: second, .. }) = (operation, &mut operation_in) {
            *second = free.take();
            registers[cos as usize] = *second;
        }
        instructions.push(Instruction { to: register, operation: operation_in });
    }
    Tape {
        instructions: instructions.into(),
        constants: program.constants.into(),
        inputs: program.inputs as usize,
        scratch: free.next as usize,
        outputs,
    }
}
