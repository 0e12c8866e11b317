use crate::tools::{bent, end, train};
use assembly::parts::{Hinge, Train};
use assembly::{Assembly, AssemblyMethod, AssemblyState, Solver, SparseComposition, SparseDla};
use dla::{AssemblyFault, Hint, Stage, StepError};
use lagrangian::{Constraint, Piecewise, Scalar, System};
use sleigh::Sleigh;

#[test]
fn a_step_allocates_nothing() {
    allocates_nothing(4, 10);
}

#[test]
#[ignore = "slow"]
fn a_step_allocates_nothing_in_full() {
    allocates_nothing(8, 25);
}

/// After the first steps, in which the factors find their room.
fn allocates_nothing(blades: usize, steps: i32) {
    let train = train(blades);
    for solver in [Solver::Sparse, Solver::Dense] {
        let (mut method, mut state) = (SparseDla::new(&train.assembly, solver).unwrap(), bent(&train));
        let mut step = |k: i32| {
            let h = 0.02;
            method.step(&train.assembly, h * f64::from(k), h, &mut state).unwrap();
        };
        let first = allocation_counter::measure(|| step(0)).count_total;
        (1..5).for_each(&mut step);
        let count = allocation_counter::measure(|| (5..steps).for_each(&mut step)).count_total;
        assert_eq!(count, 0, "{solver:?}");
        // A positive control: the sparse factors are made in the first step.
        assert!(first > 0 || solver == Solver::Dense);
    }
}

/// Two hinges at one place say the same thing twice.
#[test]
fn dependent_constraints_are_named() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    for solver in [Solver::Sparse, Solver::Dense] {
        let mut bodies = Assembly::new();
        let all: Vec<[usize; 3]> = (0..5).map(|_| bodies.body("blade", sleigh)).collect();
        let hinge = Hinge::new([-0.5, 0.0], [0.5, 0.0]);
        for pair in all.windows(2) {
            let at = [pair[0][0], pair[0][1], pair[0][2], pair[1][0], pair[1][1], pair[1][2]];
            bodies.join("hinge", hinge, at).unwrap();
        }
        let at = [all[2][0], all[2][1], all[2][2], all[3][0], all[3][1], all[3][2]];
        bodies.join("second hinge", hinge, at).unwrap();
        let q: Vec<f64> = (0..5).flat_map(|k| [-f64::from(k), 0.0, 0.0]).collect();
        let v: Vec<f64> = (0..5).flat_map(|_| [1.0, 0.0, 0.0]).collect();
        let mut state = AssemblyState::new(&bodies, &q, &v);
        let before = state.clone();
        let error = SparseDla::new(&bodies, solver).unwrap().step(&bodies, 0.0, 0.1, &mut state).unwrap_err();
        println!("{error}");
        let StepError::Assembly(AssemblyFault::Singular { stage: Stage::Increment, constraints, .. }) = error else {
            panic!("{error}")
        };
        // Shorter steps do not help.
        assert!(!error.may_hold_in_parts());
        let mut elements: Vec<u32> = constraints.iter().flatten().map(|constraint| constraint.element).collect();
        elements.sort_unstable();
        elements.dedup();
        assert_eq!(elements, [7, 9]);
        assert_eq!(state, before);
    }
}

/// The order by the errors of a number of steps and of twice as many.
fn has_order(
    (train, duration, exact): (&Train, f64, &AssemblyState),
    method: &mut dyn AssemblyMethod,
    steps: u32,
    expected: f64,
) {
    let errors = [steps, 2 * steps].map(|steps| end(train, duration, method, steps).distance(exact));
    let order = (errors[0] / errors[1]).log2();
    println!("{expected}: {order}, {errors:?}");
    assert!((order - expected).abs() < 0.3, "{expected}: {order}, {errors:?}");
}

/// Of order 2 and 4, against the eighth.
#[test]
fn compositions_have_their_order() {
    let train = train(2);
    let assembly = &train.assembly;
    let exact = end(&train, 1.0, &mut SparseComposition::new(assembly, Solver::Best, 8).unwrap(), 40);
    let run = (&train, 1.0, &exact);
    has_order(run, &mut SparseDla::new(assembly, Solver::Best).unwrap(), 20, 2.0);
    has_order(run, &mut SparseComposition::new(assembly, Solver::Best, 4).unwrap(), 10, 4.0);
    assert!(matches!(SparseComposition::new(assembly, Solver::Best, 3), Err(StepError::Unsupported { .. })));
}

