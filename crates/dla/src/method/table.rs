/// The families of methods, as a program tells them apart, with the number that tells the members of a family apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MethodKind {
    /// `dla`
    Dla,
    /// `dla-trapezoid`
    DlaTrapezoid,
    /// `dla-alpha`
    DlaAlpha,
    /// `dla4`, `dla6`, `dla8`: the composition of `dla` of that order
    Composed(u32),
    /// `lobatto3` to `lobatto5`, by their stages
    Lobatto(usize),
    /// `gauss4` to `gauss16`, by their stages, from two to eight
    Gauss(usize),
    /// `gauss-adaptive`
    GaussAdaptive,
    /// `taylor`
    Taylor,
    /// `energy2` to `energy8`, by their stages, from one to four
    Energy(usize),
    /// `gni`
    Gni,
    /// `rk4`
    Rk4,
    /// `rk4-projected`
    Rk4Projected,
    /// `rk4-reduced`
    Rk4Reduced,
    /// `implicit-midpoint`
    ImplicitMidpoint,
    /// `dop853`
    Dop853,
}

impl MethodKind {
    /// Whether the method chooses steps of its own within a step of the run, by a tolerance.
    #[must_use]
    pub fn is_adaptive(self) -> bool {
        matches!(self, Self::GaussAdaptive | Self::Taylor | Self::Dop853)
    }
}

/// The properties of a method: one row of [`METHODS`], from which every list of methods is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MethodInfo {
    /// Which one it is.
    pub kind: MethodKind,
    /// The name in files and commands.
    pub name: &'static str,
    /// The order of accuracy.
    pub order: u32,
    /// The quantities that it keeps to round-off.
    pub keeps: &'static str,
    /// A description.
    pub summary: &'static str,
    /// Where it comes from.
    pub reference: &'static str,
    /// Whether it makes steps of trains and other assemblies: `harness::assembly_method`.
    pub assemblies: bool,
    /// Whether its steps are differentiated for exponents (`harness::analysis::lyapunov`), or why not.
    pub tangent: Result<(), &'static str>,
}

