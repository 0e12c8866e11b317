//! The reduced equations of a scene, written by hand in the blade's frame, and a collocation method of order 12.
//!
//! The velocity of the contact point is `P' = u e + s n`; `s` is zero but on a turntable, where it is
//! `Omega n . (-y, x)`. A point of the body at `r = r_x e + r_y n` has the acceleration
//!
//! ```text
//! u' - omega s - r_x omega^2 - r_y omega' - 2 omega r_y' + r_x''     along e,
//! s' + omega u + r_x omega' - r_y omega^2 + 2 omega r_x' + r_y''     along n.
//! ```

use lagrangian::quadrature::{gauss_collocation, gauss_legendre};
use scene::{AnyEffect, Rotor, Scene, SceneEffect};
use sleigh::effects::{Bowl, Drag, EggCrate, Friction, Hills, MovingMass, QuadraticDrag, Slope, Thrust, Torque};
use sleigh::{ClosedPath, PathShape, TimeFunction};
use std::array::from_fn;
use std::f64::consts::TAU;

/// `x y theta u omega psi`, and `omega + psi'` of the rotor.
pub type Place = [f64; 7];

/// Value, first and second derivative on the piece that holds at `middle`.
fn function(function: &TimeFunction, t: f64, middle: f64) -> [f64; 3] {
    let of_points = |times: &[f64], values: &[f64], linear: bool| {
        let Some(i) = times.iter().rposition(|time| *time <= middle) else { return [values[0], 0.0, 0.0] };
        let rises = linear && i + 1 < times.len();
        let slope = if rises { (values[i + 1] - values[i]) / (times[i + 1] - times[i]) } else { 0.0 };
        [values[i] + slope * (t - times[i]), slope, 0.0]
    };
    match function {
        TimeFunction::Constant(value) => [*value, 0.0, 0.0],
        TimeFunction::Sine { amplitude, frequency, phase } => {
            let (sin, cos) = (frequency * t + phase).sin_cos();
            [amplitude * sin, amplitude * frequency * cos, -amplitude * frequency * frequency * sin]
        }
        TimeFunction::Table(table) => of_points(table.times(), table.values(), false),
        TimeFunction::Ramp(ramp) => of_points(ramp.times(), ramp.values(), true),
        TimeFunction::Formula(formula) if formula.text() == "0.4*t*exp(-t)" => {
            let decay = 0.4 * (-t).exp();
            [t * decay, (1.0 - t) * decay, (t - 2.0) * decay]
        }
        // Not written by hand, and so in agreement with nothing.
        TimeFunction::Formula(_) | TimeFunction::Pulses(_) => [f64::NAN; 3],
    }
}

fn path_velocity(path: &ClosedPath, t: f64, middle: f64) -> [f64; 2] {
    let period = path.period();
    match path.shape() {
        PathShape::Circle { radius, .. } => {
            let rate = TAU / period;
            let (sin, cos) = (rate * t).sin_cos();
            [-radius * rate * sin, radius * rate * cos]
        }
        PathShape::Polygon(polygon) => {
            let vertices = polygon.vertices();
            let edge = |k: usize| {
                let (a, b) = (vertices[k % vertices.len()], vertices[(k + 1) % vertices.len()]);
                [b[0] - a[0], b[1] - a[1]]
            };
            let length = |k: usize| f64::hypot(edge(k)[0], edge(k)[1]);
            let whole: f64 = (0..vertices.len()).map(length).sum();
            let mut left = (middle / period).fract() * whole;
            let mut k = 0;
            while left > length(k) {
                left -= length(k);
                k += 1;
            }
            edge(k).map(|d| d / length(k) * whole / period)
        }
    }
}

/// Everything in the equations at one instant.
#[derive(Default)]
struct Terms {
    /// `[[m_uu, m_uw], [m_uw, m_ww]]`.
    mass: [f64; 3],
    /// The right-hand sides.
    right: [f64; 2],
    /// Lateral velocity of the contact point, and what multiplies it in the angular momentum.
    lateral: [f64; 2],
    /// Imposed speed and turn rate with their slopes.
    imposed: [Option<[f64; 2]>; 2],
    /// Angular acceleration of the rotor in space.
    rotor: f64,
}

