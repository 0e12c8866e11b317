use lagrangian::{Scalar, System};

/// A configuration `q` and a velocity `v`.
pub type ModelState<const N: usize> = ([f64; N], [f64; N]);

/// A system of the literature, with its known solutions.
pub trait Model<const N: usize, const M: usize>: System<N, M> + Sized {
    /// A name for people.
    fn name(&self) -> &'static str;

    /// Whether `(q, p) -> (q, -p)` reverses the flow: so with a Lagrangian that is even in the velocities, and a linear constraint.
    fn reversible(&self) -> bool {
        true
    }

    /// The standard start: a configuration, and an admissible velocity.
    fn start(&self) -> ModelState<N>;

    /// An admissible state made of any coordinates and quasi-velocities: as they are, in [`System::admissible_basis`], unless
    /// the constraints bind positions or have no basis.
    fn admissible(&self, q: [f64; N], xi: [f64; N]) -> ModelState<N> {
        let v = self.admissible_basis(0.0, &q).map_or([0.0; N], |basis| basis.combine(&xi));
        (q, v)
    }

    /// Integrals of the motion beside the energy, by name.
    fn invariants<S: Scalar>(&self, _q: &[S; N], _v: &[S; N]) -> Vec<(&'static str, S)> {
        Vec::new()
    }

    /// The state a time `t` (s) after the given one, where the motion is known in closed form.
    fn exact_from(&self, _start: &ModelState<N>, _t: f64) -> Option<ModelState<N>> {
        None
    }

    /// The state a time `t` (s) after [`Model::start`], where the motion is known in closed form.
    fn exact(&self, t: f64) -> Option<ModelState<N>> {
        self.exact_from(&self.start(), t)
    }
}
