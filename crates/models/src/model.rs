use lagrangian::{Scalar, System, energy};

/// A configuration `q` and a velocity `v`.
pub type ModelState<const N: usize> = ([f64; N], [f64; N]);

/// What is known of a system beyond its equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Labels {
    /// The Lagrangian is even in the velocities, and with a linear constraint the flow is then reversed by
    /// `(q, p) -> (q, -p)`.
    pub reversible: bool,
    /// The velocities follow from known integrals, by quadratures or a linear equation.
    pub integrable: bool,
    /// The flow on the constraint has an invariant measure of smooth positive density, [`Model::density`].
    pub invariant_measure: bool,
}

/// A system of the literature, with what is known of it.
pub trait Model<const N: usize, const M: usize>: System<N, M> + Sized {
    /// A name for people.
    fn name(&self) -> &'static str;

    /// Where the system and its equations are found.
    fn source(&self) -> &'static str;

    /// What kind of system it is, for these parameters.
    fn labels(&self) -> Labels;

    /// The standard start: a configuration, and an admissible velocity.
    fn start(&self) -> ModelState<N>;

    /// An admissible state made of any coordinates and quasi-velocities: as they are, in [`System::admissible_basis`], unless
    /// the constraints bind positions or have no basis.
    fn admissible(&self, q: [f64; N], xi: [f64; N]) -> ModelState<N> {
        let v = self.admissible_basis(0.0, &q).map_or([0.0; N], |basis| basis.combine(&xi));
        (q, v)
    }

    /// The accelerations at an admissible velocity, from the reduced equations worked out on paper.
    ///
    /// Nothing in it comes from the Lagrangian by machine, so that each can be held against the other.
    fn accelerations_by_hand(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; N];

    /// The integrals of the motion, by name; the first is the energy, or what is kept in its place.
    fn invariants<S: Scalar>(&self, q: &[S; N], v: &[S; N]) -> Vec<(&'static str, S)> {
        vec![("energy", energy(self, S::zero(), q, v))]
    }

    /// The density of the invariant measure `density(q) dq dxi`, where there is a smooth one.
    ///
    /// `xi` are the quasi-velocities in [`System::admissible_basis`].
    fn density<S: Scalar>(&self, _q: &[S; N]) -> Option<S> {
        None
    }

    /// How far the coordinates are from where they end, as angles do that are singular at some attitude: one far from it, zero
    /// there, continuous between. One everywhere by default, for coordinates that end nowhere, as those of every model here.
    ///
    /// A method by itself does not ask: near the end it may go on with any error. A model that overrides this is run by
    /// `dla::InChart::new(method, chart, Model::regularity)`, whose steps are refused there.
    fn regularity(&self, _q: &[f64; N]) -> f64 {
        1.0
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
