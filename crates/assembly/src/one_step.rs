use crate::{Assembly, AssemblyState, Solver, SparseComposition, SparseDla};
use dla::{METHODS, MethodKind, StepError};
use std::sync::LazyLock;

/// A one-step map on the constraint distribution of an assembly.
pub trait AssemblyMethod {
    /// Moves `state` from time `t` to `t + h` (s); returns the number of Newton iterations.
    ///
    /// # Errors
    /// [`StepError`] where the step has no solution that the method accepts; `state` is then unchanged.
    fn step(&mut self, assembly: &Assembly, t: f64, h: f64, state: &mut AssemblyState) -> Result<u32, StepError>;
}

/// The reason for a refusal.
static OTHERS: LazyLock<String> = LazyLock::new(|| {
    let able: Vec<&str> = METHODS.iter().filter(|info| info.assemblies).map(|info| info.name).collect();
    let (last, others) = able.split_last().map_or(("none", &[][..]), |(last, others)| (*last, others));
    let others = others.join(", ");
    format!("the method is for systems of a few coordinates; for trains and other assemblies take {others} or {last}")
});

/// The method of that kind for an assembly.
///
/// # Errors
/// [`StepError::Unsupported`] for one that does none; as [`SparseDla::new`].
pub fn assembly_method(assembly: &Assembly, kind: MethodKind) -> Result<Box<dyn AssemblyMethod>, StepError> {
    let best = Solver::Best;
    match kind {
        MethodKind::Dla => SparseDla::new(assembly, best).map(|method| Box::new(method) as _),
        MethodKind::Composed(order) => {
            SparseComposition::new(assembly, best, order).map(|method| Box::new(method) as _)
        }
        _ => Err(StepError::Unsupported { reason: OTHERS.as_str() }),
    }
}
