use crate::{Assembly, AssemblyMethod, AssemblyState, Solver, SparseDla};
use dla::StepError;

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