/// Of order 2, 4 and 6, against the eighth.
#[test]
#[ignore = "slow"]
fn compositions_have_their_order_in_full() {
    let train = train(4);
    let assembly = &train.assembly;
    let composition = |order| SparseComposition::new(assembly, Solver::Best, order).unwrap();
    let exact = end(&train, 2.0, &mut composition(8), 160);
    let run = (&train, 2.0, &exact);
    has_order(run, &mut SparseDla::new(assembly, Solver::Best).unwrap(), 40, 2.0);
    has_order(run, &mut composition(4), 20, 4.0);
    has_order(run, &mut composition(6), 10, 6.0);
}

/// There and back again.
#[test]
fn a_step_is_its_own_adjoint() {
    let train = train(10);
    let (start, mut method) = (bent(&train), SparseDla::new(&train.assembly, Solver::Best).unwrap());
    let mut state = start.clone();
    for k in 0..50 {
        method.step(&train.assembly, 0.02 * f64::from(k), 0.02, &mut state).unwrap();
    }
    assert!(state.distance(&start) > 0.5);
    for k in 0..50 {
        method.step(&train.assembly, 1.0 - 0.02 * f64::from(k), -0.02, &mut state).unwrap();
    }
    println!("{:e}", state.distance(&start));
    assert!(state.distance(&start) < 1e-11);
}

/// A body on the plane whose drag has no derivative at rest, or one that has.
struct Slowed {
    smooth: bool,
}

impl System<3, 0> for Slowed {
    fn lagrangian<S: Scalar>(&self, _t: S, q: &[S; 3], v: &[S; 3]) -> S {
        (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5 + q[0]
    }
    fn constraint<S: Scalar>(&self, _t: S, _q: &[S; 3]) -> Constraint<S, 3, 0> {
        ([], [])
    }
    fn force<S: Scalar>(&self, _t: S, _q: &[S; 3], v: &[S; 3]) -> Option<[S; 3]> {
        let speed = if self.smooth { S::length(&[v[0], v[1]]) } else { (v[0] * v[0] + v[1] * v[1]).sqrt() };
        Some([-(v[0] * speed), -(v[1] * speed), S::zero()])
    }
}

impl Piecewise for Slowed {
    fn piece(&self, _t: f64) -> Self {
        Self { ..*self }
    }
}

/// By all methods of assemblies, in the numbers of the assembly; the control is a drag that is differentiable at rest.
#[test]
fn a_force_without_a_derivative_is_named() {
    for smooth in [false, true] {
        let mut bodies = Assembly::new();
        let hinge = Hinge::new([-0.5, 0.0], [0.5, 0.0]);
        let first = bodies.body("blade", Sleigh::new(1.0, 1.0, 0.5).unwrap());
        let second = bodies.body("slowed", Slowed { smooth });
        let at = [first[0], first[1], first[2], second[0], second[1], second[2]];
        bodies.join("hinge", hinge, at).unwrap();
        let rest = AssemblyState::new(&bodies, &[0.0, 0.0, 0.0, -1.0, 0.0, 0.0], &[0.0; 6]);
        let methods: [Box<dyn AssemblyMethod>; 2] = [
            Box::new(SparseDla::new(&bodies, Solver::Best).unwrap()),
            Box::new(SparseComposition::new(&bodies, Solver::Best, 4).unwrap()),
        ];
        for mut method in methods {
            let mut state = rest.clone();
            let outcome = method.step(&bodies, 2.0, 0.01, &mut state);
            if smooth {
                assert!(outcome.is_ok() && state.v()[0] > 0.0, "{outcome:?}");
                continue;
            }
            let error = bodies.named(outcome.unwrap_err(), (2.0, 0.1), &state);
            assert_eq!(
                error.to_string(),
                "element 1 (slowed): the force on coordinate 3 has no finite derivative in velocity 3 at t = 2 s"
            );
            assert_eq!(error.hint(), Some(Hint::Corner));
        }
    }
}
