use expression::formulas::Formulas;
use expression::{Expression, Graph, Recurrences, Symbol, trace};
use lagrangian::{Reduced as _, System, from_fn, velocity_of};
use std::sync::Arc;

/// The reduced equations of a system as recurrences of Taylor coefficients, `q' = W xi + v_b` and `xi' = f(t, q, xi)`.
///
/// The unknowns are first the coordinates, then the quasi-velocities; those that the system has beyond them rest.
#[derive(Debug, Clone)]
pub struct ReducedSeries {
    /// The recurrences.
    pub recurrences: Arc<Recurrences>,
    /// How many of the unknowns are coordinates.
    pub coordinates: usize,
    /// The number of the first variable behind the unknowns, and the constant values of this variable and all that follow it.
    pub constants: (usize, Arc<[f64]>),
}

impl ReducedSeries {
    /// The constant in a variable: its number among the constants, and its value.
    pub(crate) fn constant(&self, variable: usize) -> Option<(usize, f64)> {
        let k = variable.checked_sub(self.constants.0)?;
        Some((k, *self.constants.1.get(k)?))
    }

    /// The same with other values of the constants, as many as it has.
    pub(crate) fn with_constants(self, values: &[f64]) -> Self {
        let (first, old) = self.constants;
        let values = old.iter().zip(values).map(|(_, x)| *x).collect();
        Self { constants: (first, values), ..self }
    }
}

/// Maximum number of terms and factors of all formulas.
const LARGEST: usize = 320_000;
const TOO_LARGE: &str = "the reduced equations, from which series are made, are too large";

/// The series of a system written in Rust: evaluated once on [symbols](Symbol), its functions become formulas.
pub(super) fn traced<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
) -> Result<ReducedSeries, &'static str> {
    let variables = |from: usize| -> [Symbol; N] { from_fn(|i| Symbol::variable((from + i) as u32)) };
    let by_hand = || {
        let (t, q, xi) = (Symbol::variable(0), variables(1), variables(1 + N));
        let rates = system.reduced().reduced_motion(t, &q, &xi)?;
        let velocity = velocity_of(system, t, &q, &xi).ok()?;
        Some(velocity.iter().chain(&rates[..N - M]).map(|x| x.expression()).collect())
    };
    // Formulas by hand that cannot be traced may have functions that can.
    let (rates, graph) = match trace(Graph::with_limit(LARGEST), by_hand) {
        (Ok(Some(rates)), graph) => (rates, graph),
        _ => derived(system)?,
    };
    let variables: Vec<u32> = (1..=rates.len() as u32).collect();
    let recurrences = Recurrences::new(&graph, &rates, &variables).map_err(|_| TOO_LARGE)?;
    Ok(ReducedSeries { recurrences: Arc::new(recurrences), coordinates: N, constants: (0, Arc::new([])) })
}

/// The rates of coordinates and quasi-velocities, derived from the formulas of Lagrangian, forces, constraint and basis.
fn derived<Sys: System<N, M>, const N: usize, const M: usize>(
    system: &Sys,
) -> Result<(Vec<Expression>, Graph), &'static str> {
    let all = |x: &[Symbol]| -> Vec<Expression> { x.iter().map(|x| x.expression()).collect() };
    let model = || {
        let (t, q): (_, [Symbol; N]) = (Symbol::variable(0), from_fn(|i| Symbol::variable((1 + i) as u32)));
        let v: [Symbol; N] = from_fn(|i| Symbol::variable((1 + N + i) as u32));
        let basis = system.admissible_basis(t, &q).ok_or("series need a basis of the admissible velocities")?;
        if system.nonlinear(t, &q, &v).is_some_and(|phi| phi.iter().any(Option::is_some)) {
            return Err("series need constraints that are affine in the velocities");
        }
        let (a, b) = system.constraint(t, &q);
        let force = system.force(t, &q, &v).map(|force| all(&force));
        let lagrangian = system.lagrangian(t, &q, &v).expression();
        Ok((lagrangian, all(a.as_flattened()), all(&b), force, all(basis.vectors()[..N - M].as_flattened())))
    };
    let (traced, graph) = trace(Graph::with_limit(LARGEST), model);
    let (lagrangian, rows, level, force, basis) = traced??;
    let (positions, outputs) = (Vec::new(), Vec::new());
    let mut formulas = Formulas {
        n: N,
        m: M,
        graph,
        lagrangian,
        rows,
        level,
        positions,
        force,
        basis: None,
        outputs,
        multipliers: None,
    };
    let reduced = formulas.reduced_in(basis.chunks(N).map(<[_]>::to_vec).collect()).ok_or(TOO_LARGE)?;
    Ok(([&reduced.velocity[..], &reduced.acceleration].concat(), formulas.graph))
}
