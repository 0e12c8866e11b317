use crate::element::{Element, ElementBlocks, local};
use dla::{Derivative, NotANumber, SystemFunction, Variable};
use lagrangian::linear::larger;
use lagrangian::{Dual, HyperDual, PowerSources, Scalar, Traced};
use std::fmt;

/// What joins bodies: constraints on positions, and no inertia.
pub trait Joint<const N: usize, const M: usize>: Send + Sync {
    /// The functions `g(q, t)` that vanish where the bodies are joined (m, or rad).
    fn position<S: Scalar>(&self, t: S, q: &[S; N]) -> [S; M];

    /// Which of its coordinates each may be measured from, where only their difference counts; itself for the one that
    /// others are measured from. None by default.
    fn origins(&self) -> [Option<usize>; N] {
        [None; N]
    }
}

/// A joint as an element.
pub(crate) struct JointElement<J, const N: usize, const M: usize> {
    pub(crate) joint: J,
}

impl<J, const N: usize, const M: usize> fmt::Debug for JointElement<J, N, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "joint of {N} coordinates by {M} equations")
    }
}

impl<J: Joint<N, M>, const N: usize, const M: usize> JointElement<J, N, M> {
    /// `g` with its gradient in the coordinates.
    #[inline(always)]
    fn in_positions(&self, t: f64, q: &[f64]) -> [Dual<f64, N>; M] {
        self.joint.position(Dual::fixed(t), &Dual::variables(&local(q)))
    }

    /// `g' = g_q v + g_t`, by one derivative along the motion.
    #[inline(always)]
    fn rates(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; M] {
        let (q, v): ([f64; N], [f64; N]) = (local(q), local(v));
        let along = lagrangian::from_fn(|i| Dual { re: q[i], eps: [v[i]] });
        self.joint.position(Dual { re: t, eps: [1.0] }, &along).map(|g| g.eps[0])
    }

    fn write_rows(g: &[Dual<f64, N>; M], rows: &mut [f64]) {
        for (row, g) in rows.chunks_exact_mut(N).zip(g) {
            row.copy_from_slice(&g.eps);
        }
    }
}

impl<J: Joint<N, M>, const N: usize, const M: usize> Element for JointElement<J, N, M> {
    fn size(&self) -> (usize, usize) {
        (N, M)
    }

    fn acts(&self) -> bool {
        false
    }

    fn angles(&self, angles: &mut [bool]) {
        angles.fill(false);
    }

    fn origins(&self, origins: &mut [Option<usize>]) {
        origins.copy_from_slice(&self.joint.origins());
    }

    fn beginning(&self, t: f64, q: &[f64], _v: &[f64], out: ElementBlocks<'_>) {
        Self::write_rows(&self.in_positions(t, q), out.rows);
    }

    fn increment(&self, (t0, h): (f64, f64), [_, q1]: [&[f64]; 2], _v: &[f64], out: ElementBlocks<'_>) {
        let g = self.in_positions(t0 + h, q1);
        if out.derivatives {
            Self::write_rows(&g, out.rows);
        }
        for (level, g) in out.level.iter_mut().zip(&g) {
            // What the rounding of the coordinates alone may bring counts as zero: no coordinates come nearer.
            let rounding: f64 = g.eps.iter().zip(q1).map(|(slope, q)| (slope * q).abs()).sum();
            *level = if g.re.abs() <= 2.0 * f64::EPSILON * rounding { 0.0 } else { -g.re / h };
        }
    }

    fn end(&self, _step: (f64, f64), _q0: &[f64], _v: &[f64], p1: &mut [f64]) {
        p1.fill(0.0);
    }

    fn velocity(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        if out.derivatives {
            Self::write_rows(&self.in_positions(t, q), out.rows);
        }
        for (level, rate) in out.level.iter_mut().zip(self.rates(t, q, v)) {
            *level = -rate;
        }
    }

    fn sizes(&self, (t, h): (f64, f64), q: &[f64], v: &[f64], momentum: &mut [f64], level: &mut [f64]) {
        momentum.fill(0.0);
        for (size, g) in level.iter_mut().zip(self.in_positions(t, q)) {
            let terms = g.eps.iter().zip(q.iter().zip(v));
            // Each product is rounded, and each sum.
            *size = terms.map(|(slope, (q, v))| 2.0 * (slope * v).abs() + 4.0 * (slope * q / h).abs()).sum();
        }
    }

    fn motion(&self, t: f64, q: &[f64], v: &[f64], out: ElementBlocks<'_>) {
        Self::write_rows(&self.in_positions(t, q), out.rows);
        // The second derivative of g along the motion as it would be without acceleration.
        let (q, v): ([f64; N], [f64; N]) = (local(q), local(v));
        let along: [HyperDual<f64, 1, 1>; N] = lagrangian::from_fn(|i| HyperDual::linear(q[i], [v[i]], [v[i]]));
        let curved = self.joint.position(HyperDual::linear(t, [1.0], [1.0]), &along);
        for (level, g) in out.level.iter_mut().zip(&curved) {
            *level = -g.e12[0][0];
        }
    }

    fn energy(&self, _t: f64, _q: &[f64], _v: &[f64]) -> f64 {
        0.0
    }

    fn power(&self, _t: f64, _q: &[f64], _v: &[f64]) -> f64 {
        0.0
    }

    fn misses(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; 2] {
        let most = |x: [f64; M]| x.iter().fold(0.0, |most, x| larger(most, x.abs()));
        [most(self.rates(t, q, v)), most(self.joint.position(t, &local(q)))]
    }

    fn turn(&self, _step: (f64, f64), _q0: &[f64], _v: &[f64]) -> f64 {
        0.0
    }

    /// A joint does work if it moves with time.
    fn power_sources(&self) -> PowerSources {
        let position = self.joint.position(Traced::TIME, &[Traced::STATE; N]);
        PowerSources { constraints: position.iter().any(|g| g.of_time), ..PowerSources::NONE }
    }

    fn damping(&self, _step: (f64, f64), _q0: &[f64], _v: [&[f64]; 2]) -> f64 {
        0.0
    }

    fn inertia(&self, _step: (f64, f64), _q0: &[f64], _v: [&[f64]; 2]) -> [f64; 2] {
        [0.0; 2]
    }

    /// A step needs its functions with their derivatives in the coordinates.
    fn not_a_number(&self, t: f64, q: &[f64], _v: &[f64]) -> Option<NotANumber> {
        let lost = |(row, g): (usize, &Dual<f64, N>)| {
            let slope = g.eps.iter().position(|slope| !slope.is_finite()).map(Variable::Coordinate);
            let derivative = if g.re.is_finite() { Derivative::First(slope?) } else { Derivative::Value };
            Some(NotANumber { function: SystemFunction::Position { row }, derivative, time: t, at_node: true })
        };
        self.in_positions(t, q).iter().enumerate().find_map(lost)
    }
}
