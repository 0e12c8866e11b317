use crate::{Assembly, AssemblyState, Solver, SparseDla};
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
    format!(
        "the method is for systems of a few coordinates; for trains and other large systems take {others} or {last}"
    )
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

/// A symmetric composition of the steps of an assembly, `S_(g_1 h) S_(g_2 h) .. S_(g_n h)`, with the weights of
/// [`dla::Composition`].
#[derive(Debug)]
pub struct SparseComposition {
    base: SparseDla,
    weights: Vec<f64>,
    inner: AssemblyState,
}

impl SparseComposition {
    /// The composition of order 4, 6 or 8: five stages of Suzuki, nine of Kahan and Li, fifteen of Suzuki and Umeno.
    ///
    /// # Errors
    /// [`StepError::Unsupported`] for other orders; as [`SparseDla::new`].
    pub fn new(assembly: &Assembly, solver: Solver, order: u32) -> Result<Self, StepError> {
        let weights = match order {
            4 => dla::Composition::suzuki4(()).weights().to_vec(),
            6 => dla::Composition::kahan_li6(()).weights().to_vec(),
            8 => dla::Composition::fifteen8(()).weights().to_vec(),
            _ => return Err(StepError::Unsupported { reason: "compositions have the orders 4, 6 and 8" }),
        };
        Ok(Self { base: SparseDla::new(assembly, solver)?, weights, inner: AssemblyState::new(assembly, &[], &[]) })
    }
}

impl AssemblyMethod for SparseComposition {
    fn step(&mut self, assembly: &Assembly, t: f64, h: f64, state: &mut AssemblyState) -> Result<u32, StepError> {
        self.inner.copy_from(state);
        let (mut iterations, mut done) = (0, 0.0);
        for weight in &self.weights {
            iterations += self.base.step(assembly, t + done * h, weight * h, &mut self.inner)?;
            done += weight;
        }
        std::mem::swap(state, &mut self.inner);
        Ok(iterations)
    }
}
