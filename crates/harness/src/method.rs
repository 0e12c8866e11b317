use dla::Substeps;
use lagrangian::{Alpha, AnyRule, Midpoint, NotAWeight, Trapezoid};
use thiserror::Error;

/// What is known of a method by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MethodInfo {
    /// Which one it is.
    pub kind: Kind,
    /// The name in files and commands.
    pub name: &'static str,
    /// The order of accuracy.
    pub order: u32,
    /// What it keeps to round-off.
    pub keeps: &'static str,
    /// What it is.
    pub summary: &'static str,
    /// Where it comes from.
    pub reference: &'static str,
}

/// Every method, in the order in which tables show them.
pub const METHODS: &[MethodInfo] = &[
    MethodInfo {
        kind: Kind::Dla,
        name: "dla",
        order: 2,
        keeps: "constraint",
        summary: "discrete Lagrange-d'Alembert, midpoint rule, self-adjoint (the default)",
        reference: "Cortes and Martinez 2001, Nonlinearity 14, 1365-1392",
    },
    MethodInfo {
        kind: Kind::DlaTrapezoid,
        name: "dla-trapezoid",
        order: 2,
        keeps: "constraint",
        summary: "discrete Lagrange-d'Alembert, trapezoidal rule, self-adjoint",
        reference: "Cortes and Martinez 2001, Nonlinearity 14, 1365-1392",
    },
    MethodInfo {
        kind: Kind::DlaAlpha,
        name: "dla-alpha",
        order: 1,
        keeps: "constraint",
        summary: "discrete Lagrange-d'Alembert, one node at the fraction `alpha` of the step; order 2 at alpha = 0.5 only",
        reference: "Marsden and West 2001, Acta Numerica 10, section 2.3",
    },
    MethodInfo {
        kind: Kind::Dla4,
        name: "dla4",
        order: 4,
        keeps: "constraint",
        summary: "five steps of dla, Suzuki's composition",
        reference: "Suzuki 1990, Phys. Lett. A 146, 319-323",
    },
    MethodInfo {
        kind: Kind::Dla6,
        name: "dla6",
        order: 6,
        keeps: "constraint",
        summary: "nine steps of dla, the composition of Kahan and Li",
        reference: "Kahan and Li 1997, Math. Comp. 66, 1089-1099",
    },
    MethodInfo {
        kind: Kind::Dla8,
        name: "dla8",
        order: 8,
        keeps: "constraint",
        summary: "fifteen steps of dla, composed",
        reference: "Hairer, Lubich and Wanner 2006, (V.3.12)",
    },
    MethodInfo {
        kind: Kind::Lobatto3,
        name: "lobatto3",
        order: 4,
        keeps: "constraint",
        summary: "variational Lobatto IIIA-IIIB pair with 3 stages, self-adjoint, on any system",
        reference: "Jay 2003, BIT 43, 93-106",
    },
    MethodInfo {
        kind: Kind::Lobatto4,
        name: "lobatto4",
        order: 6,
        keeps: "constraint",
        summary: "variational Lobatto IIIA-IIIB pair with 4 stages, self-adjoint, on any system",
        reference: "Jay 2003, BIT 43, 93-106",
    },
    MethodInfo {
        kind: Kind::Lobatto5,
        name: "lobatto5",
        order: 8,
        keeps: "constraint",
        summary: "variational Lobatto IIIA-IIIB pair with 5 stages, self-adjoint, on any system",
        reference: "Jay 2003, BIT 43, 93-106",
    },
    MethodInfo {
        kind: Kind::Gauss4,
        name: "gauss4",
        order: 4,
        keeps: "constraint",
        summary: "Gauss collocation with 2 stages, in a basis of admissible velocities",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.3",
    },
    MethodInfo {
        kind: Kind::Gauss6,
        name: "gauss6",
        order: 6,
        keeps: "constraint",
        summary: "Gauss collocation with 3 stages, in a basis of admissible velocities",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.3",
    },
    MethodInfo {
        kind: Kind::Gauss8,
        name: "gauss8",
        order: 8,
        keeps: "constraint",
        summary: "Gauss collocation with 4 stages, in a basis of admissible velocities",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.3",
    },
    MethodInfo {
        kind: Kind::Gauss10,
        name: "gauss10",
        order: 10,
        keeps: "constraint",
        summary: "Gauss collocation with 5 stages, in a basis of admissible velocities",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.3",
    },
    MethodInfo {
        kind: Kind::Gauss12,
        name: "gauss12",
        order: 12,
        keeps: "constraint",
        summary: "Gauss collocation with 6 stages, in a basis of admissible velocities",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.3",
    },
    MethodInfo {
        kind: Kind::Gauss14,
        name: "gauss14",
        order: 14,
        keeps: "constraint",
        summary: "Gauss collocation with 7 stages, in a basis of admissible velocities",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.3",
    },
    MethodInfo {
        kind: Kind::Gauss16,
        name: "gauss16",
        order: 16,
        keeps: "constraint",
        summary: "Gauss collocation with 8 stages, in a basis of admissible velocities",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.3",
    },
    MethodInfo {
        kind: Kind::GaussAdaptive,
        name: "gauss-adaptive",
        order: 16,
        keeps: "constraint",
        summary: "Gauss collocation with 8 stages in steps of its own, as a tolerance asks for",
        reference: "compare Antonana, Makazaga and Murua 2017, Numer. Algorithms 76, 861-880",
    },
    MethodInfo {
        kind: Kind::Taylor,
        name: "taylor",
        order: 20,
        keeps: "constraint",
        summary: "Taylor series in the axes of a sleigh that is free, in a round well or pushed constantly, in steps of its own",
        reference: "Jorba and Zou 2005, Experimental Mathematics 14, 99-117",
    },
    MethodInfo {
        kind: Kind::Energy2,
        name: "energy2",
        order: 2,
        keeps: "constraint, energy",
        summary: "discrete gradient method on the dual of the distribution, averaged gradient, self-adjoint",
        reference: "Celledoni, Farre Puiggali, Hoiseth and Martin de Diego 2019, J. Nonlinear Sci. 29, 1523-1562",
    },
    MethodInfo {
        kind: Kind::Energy4,
        name: "energy4",
        order: 4,
        keeps: "constraint, energy",
        summary: "energy-preserving collocation with 2 stages on the dual of the distribution",
        reference: "Cohen and Hairer 2011, BIT 51, 91-101",
    },
    MethodInfo {
        kind: Kind::Energy6,
        name: "energy6",
        order: 6,
        keeps: "constraint, energy",
        summary: "energy-preserving collocation with 3 stages on the dual of the distribution",
        reference: "Cohen and Hairer 2011, BIT 51, 91-101",
    },
    MethodInfo {
        kind: Kind::Energy8,
        name: "energy8",
        order: 8,
        keeps: "constraint, energy",
        summary: "energy-preserving collocation with 4 stages on the dual of the distribution",
        reference: "Cohen and Hairer 2011, BIT 51, 91-101",
    },
    MethodInfo {
        kind: Kind::Gni,
        name: "gni",
        order: 2,
        keeps: "constraint at nodes",
        summary: "counter-example: geometric nonholonomic integrator, whose hidden multiplier mode grows about stable motions",
        reference: "Ferraro, Iglesias and Martin de Diego 2008, Nonlinearity 21, 1911-1928",
    },
    MethodInfo {
        kind: Kind::Rk4,
        name: "rk4",
        order: 4,
        keeps: "nothing",
        summary: "baseline: classical Runge-Kutta in full coordinates, multiplier eliminated by index reduction",
        reference: "Kutta 1901; Hairer and Wanner 1996, section VII.1",
    },
    MethodInfo {
        kind: Kind::Rk4Projected,
        name: "rk4-projected",
        order: 4,
        keeps: "constraint",
        summary: "baseline: rk4 with the velocity projected onto the constraint after every step",
        reference: "Hairer, Lubich and Wanner 2006, section IV.4",
    },
    MethodInfo {
        kind: Kind::Rk4Reduced,
        name: "rk4-reduced",
        order: 4,
        keeps: "constraint",
        summary: "baseline: classical Runge-Kutta on the reduced equations, in a basis of admissible velocities",
        reference: "Bloch 2015, Nonholonomic Mechanics and Control, section 5.2",
    },
    MethodInfo {
        kind: Kind::ImplicitMidpoint,
        name: "implicit-midpoint",
        order: 2,
        keeps: "nothing",
        summary: "baseline: implicit midpoint rule in full coordinates, multiplier eliminated by index reduction",
        reference: "Hairer, Lubich and Wanner 2006, section II.1.2",
    },
    MethodInfo {
        kind: Kind::Dop853,
        name: "dop853",
        order: 8,
        keeps: "constraint",
        summary: "baseline: adaptive Dormand-Prince 8(5,3) on the reduced equations, tolerance 1e-12 within each step",
        reference: "Hairer, Norsett and Wanner 1993, section II.10",
    },
];

