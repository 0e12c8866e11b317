use assembly::parts::{Trailer, Train};
use assembly::{AssemblyMethod, AssemblyState, Solver, SparseDla};
use nalgebra::{Complex, DMatrix};
use sleigh::{Sleigh, SleighState};

const SPEED: f64 = 1.0;
const STEP: f64 = 0.1;

/// A lead and two unlike trailers.
fn train() -> Train {
    let trailers =
        vec![Trailer::new(0.5, 0.1, 0.1, 0.3, 0.8).unwrap(), Trailer::new(0.7, 0.2, -0.1, 0.2, 1.1).unwrap()];
    Train::new(Sleigh::new(1.0, 1.0, 0.5).unwrap(), trailers, |trailer| trailer.sleigh).unwrap()
}

/// The straight train in motion at the speed `u`, linearised: of the turn rate of the lead and the headings of the trailers
/// against the blade before.
///
/// With `f_k` the angle of trailer `k` behind the one before, `omega_k+1 = (-u f_k+1 - b omega_k) / d`, so that
/// `f_k+1' = omega_k+1 - omega_k`; and along the virtual turn `r_0 = 1`, `r_k+1 = -b r_k / d`, which moves no blade aside,
/// `sum_k r_k (J_k omega_k' + m_k a_k u omega_k) = 0`.
fn linearised(train: &Train, u: f64) -> DMatrix<f64> {
    let (lead, trailers) = (Sleigh::new(1.0, 1.0, 0.5).unwrap(), train.trailers());
    let n = trailers.len();
    // Each turn rate as a row over the unknowns.
    let mut rates = vec![DMatrix::zeros(1, n + 1)];
    rates[0][0] = 1.0;
    let (mut virtual_turns, mut sleighs) = (vec![1.0], vec![lead]);
    for (k, Trailer { sleigh, hitch, bar }) in trailers.iter().enumerate() {
        let mut rate = &rates[k] * (-hitch / bar);
        rate[k + 1] -= u / bar;
        rates.push(rate);
        virtual_turns.push(-virtual_turns[k] * hitch / bar);
        sleighs.push(*sleigh);
    }
    let (mut mass, mut push) = (DMatrix::<f64>::identity(n + 1, n + 1), DMatrix::<f64>::zeros(n + 1, n + 1));
    mass.row_mut(0).fill(0.0);
    for ((rate, r), sleigh) in rates.iter().zip(&virtual_turns).zip(&sleighs) {
        for j in 0..=n {
            mass[(0, j)] += r * sleigh.pivot_inertia() * rate[j];
            push[(0, j)] -= r * sleigh.mass() * sleigh.offset() * u * rate[j];
        }
    }
    for k in 0..n {
        push.row_mut(k + 1).copy_from(&(&rates[k + 1] - &rates[k]));
    }
    mass.try_inverse().unwrap() * push
}

/// Those of a step of the midpoint rule, `(1 + h x/2) / (1 - h x/2)`, of the eigenvalues `x` of the linearised motion.
fn predicted(train: &Train, u: f64) -> Vec<Complex<f64>> {
    let one = Complex::new(1.0, 0.0);
    let half = |x: &Complex<f64>| x * (0.5 * STEP);
    linearised(train, u).complex_eigenvalues().iter().map(|x| (one + half(x)) / (one - half(x))).collect()
}

/// The eigenvalues of the computed step, from small departures to both sides; in the coordinates of [`linearised`].
fn computed(train: &Train, u: f64) -> Vec<Complex<f64>> {
    const SMALL: f64 = 1e-4;
    let n = train.trailers().len();
    let mut method = SparseDla::new(&train.assembly, Solver::Best).unwrap();
    let departure = |state: &AssemblyState| -> Vec<f64> {
        let blades: Vec<SleighState> = (0..=n).map(|k| train.blade(&state.unwrapped(), state.v(), k)).collect();
        std::iter::once(blades[0].turn_rate).chain((0..n).map(|k| blades[k + 1].heading - blades[k].heading)).collect()
    };
    let mut step = |j: usize, side: f64| {
        let mut angles = vec![0.0; n];
        let turn_rate = if j == 0 { side } else { 0.0 };
        // The trailers after it keep their angles to it.
        (j.max(1) - 1..n).filter(|_| j > 0).for_each(|k| angles[k] = side);
        let mut state = train.start(&SleighState { speed: u, turn_rate, ..SleighState::default() }, &angles);
        method.step(&train.assembly, 0.0, STEP, &mut state).unwrap();
        departure(&state)
    };
    let mut matrix = DMatrix::zeros(n + 1, n + 1);
    for j in 0..=n {
        let (right, left) = (step(j, SMALL), step(j, -SMALL));
        for i in 0..=n {
            matrix[(i, j)] = (right[i] - left[i]) / (2.0 * SMALL);
        }
    }
    matrix.complex_eigenvalues().iter().copied().collect()
}

/// Forward the trailers follow; backward each jack-knifes.
#[test]
fn a_straight_train_is_as_stable_as_its_linearisation() {
    let train = train();
    for u in [SPEED, -SPEED] {
        let (mut predicted, mut computed) = (predicted(&train, u), computed(&train, u));
        predicted.sort_by(|a, b| a.re.total_cmp(&b.re));
        computed.sort_by(|a, b| a.re.total_cmp(&b.re));
        println!("u = {u}: {predicted:?} {computed:?}");
        for (a, b) in predicted.iter().zip(&computed) {
            // What is left of a departure of 1e-4 is its third power over itself.
            assert!((a - b).norm() < 1e-7, "{a} {b}");
            assert_eq!(a.norm() < 1.0, u > 0.0);
        }
    }
}

/// What the eigenvalues say happens: a train that is pushed folds, one that is pulled stretches.
#[test]
fn a_train_pushed_backward_jack_knifes() {
    let train = train();
    let bend = |u: f64| {
        let mut state = train.start(&SleighState { speed: u, ..SleighState::default() }, &[0.01, 0.02]);
        let mut method = SparseDla::new(&train.assembly, Solver::Best).unwrap();
        let mut most: f64 = 0.0;
        for k in 0..200 {
            method.step(&train.assembly, 0.02 * f64::from(k), 0.02, &mut state).unwrap();
            let angle = train.blade(&state.unwrapped(), state.v(), 1).heading
                - train.blade(&state.unwrapped(), state.v(), 0).heading;
            most = most.max(angle.abs());
        }
        most
    };
    let (forward, backward) = (bend(SPEED), bend(-SPEED));
    println!("{forward} {backward}");
    assert!(forward < 0.02 && backward > 1.0);
}