const fn row(
    kind: MethodKind,
    (name, order): (&'static str, u32),
    keeps: &'static str,
    summary: &'static str,
    reference: &'static str,
) -> MethodInfo {
    MethodInfo { kind, name, order, keeps, summary, reference, assemblies: false, tangent: Ok(()) }
}

impl MethodInfo {
    const fn for_assemblies(self) -> Self {
        Self { assemblies: true, ..self }
    }

    const fn without_tangent(self, reason: &'static str) -> Self {
        Self { tangent: Err(reason), ..self }
    }
}

/// A row of a family, whose summary has the number of stages.
macro_rules! staged {
    ($kind:ident, $name:literal, $stages:literal, order $order:literal, $keeps:expr, $head:literal, $tail:literal, $reference:expr) => {
        row(
            MethodKind::$kind($stages),
            ($name, $order),
            $keeps,
            concat!($head, " with ", $stages, " stages", $tail),
            $reference,
        )
    };
}

macro_rules! gauss {
    ($name:literal, $stages:literal, $order:literal) => {
        staged!(
            Gauss,
            $name,
            $stages,
            order $order,
            CONSTRAINT,
            "Gauss collocation",
            ", in a basis of admissible velocities",
            "Hairer, Lubich and Wanner 2006, section II.1.3"
        )
    };
}

macro_rules! lobatto {
    ($name:literal, $stages:literal, $order:literal) => {
        staged!(
            Lobatto,
            $name,
            $stages,
            order $order,
            CONSTRAINT,
            "variational Lobatto IIIA-IIIB pair",
            ", self-adjoint, on any system",
            "Jay 2003, BIT 43, 93-106"
        )
    };
}

macro_rules! energy {
    ($name:literal, $stages:literal, $order:literal) => {
        staged!(
            Energy,
            $name,
            $stages,
            order $order,
            ENERGY,
            "energy-preserving collocation",
            " on the dual of the distribution",
            "Cohen and Hairer 2011, BIT 51, 91-101"
        )
    };
}

const CONSTRAINT: &str = "constraint";
const ENERGY: &str = "constraint, energy";
const NOTHING: &str = "nothing";
const CORTES: &str = "Cortes and Martinez 2001, Nonlinearity 14, 1365-1392";

const OWN_STEPS: &str = "the method chooses its steps from the state, so the number of steps jumps where the state \
    changes";
const OFF_THE_DISTRIBUTION: &str =
    "the method works in full coordinates and leaves the distribution, on which exponents are defined: take gauss4";
pub(super) const NOT_HERE: &str = "the steps of this method are not differentiated: take gauss8";
const NO_MAP: &str = "gni carries a multiplier from step to step, so its step is not a map of (q, v)";

/// Every method, in the order in which tables show them.
pub const METHODS: &[MethodInfo] = &[
    row(
        MethodKind::Dla,
        ("dla", 2),
        CONSTRAINT,
        "discrete Lagrange-d'Alembert, midpoint rule, self-adjoint (the default)",
        CORTES,
    )
    .for_assemblies(),
    row(
        MethodKind::DlaTrapezoid,
        ("dla-trapezoid", 2),
        CONSTRAINT,
        "discrete Lagrange-d'Alembert, trapezoidal rule, self-adjoint",
        CORTES,
    ),
    row(
        MethodKind::DlaAlpha,
        ("dla-alpha", 1),
        CONSTRAINT,
        "discrete Lagrange-d'Alembert, one node at the fraction `alpha` of the step; order 2 at alpha = 0.5 only",
        "Marsden and West 2001, Acta Numerica 10, section 2.3",
    ),
    row(
        MethodKind::Composed(4),
        ("dla4", 4),
        CONSTRAINT,
        "five steps of dla, Suzuki's composition",
        "Suzuki 1990, Phys. Lett. A 146, 319-323",
    )
    .for_assemblies(),
    row(
        MethodKind::Composed(6),
        ("dla6", 6),
        CONSTRAINT,
        "nine steps of dla, the composition of Kahan and Li",
        "Kahan and Li 1997, Math. Comp. 66, 1089-1099",
    )
    .for_assemblies(),
    row(
        MethodKind::Composed(8),
        ("dla8", 8),
        CONSTRAINT,
        "fifteen steps of dla, composed",
        "Hairer, Lubich and Wanner 2006, (V.3.12)",
    )
    .for_assemblies(),
    lobatto!("lobatto3", 3, 4).without_tangent(NOT_HERE),
    lobatto!("lobatto4", 4, 6).without_tangent(NOT_HERE),
    lobatto!("lobatto5", 5, 8).without_tangent(NOT_HERE),
    gauss!("gauss4", 2, 4),
    gauss!("gauss6", 3, 6),
    gauss!("gauss8", 4, 8),
    gauss!("gauss10", 5, 10),
    gauss!("gauss12", 6, 12),
    gauss!("gauss14", 7, 14),
    gauss!("gauss16", 8, 16),
    row(
        MethodKind::GaussAdaptive,
        ("gauss-adaptive", 16),
        CONSTRAINT,
        "Gauss collocation with 8 stages in steps of its own, as a tolerance asks for",
        "compare Antonana, Makazaga and Murua 2017, Numer. Algorithms 76, 861-880",
    )
    .without_tangent(OWN_STEPS),
    row(
        MethodKind::Taylor,
        ("taylor", 20),
        CONSTRAINT,
        "Taylor series of the reduced equations, in steps and to an order of its own; a sleigh that is free, in a round well or pushed \
        constantly has a series of its own, of order 20",
        "Jorba and Zou 2005, Experimental Mathematics 14, 99-117",
    ),
    row(
        MethodKind::Energy(1),
        ("energy2", 2),
        ENERGY,
        "discrete gradient method on the dual of the distribution, averaged gradient, self-adjoint",
        "Celledoni, Farre Puiggali, Hoiseth and Martin de Diego 2019, J. Nonlinear Sci. 29, 1523-1562",
    )
    .without_tangent(NOT_HERE),
    energy!("energy4", 2, 4).without_tangent(NOT_HERE),
    energy!("energy6", 3, 6).without_tangent(NOT_HERE),
    energy!("energy8", 4, 8).without_tangent(NOT_HERE),
    row(
        MethodKind::Gni,
        ("gni", 2),
        "constraint at nodes",
        "counter-example: geometric nonholonomic integrator, whose hidden multiplier mode grows about stable motions",
        "Ferraro, Iglesias and Martin de Diego 2008, Nonlinearity 21, 1911-1928",
    )
    .without_tangent(NO_MAP),
    row(
        MethodKind::Rk4,
        ("rk4", 4),
        NOTHING,
        "baseline: classical Runge-Kutta in full coordinates, multiplier eliminated by index reduction",
        "Kutta 1901; Hairer and Wanner 1996, section VII.1",
    )
    .without_tangent(OFF_THE_DISTRIBUTION),
    row(
        MethodKind::Rk4Projected,
        ("rk4-projected", 4),
        CONSTRAINT,
        "baseline: rk4 with the velocity projected onto the constraint after every step",
        "Hairer, Lubich and Wanner 2006, section IV.4",
    )
    .without_tangent(OFF_THE_DISTRIBUTION),
    row(
        MethodKind::Rk4Reduced,
        ("rk4-reduced", 4),
        CONSTRAINT,
        "baseline: classical Runge-Kutta on the reduced equations, in a basis of admissible velocities",
        "Bloch 2015, Nonholonomic Mechanics and Control, section 5.2",
    )
    .without_tangent(NOT_HERE),
    row(
        MethodKind::ImplicitMidpoint,
        ("implicit-midpoint", 2),
        NOTHING,
        "baseline: implicit midpoint rule in full coordinates, multiplier eliminated by index reduction",
        "Hairer, Lubich and Wanner 2006, section II.1.2",
    )
    .without_tangent(OFF_THE_DISTRIBUTION),
    row(
        MethodKind::Dop853,
        ("dop853", 8),
        CONSTRAINT,
        "baseline: adaptive Dormand-Prince 8(5,3) on the reduced equations, tolerance 1e-12 within each step",
        "Hairer, Norsett and Wanner 1993, section II.10",
    )
    .without_tangent(OWN_STEPS),
];