/// The methods, as a program tells them apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `dla`
    Dla,
    /// `dla-trapezoid`
    DlaTrapezoid,
    /// `dla-alpha`
    DlaAlpha,
    /// `dla4`
    Dla4,
    /// `dla6`
    Dla6,
    /// `dla8`
    Dla8,
    /// `lobatto3`
    Lobatto3,
    /// `lobatto4`
    Lobatto4,
    /// `lobatto5`
    Lobatto5,
    /// `gauss4`
    Gauss4,
    /// `gauss6`
    Gauss6,
    /// `gauss8`
    Gauss8,
    /// `gauss10`
    Gauss10,
    /// `gauss12`
    Gauss12,
    /// `gauss14`
    Gauss14,
    /// `gauss16`
    Gauss16,
    /// `gauss-adaptive`
    GaussAdaptive,
    /// `taylor`
    Taylor,
    /// `energy2`
    Energy2,
    /// `energy4`
    Energy4,
    /// `energy6`
    Energy6,
    /// `energy8`
    Energy8,
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

impl Kind {
    /// Whether the method chooses steps of its own within a step of the run, by a tolerance.
    #[must_use]
    pub fn is_adaptive(self) -> bool {
        matches!(self, Self::GaussAdaptive | Self::Taylor | Self::Dop853)
    }
}

