use lagrangian::{Alpha, NotAWeight};
use thiserror::Error;

/// What is known of a method by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MethodInfo {
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
        name: "dla",
        order: 2,
        keeps: "constraint",
        summary: "discrete Lagrange-d'Alembert, midpoint rule, self-adjoint (the default)",
        reference: "Cortes and Martinez 2001, Nonlinearity 14, 1365-1392",
    },
    MethodInfo {
        name: "dla-trapezoid",
        order: 2,
        keeps: "constraint",
        summary: "discrete Lagrange-d'Alembert, trapezoidal rule, self-adjoint",
        reference: "Cortes and Martinez 2001, Nonlinearity 14, 1365-1392",
    },
    MethodInfo {
        name: "dla-alpha",
        order: 1,
        keeps: "constraint",
        summary: "discrete Lagrange-d'Alembert, one node at the fraction `alpha` of the step; order 2 at alpha = 0.5 only",
        reference: "Marsden and West 2001, Acta Numerica 10, section 2.3",
    },
    MethodInfo {
        name: "rk4",
        order: 4,
        keeps: "nothing",
        summary: "baseline: classical Runge-Kutta in full coordinates, multiplier eliminated by index reduction",
        reference: "Kutta 1901; Hairer and Wanner 1996, section VII.1",
    },
    MethodInfo {
        name: "rk4-projected",
        order: 4,
        keeps: "constraint",
        summary: "baseline: rk4 with the velocity projected onto the constraint after every step",
        reference: "Hairer, Lubich and Wanner 2006, section IV.4",
    },
    MethodInfo {
        name: "rk4-reduced",
        order: 4,
        keeps: "constraint",
        summary: "baseline: classical Runge-Kutta on the reduced equations, in a basis of admissible velocities",
        reference: "Bloch 2015, Nonholonomic Mechanics and Control, section 5.2",
    },
];

/// A method, ready to integrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// `dla`
    Dla,
    /// `dla-trapezoid`
    DlaTrapezoid,
    /// `dla-alpha`
    DlaAlpha(Alpha),
    /// `rk4`
    Rk4,
    /// `rk4-projected`
    Rk4Projected,
    /// `rk4-reduced`
    Rk4Reduced,
}

/// A method that there is not.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MethodError {
    /// No method has this name.
    #[error("unknown method `{name}`; the methods are {}", names().join(", "))]
    Unknown {
        /// What was asked for.
        name: String,
    },
    /// The weight of `dla-alpha` is no weight.
    #[error(transparent)]
    Alpha(#[from] NotAWeight),
}

fn names() -> Vec<&'static str> {
    METHODS.iter().map(|info| info.name).collect()
}

impl Method {
    /// The method of that name; `alpha` is the weight of `dla-alpha`, `1/2` where none is given.
    ///
    /// # Errors
    /// [`MethodError`] where the name or the weight is none.
    pub fn named(name: &str, alpha: Option<f64>) -> Result<Self, MethodError> {
        Ok(match name {
            "dla" => Self::Dla,
            "dla-trapezoid" => Self::DlaTrapezoid,
            "dla-alpha" => Self::DlaAlpha(Alpha::new(alpha.unwrap_or(0.5))?),
            "rk4" => Self::Rk4,
            "rk4-projected" => Self::Rk4Projected,
            "rk4-reduced" => Self::Rk4Reduced,
            _ => return Err(MethodError::Unknown { name: name.to_owned() }),
        })
    }

    /// Name, order and source.
    #[must_use]
    pub fn info(&self) -> MethodInfo {
        let index = match self {
            Self::Dla => 0,
            Self::DlaTrapezoid => 1,
            Self::DlaAlpha(..) => 2,
            Self::Rk4 => 3,
            Self::Rk4Projected => 4,
            Self::Rk4Reduced => 5,
        };
        let mut info = METHODS[index];
        // The one weight that makes the rule symmetric.
        if matches!(self, Self::DlaAlpha(rule) if rule.is_symmetric()) {
            info.order = 2;
        }
        info
    }
}
