//! One step of every family of methods.

use crate::differences::{BAR, Input, disagreement};
use crate::systems::{Controlled, ControlledSleigh, Moving};
use dla::{Composition, Differentiable, Dla, Energy, Form, Gauss, Lobatto, OneStep, Sensitivity};
use lagrangian::{Midpoint, Symmetrised, Trapezoid};
use sleigh::{Guided, Sleigh};

fn assert_close(name: &str, worst: f64) {
    println!("{name}: {worst:.1e}");
    assert!(worst < BAR, "{name}: {worst:e}");
}

const START: Input<3, 6> = Input { q: [0.3, -0.2, 0.5], v: [0.6, 0.2, 1.1], t: 0.2, h: 0.1, p: Controlled::PARAMETERS };

fn bare() -> Input<3, 0> {
    Input { q: START.q, v: START.v, t: START.t, h: START.h, p: [] }
}

fn controlled<Method>(name: &str, method: Method)
where
    Method: OneStep<ControlledSleigh, 3, 1> + Differentiable<3, 1> + Clone,
{
    let system = Controlled::at(&START.p);
    assert_close(name, disagreement(&Sensitivity::of_member(&system), Controlled::at, method, &START));
}

/// State, mass, inertia, offset, height of the potential, and two controls.
#[test]
fn a_sleigh_with_parameters_and_controls() {
    controlled("dla", Dla::midpoint());
    controlled("dla-alpha", Dla::alpha(0.3).unwrap());
    controlled("dla4", Composition::suzuki4(Dla::midpoint()));
    controlled("lobatto3", Lobatto::<3>::new());
    controlled("gauss8", Gauss::<4>::default());
    controlled("energy2", Energy::<1>::new());
    controlled("energy4", Energy::<2>::new());
}

/// Its closed step and its accelerations by hand are differentiated through the general equations.
#[test]
fn the_free_sleigh() {
    let sleigh = Sleigh::new(1.3, 0.8, 0.4).unwrap();
    let sensitivity = Sensitivity::of(&sleigh);
    assert_close("dla", disagreement(&sensitivity, |_| sleigh, Dla::midpoint(), &bare()));
    assert_close("gauss8", disagreement(&sensitivity, |_| sleigh, Gauss::<4>::default(), &bare()));
}

#[test]
fn multipliers_with_time_everywhere() {
    let sensitivity = Sensitivity::of(&Moving);
    let symmetrised = Symmetrised::new(0.2).unwrap();
    assert_close("trapezoid", disagreement(&sensitivity, |_| Moving, Dla::trapezoid(), &bare()));
    assert_close("mixed", disagreement(&sensitivity, |_| Moving, Dla::new(symmetrised, Trapezoid), &bare()));
    assert_close("lobatto3", disagreement(&sensitivity, |_| Moving, Lobatto::<3>::new(), &bare()));
}

#[test]
fn an_affine_constraint() {
    let table = || Guided::turntable(Sleigh::new(1.3, 0.8, 0.4).unwrap(), 0.6).unwrap();
    let system = table();
    let sensitivity = Sensitivity::of(&system);
    let mixed = Dla::new(Midpoint, Midpoint).solved(Form::Multipliers);
    assert_close("multipliers", disagreement(&sensitivity, |_| table(), mixed, &bare()));
    assert_close("gauss8", disagreement(&sensitivity, |_| table(), Gauss::<4>::default(), &bare()));
}