/// A method, ready to integrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    info: MethodInfo,
    alpha: Alpha,
    tolerance: f64,
    substeps: Option<Substeps>,
}

/// A method that there is not.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MethodError {
    /// No method has this name.
    #[error("{}; the methods are {}", unknown(name), names().join(", "))]
    Unknown {
        /// What was asked for.
        name: String,
    },
    /// The weight of `dla-alpha` is not between 0 and 1.
    #[error(transparent)]
    Alpha(#[from] NotAWeight),
    /// The tolerance of an adaptive method is not a positive number.
    #[error("the tolerance must be positive and finite, and is {tolerance}")]
    Tolerance {
        /// What was given.
        tolerance: f64,
    },
}

/// What is wrong with a name that no method has.
fn unknown(name: &str) -> String {
    if name.is_empty() { "an empty name is not a method".to_owned() } else { format!("unknown method `{name}`") }
}

fn names() -> Vec<&'static str> {
    METHODS.iter().map(|info| info.name).collect()
}

impl Method {
    /// The tolerance of the [adaptive](Kind::is_adaptive) methods where none is given, relative and absolute: an error of `1e-12 (1 + |y|)`
    /// in every step of a component `y`.
    pub const TOLERANCE: f64 = 1e-12;

    /// The method of that name; `alpha` is the weight of `dla-alpha`, `1/2` where none is given.
    ///
    /// # Errors
    /// [`MethodError`] where the name is unknown, or the weight not between 0 and 1.
    pub fn named(name: &str, alpha: Option<f64>) -> Result<Self, MethodError> {
        let found = METHODS.iter().find(|info| info.name == name);
        let mut info = *found.ok_or_else(|| MethodError::Unknown { name: name.to_owned() })?;
        let alpha = Alpha::new(alpha.unwrap_or(0.5))?;
        if info.kind == Kind::DlaAlpha && alpha.is_symmetric() {
            // The one weight that makes the rule symmetric.
            info.order = 2;
        }
        Ok(Self { info, alpha, tolerance: Self::TOLERANCE, substeps: None })
    }