fn terms(scene: &Scene, t: f64, middle: f64, &[x, y, theta, u, omega, ..]: &Place) -> Terms {
    let (m, a, j) = (scene.sleigh.mass(), scene.sleigh.offset(), scene.sleigh.pivot_inertia());
    let (sin, cos) = theta.sin_cos();
    let (cx, cy) = (x + a * cos, y + a * sin);
    let rate: f64 =
        scene.effects.iter().map(|e| if let SceneEffect::Turntable { rate } = e { *rate } else { 0.0 }).sum();
    let s = rate * (x * cos + y * sin);

    // What is imposed comes first: the rest is evaluated at it.
    let mut imposed = [None, None];
    for effect in &scene.effects {
        match effect {
            SceneEffect::Servo { speed, turn_rate } => {
                imposed = [speed, turn_rate].map(|f| {
                    f.as_ref().map(|f| {
                        let [value, slope, _] = function(f, t, middle);
                        [value, slope]
                    })
                });
            }
            SceneEffect::Tracer { path } => {
                let [vx, vy] = path_velocity(path, t, middle);
                imposed = [Some([cos * vx + sin * vy, 0.0]), Some([(cos * vy - sin * vx - s) / a, 0.0])];
            }
            _ => {}
        }
    }
    let u = imposed[0].map_or(u, |[u, _]| u);
    let omega = imposed[1].map_or(omega, |[omega, _]| omega);
    let s_rate = rate * (u + omega * (y * cos - x * sin));

    let mut all = Terms { mass: [m, 0.0, j], lateral: [s, m * a], imposed, ..Terms::default() };
    let (mut fx, mut fy) = (0.0, 0.0);
    let [mut along, mut turning] = [m * (omega * s + a * omega * omega), -m * a * (s_rate + u * omega)];
    for effect in &scene.effects {
        match effect {
            SceneEffect::Acting(AnyEffect::Slope(Slope { gravity })) => {
                fx += m * gravity[0];
                fy += m * gravity[1];
            }
            SceneEffect::Acting(AnyEffect::Bowl(Bowl { stiffness, center })) => {
                fx -= stiffness[0] * (cx - center[0]);
                fy -= stiffness[1] * (cy - center[1]);
            }
            SceneEffect::Acting(AnyEffect::EggCrate(EggCrate { height, wave_number: [kx, ky] })) => {
                fx += height * kx * (kx * cx).sin();
                fy += height * ky * (ky * cy).sin();
            }
            SceneEffect::Acting(AnyEffect::Hills(Hills { hills })) => {
                for hill in hills {
                    let (dx, dy, square) = (cx - hill.x, cy - hill.y, hill.width * hill.width);
                    let steep = hill.height * (-(dx * dx + dy * dy) / (2.0 * square)).exp() / square;
                    fx += steep * dx;
                    fy += steep * dy;
                }
            }
            SceneEffect::Acting(AnyEffect::Drag(Drag { along: c_u, turning: c_omega })) => {
                along -= c_u * u;
                turning -= c_omega * omega;
            }
            SceneEffect::Acting(AnyEffect::QuadraticDrag(QuadraticDrag { along: c_u, turning: c_omega })) => {
                along -= c_u * u * u.abs();
                turning -= c_omega * omega * omega.abs();
            }
            SceneEffect::Acting(AnyEffect::Friction(Friction {
                along: force,
                smoothing,
                turning: torque,
                turning_smoothing,
            })) => {
                along -= force * (u / smoothing).tanh();
                turning -= torque * (omega / turning_smoothing).tanh();
            }
            SceneEffect::Acting(AnyEffect::Thrust(Thrust { force })) => along += function(force, t, middle)[0],
            SceneEffect::Acting(AnyEffect::Torque(Torque { torque })) => turning += function(torque, t, middle)[0],
            SceneEffect::MovingMass(MovingMass { mass, x, y }) => {
                let ([rx, dx, ddx], [ry, dy, ddy]) = (function(x, t, middle), function(y, t, middle));
                let along_e = -omega * s - rx * omega * omega - 2.0 * omega * dy + ddx;
                let along_n = s_rate + omega * u - ry * omega * omega + 2.0 * omega * dx + ddy;
                along -= mass * along_e;
                turning -= mass * (rx * along_n - ry * along_e);
                all.mass[0] += mass;
                all.mass[1] -= mass * ry;
                all.mass[2] += mass * (rx * rx + ry * ry);
                all.lateral[1] += mass * rx;
            }
            SceneEffect::Flywheel(Rotor { inertia, torque: Some(torque), .. }) => {
                let torque = function(torque, t, middle)[0];
                turning -= torque;
                all.rotor = torque / inertia;
            }
            _ => {}
        }
    }
    all.right = [along + fx * cos + fy * sin, turning + a * (fy * cos - fx * sin)];
    all
}

