use crate::local::WIDEST;
use dla::LinearisedStage;
use lagrangian::Dual;

/// What an element says at one stage of a step, with first derivatives: as [`LinearisedStage`], in the first places of lists
/// that are long enough for any. Matrices by rows.
#[derive(Debug, Clone)]
pub struct StageTerms {
    /// `p = L_v`, `N`.
    pub p: Vec<f64>,
    /// Its derivatives in `q`, `N x N`.
    pub p_q: Vec<f64>,
    /// Its derivatives in `v`, `N x N`.
    pub p_v: Vec<f64>,
    /// `w = h (L_q + F) + A' l`, `N`.
    pub w: Vec<f64>,
    /// Its derivatives in `q`, `N x N`.
    pub w_q: Vec<f64>,
    /// Its derivatives in `v`, `N x N`.
    pub w_v: Vec<f64>,
    /// `g = A v + b`, `M`.
    pub g: Vec<f64>,
    /// Its derivatives in `q`, `M x N`.
    pub g_q: Vec<f64>,
    /// Its derivatives in `v`, `M x N`.
    pub a: Vec<f64>,
    /// Which rows hold positions, `M`.
    pub holds: Vec<bool>,
    /// What these functions are, `M`.
    pub position: Vec<f64>,
    /// Their derivatives in `q`, `M x N`.
    pub position_q: Vec<f64>,
}

impl StageTerms {
    pub(super) fn new() -> Self {
        let (vector, matrix) = (|| vec![0.0; WIDEST], || vec![0.0; WIDEST * WIDEST]);
        Self {
            p: vector(),
            p_q: matrix(),
            p_v: matrix(),
            w: vector(),
            w_q: matrix(),
            w_v: matrix(),
            g: vector(),
            g_q: matrix(),
            a: matrix(),
            holds: vec![false; WIDEST],
            position: vector(),
            position_q: matrix(),
        }
    }

    pub(super) fn write<const N: usize, const M: usize>(
        &mut self,
        at: &LinearisedStage<N, M>,
        positions: Option<[Option<Dual<f64, N>>; M]>,
    ) {
        let square = |from: &[[f64; N]; N], to: &mut [f64]| to[..N * N].copy_from_slice(from.as_flattened());
        let rows = |from: &[[f64; N]; M], to: &mut [f64]| to[..M * N].copy_from_slice(from.as_flattened());
        self.p[..N].copy_from_slice(&at.p);
        self.w[..N].copy_from_slice(&at.w);
        self.g[..M].copy_from_slice(&at.g);
        square(&at.p_q, &mut self.p_q);
        square(&at.p_v, &mut self.p_v);
        square(&at.w_q, &mut self.w_q);
        square(&at.w_v, &mut self.w_v);
        rows(&at.g_q, &mut self.g_q);
        rows(&at.a, &mut self.a);
        self.holds[..M].fill(false);
        for (k, g) in positions.iter().flatten().enumerate() {
            if let Some(g) = g {
                (self.holds[k], self.position[k]) = (true, g.re);
                self.position_q[k * N..][..N].copy_from_slice(&g.eps);
            }
        }
    }
}

/// What an element says of the stages of a step: see [`SparseLobatto`](crate::SparseLobatto).
pub trait StageElement {
    /// All that the equations need at the time `t` of a step of length `h`, with the impulses `h Lambda` of its rows.
    fn stage(&self, time: (f64, f64), q: &[f64], v: &[f64], impulses: &[f64], out: &mut StageTerms);

    /// Whether it has constraints that are not affine in the velocities, which the method does not do.
    fn is_affine(&self, t: f64, q: &[f64], v: &[f64]) -> bool;
}