    /// The method of that name with the settings of a run: `alpha` as in [`named`](Self::named), and the tolerance of an adaptive method,
    /// [`TOLERANCE`](Self::TOLERANCE) where none is given.
    ///
    /// # Errors
    /// [`MethodError`].
    pub fn of(name: &str, alpha: Option<f64>, tolerance: Option<f64>) -> Result<Self, MethodError> {
        Self::named(name, alpha)?.with_tolerance(tolerance.unwrap_or(Self::TOLERANCE))
    }

    /// `dla`, the first row of the table, with the same settings.
    pub(crate) fn as_dla(&self) -> Self {
        Self { info: METHODS[0], ..*self }
    }

    /// The same method, none of whose steps is divided.
    #[must_use]
    pub fn undivided(self) -> Self {
        Self { substeps: None, ..self }
    }

    /// The same method with another tolerance, which only [adaptive](Kind::is_adaptive) ones read.
    ///
    /// # Errors
    /// [`MethodError::Tolerance`] unless it is positive and finite.
    pub fn with_tolerance(self, tolerance: f64) -> Result<Self, MethodError> {
        if tolerance > 0.0 && tolerance.is_finite() {
            Ok(Self { tolerance, ..self })
        } else {
            Err(MethodError::Tolerance { tolerance })
        }
    }

    /// The same method for the tolerance that a run is asked for, if any: an adaptive one aims for it in each of its steps; the step of any
    /// other is to be found by [`recommend`](crate::recommend), and the method stays as it is.
    ///
    /// # Errors
    /// As [`with_tolerance`](Self::with_tolerance).
    pub fn aiming_for(self, tolerance: Option<f64>) -> Result<Self, MethodError> {
        tolerance.filter(|_| self.is_adaptive()).map_or(Ok(self), |tolerance| self.with_tolerance(tolerance))
    }

    /// The same method, whose steps are made in parts where it cannot make them whole, or where a whole one does not resolve the
    /// motion ([`Halved`](dla::Halved)). Runs that are integrated piece by piece heed it, as all do that are measured; each step
    /// then takes the time of three.
    #[must_use]
    pub fn with_substeps(self, substeps: Substeps) -> Self {
        Self { substeps: Some(substeps), ..self }
    }

    /// How far its steps may be divided; none where they may not.
    #[must_use]
    pub fn substeps(&self) -> Option<Substeps> {
        self.substeps
    }

    /// Name, order and source.
    #[must_use]
    pub fn info(&self) -> MethodInfo {
        self.info
    }

    /// The tolerance of an adaptive method.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Whether it chooses steps of its own.
    #[must_use]
    pub fn is_adaptive(&self) -> bool {
        self.info.kind.is_adaptive()
    }

    /// The rule of the discrete constraint: the midpoint rule, but for `dla-trapezoid` and `dla-alpha`.
    pub(crate) fn rule(&self) -> AnyRule {
        match self.info.kind {
            Kind::DlaTrapezoid => Trapezoid.into(),
            Kind::DlaAlpha => self.alpha.into(),
            _ => Midpoint.into(),
        }
    }

    /// The rule of `dla-alpha`.
    #[must_use]
    pub fn alpha(&self) -> Alpha {
        self.alpha
    }
}