/// The solution of the two equations, with an equation left out for every unknown that is given.
fn solved([uu, uw, ww]: [f64; 3], [right_u, right_w]: [f64; 2], given: [Option<f64>; 2]) -> [f64; 2] {
    match given {
        [Some(u), Some(w)] => [u, w],
        [Some(u), None] => [u, (right_w - uw * u) / ww],
        [None, Some(w)] => [(right_u - uw * w) / uu, w],
        [None, None] => {
            let determinant = uu * ww - uw * uw;
            [(ww * right_u - uw * right_w) / determinant, (uu * right_w - uw * right_u) / determinant]
        }
    }
}

fn rates(scene: &Scene, t: f64, middle: f64, place: &Place) -> Place {
    let all = terms(scene, t, middle, place);
    let (sin, cos) = place[2].sin_cos();
    let u = all.imposed[0].map_or(place[3], |[u, _]| u);
    let omega = all.imposed[1].map_or(place[4], |[omega, _]| omega);
    let s = all.lateral[0];
    let [du, domega] = solved(all.mass, all.right, all.imposed.map(|given| given.map(|[_, slope]| slope)));
    [u * cos - s * sin, u * sin + s * cos, omega, du, domega, place[6] - omega, all.rotor]
}

/// The velocities after a jump of the imposed rates. The momenta of the other coordinates stay.
fn after_jump(scene: &Scene, t: f64, before: f64, middle: f64, place: &mut Place) {
    let (old, new) = (terms(scene, t, before, place), terms(scene, t, middle, place));
    let [uu, uw, ww] = old.mass;
    let velocity = [old.imposed[0].map_or(place[3], |[u, _]| u), old.imposed[1].map_or(place[4], |[w, _]| w)];
    let momenta = [uu * velocity[0] + uw * velocity[1], uw * velocity[0] + ww * velocity[1]];
    let [u, omega] = solved(new.mass, momenta, new.imposed.map(|given| given.map(|[value, _]| value)));
    (place[3], place[4]) = (u, omega);
}

/// The start, with the imposed rates.
fn start(scene: &Scene, middle: f64) -> Place {
    let at = scene.start;
    let rotor = scene.effects.iter().find_map(|effect| match effect {
        SceneEffect::Flywheel(Rotor { rate, .. }) => Some(*rate),
        _ => None,
    });
    let mut place = [at.x, at.y, at.heading, at.speed, at.turn_rate, 0.0, 0.0];
    let imposed = terms(scene, 0.0, middle, &place).imposed;
    place[3] = imposed[0].map_or(place[3], |[u, _]| u);
    place[4] = imposed[1].map_or(place[4], |[omega, _]| omega);
    place[6] = rotor.map_or(0.0, |rate| rate + place[4]);
    place
}

/// The state at the end: `x y theta u omega psi psi'`.
pub fn motion(scene: &Scene, jumps: &[f64], end: f64, h: f64) -> [f64; 7] {
    const STAGES: usize = 6;
    let (nodes, weights) = gauss_legendre::<STAGES>();
    let coefficients = gauss_collocation(&nodes, &weights);
    let mut ends: Vec<f64> = jumps.iter().copied().chain([end]).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut place = start(scene, 0.5 * ends[0]);
    let (mut t0, mut before) = (0.0, 0.5 * ends[0]);
    for t1 in ends {
        let middle = 0.5 * (t0 + t1);
        if t0 > 0.0 {
            after_jump(scene, t0, before, middle, &mut place);
        }
        before = middle;
        let steps = ((t1 - t0) / h).ceil();
        let h = (t1 - t0) / steps;
        for k in 0..steps as u32 {
            let t = t0 + f64::from(k) * h;
            let mut slopes = [rates(scene, t, middle, &place); STAGES];
            // The iteration gains a factor of about h times the rates, below a tenth; rounding ends it.
            for _ in 0..30 {
                for i in 0..STAGES {
                    let stage: Place =
                        from_fn(|c| place[c] + h * (0..STAGES).map(|l| coefficients[i][l] * slopes[l][c]).sum::<f64>());
                    slopes[i] = rates(scene, t + nodes[i] * h, middle, &stage);
                }
            }
            place = from_fn(|c| place[c] + h * (0..STAGES).map(|l| weights[l] * slopes[l][c]).sum::<f64>());
        }
        t0 = t1;
    }
    let rates = rates(scene, end, before, &place);
    let imposed = terms(scene, end, before, &place).imposed;
    let u = imposed[0].map_or(place[3], |[u, _]| u);
    let rotor = scene.effects.iter().any(|effect| matches!(effect, SceneEffect::Flywheel(Rotor { .. })));
    let [psi, psi_rate] = if rotor { [place[5], rates[5]] } else { [0.0; 2] };
    [place[0], place[1], place[2], u, rates[2], psi, psi_rate]
}
