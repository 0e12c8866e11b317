//! `method!` makes the methods of the table.

use harness::{METHODS, Method};
use noslip::prelude::*;
use noslip::{Sleigh, SleighState, StepError};

/// Twenty steps of the sleigh.
fn end(method: &mut dyn OneStep<3, 1>) -> State<3> {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let (q, v) = SleighState { speed: 1.0, turn_rate: 0.3, ..SleighState::default() }.to_coordinates();
    let mut state = State::new(q, v, sleigh.angles());
    drive(&sleigh, method, &Schedule { t0: 0.0, step: 0.05, steps: 20 }, &mut state, ()).unwrap();
    state
}

/// The names, of methods that move the sleigh as the methods of the table do.
macro_rules! same {
    ($($name:tt)*) => {
        [$({
            let named = Method::named($name, None).unwrap();
            assert_eq!(end(&mut method!($name)).q(), end(&mut *named.stepper()).q(), $name);
            $name
        }),*]
    };
}

#[test]
fn names_are_those_of_the_table() {
    let names = same!(
        "dla" "dla-trapezoid" "dla4" "dla6" "dla8" "lobatto3" "lobatto4" "lobatto5" "gauss4" "gauss6" "gauss8" "gauss10" "gauss12"
        "gauss14" "gauss16" "energy2" "energy4" "energy6" "energy8" "gni"
    );
    // The others are the baselines, and those with a weight, with a tolerance, or for the sleigh alone.
    let baselines = ["rk4", "rk4-projected", "rk4-reduced", "implicit-midpoint", "dop853"];
    let others = [&["dla-alpha", "gauss-adaptive", "taylor"], &baselines[..]].concat();
    assert!(METHODS.iter().all(|info| names.contains(&info.name) != others.contains(&info.name)));
}

/// A start that slips is refused, and the error says what to do.
#[test]
fn a_start_that_slips() {
    let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
    let (q, v) = ([0.0; 3], [1.0, 0.5, 0.0]);
    let schedule = Schedule { t0: 0.0, step: 0.05, steps: 20 };
    let mut state = State::new(q, v, sleigh.angles());
    let error = drive(&sleigh, &mut method!("dla"), &schedule, &mut state, ()).unwrap_err();
    assert_eq!(error.source, StepError::Slips { row: 0, residual: 0.5 });
    assert!(
        error.to_string().contains("residual is 0.5") && error.to_string().contains("`consistent_start`"),
        "{error}"
    );
    assert_eq!(*state.v(), v);
    let start = consistent_start(&sleigh, 0.0, &q, &v).unwrap();
    let mut nodes = Trajectory::every(10);
    let mut state = State::new(start.q, start.v, sleigh.angles());
    drive(&sleigh, &mut method!("dla"), &schedule, &mut state, &mut nodes).unwrap();
    let mut text = Vec::new();
    nodes.write_csv(&mut text, &["x", "y", "theta"]).unwrap();
    let text = String::from_utf8(text).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!((rows.len(), rows[0]), (4, "t,x,y,theta,x',y',theta',energy,work,constraint"));
    let last: Vec<f64> = rows[3].split(',').map(|x| x.parse().unwrap()).collect();
    assert_eq!((last[0], last[1]), (nodes.nodes()[2].t, nodes.nodes()[2].q[0]));
}
