//! The free sleigh, whose motion is known in closed form.

use crate::HardCaseError;
use crate::lab::{HEADING, Lab, MOTION, PLACE, SPEED, SPIN, Setup};
use harness::MethodKind;
use harness::stability::check::{agrees, constraint, ends_at, energy, follows, rounding, sign_kept, stays_below};
use harness::stability::{Case, Claim, claims};
use std::f64::consts::PI;

pub(crate) const SMALL_SPIN: Case = Case {
    name: "small-spin",
    hard: "The sleigh starts backward with a spin of 1e-8 or 1e-12 rad/s and turns around much later. An absolute \
           tolerance takes the spin for zero.",
    shows: "The sign of the spin at every node, the final speed +U, the whole turn pi sqrt(J/(m a^2)).",
    bar: "No node with the wrong sign. Speed and turn: the method's order over the turn, (h U/k)^p pi sigma, and \
          rounding.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn small_spin(lab: &mut Lab) -> Result<(), HardCaseError> {
    for spin in [1e-8, -1e-12] {
        turns_around(lab, spin, 0.05)?;
    }
    Ok(())
}

pub(crate) const TINY_SPIN: Case = Case {
    name: "tiny-spin",
    hard: "A spin of -1e-300 rad/s, far below the rounding of the speed: only methods that carry the spin by itself \
           keep it.",
    shows: "As small-spin.",
    bar: "As small-spin.",
    claim: Claim::SmallSpin,
    refusable: false,
};

pub(crate) fn tiny_spin(lab: &mut Lab) -> Result<(), HardCaseError> {
    turns_around(lab, -1e-300, 0.2)
}

/// From nearly straight backward to nearly straight forward.
fn turns_around(lab: &mut Lab, spin: f64, step: f64) -> Result<(), HardCaseError> {
    let [kappa, all] = Setup::new(-1.0, spin, step, step).rates()?;
    let flip = (2.0 * all / spin.abs()).ln() / kappa;
    let setup = Setup::new(-1.0, spin, step, flip + 25.0 / kappa);
    let exact = setup.exact()?;
    let (end, turn) = (exact.at(setup.duration()), exact.turning_angle());
    // Energy can be gained or lost only while it turns.
    let bar = lab.accuracy(step * all, turn, setup.steps);
    let run = lab.record(&setup)?;
    let ends = [ends_at(&run, [SPEED], [end.speed], bar), ends_at(&run, [HEADING], [end.heading], bar * turn)];
    let found: Vec<_> = ends.into_iter().chain([Some(sign_kept(&run, SPIN)), lab.constraint(&run, 1.0)]).collect();
    lab.judge(format!("spin {spin:e}"), &run, found.into_iter().flatten());
    Ok(())
}

pub(crate) const SUBNORMAL_SPIN: Case = Case {
    name: "subnormal-spin",
    hard: "Spins of 1e-310 and 5e-324 rad/s, the least number there is: products with them lose digits or vanish.",
    shows: "The spin never changes its sign, on the unstable line and on the stable one. On the stable line it may \
            become zero.",
    bar: "No node with the wrong sign while the spin grows; no spin above the first while it dies out.",
    claim: Claim::SmallSpin,
    refusable: false,
};

pub(crate) fn subnormal_spin(lab: &mut Lab) -> Result<(), HardCaseError> {
    for spin in [1e-310, -5e-324] {
        let growing = Setup::new(-1.0, spin, 0.05, 100.0);
        lab.run(format!("spin {spin:e}, growing"), &growing, |run| [sign_kept(run, SPIN)])?;
        let dying = Setup::new(1.0, spin, 0.05, 100.0);
        lab.run(format!("spin {spin:e}, dying out"), &dying, |run| [stays_below(run, SPIN, 0.0, spin.abs())])?;
    }
    Ok(())
}

pub(crate) const STABLE_LINE: Case = Case {
    name: "stable-line",
    hard: "Forward with the centre of mass ahead a spin dies out. After 40 time constants only rounding is left, and \
           whatever else a method carries along.",
    shows: "The spin decays and stays at rounding.",
    bar: "Rounding of each step, summed with the decay: rounding/(kappa h).",
    claim: Claim::StableLine,
    refusable: false,
};

pub(crate) fn stable_line(lab: &mut Lab) -> Result<(), HardCaseError> {
    let setup = Setup::new(1.0, 0.3, 0.05, 400.0);
    let [kappa, all] = setup.rates()?;
    let bar = rounding(1, all) / (kappa * setup.step);
    lab.run("", &setup, |run| [stays_below(run, SPIN, 40.0 / kappa, bar)])
}

pub(crate) const THERE_AND_BACK: Case = Case {
    name: "there-and-back",
    hard: "Forward until the spin is e^-17 of its start, then with the velocity reversed. The rounding error of the \
           spin grows as e^(kappa t) on the way back.",
    shows: "The sleigh comes home, with the opposite velocity.",
    bar: "Rounding over all steps, times e^(kappa T). Where the spin has digits of its own: without the factor, and \
          with T twice as long.",
    claim: Claim::Symmetry,
    refusable: false,
};

pub(crate) fn there_and_back(lab: &mut Lab) -> Result<(), HardCaseError> {
    let own_digits = keeps_small_digits(lab.method.info().kind);
    let duration = if own_digits { 80.0 } else { 40.0 };
    let mut setup = Setup::new(1.0, 0.3, 0.05, duration);
    setup.back = true;
    let [kappa, all] = setup.rates()?;
    let growth = if own_digits { kappa * duration } else { (kappa * duration).exp() };
    // A turn that is wrong by so much puts the blade off by the way that it goes.
    let bar = rounding(2 * setup.steps as usize, growth) * all * duration;
    lab.run("", &setup, |run| {
        let home = run.nodes.first().map_or([f64::NAN; 5], |start| MOTION.map(|i| start.values[i]));
        ends_at(run, MOTION, [home[0], home[1], home[2], -home[3], -home[4]], bar)
    })
}

/// What solves for the spin relative to itself, not to the speed: closed forms, and explicit stages of quasi-velocities. The
/// methods that keep the energy settle at the rounding of the largest momentum.
fn keeps_small_digits(method: MethodKind) -> bool {
    let energy = claims(method, Claim::Energy).is_ok();
    claims(method, Claim::SmallSpin).is_ok() && !energy
}

/// What leads along the line by `(1 - h c u/2)/(1 + h c u/2)`, or a composition of it: it has no solution where that would
/// change the sign of the spin. A higher order may be wrong by more than the spin.
fn leads_by_cayley(method: MethodKind) -> bool {
    matches!(method, MethodKind::Dla | MethodKind::DlaTrapezoid | MethodKind::DlaAlpha | MethodKind::Composed(_))
}

pub(crate) const LONG_STEP: Case = Case {
    name: "long-step",
    hard: "Steps that turn by half a turn and more, and steps with no solution on the unstable line, h c abs(u) = 2. \
           The equations have several solutions, one, or none.",
    shows: "Either the solution that continues the motion, or an error that says to shorten the step.",
    bar: "A wrong solution changes the energy by orders of magnitude. On the unstable line dla and its compositions \
          keep the sign of the spin: their step there is the Cayley transform.",
    claim: Claim::Continuation,
    refusable: true,
};

pub(crate) fn long_step(lab: &mut Lab) -> Result<(), HardCaseError> {
    for turn in [0.6, 1.2, 2.4, 3.1, 3.2, 4.8, 100.0] {
        let setup = Setup::new(0.1, turn, 1.0, 20.0);
        let all = setup.exact()?.energy();
        lab.run(format!("h omega = {turn}"), &setup, |run| [energy(run, all)])?;
    }
    for growth in [1.8, 2.0, 2.2, 20.0] {
        let setup = Setup::new(-1.0, 1e-3, growth / 0.4, 20.0 * growth / 0.4);
        let all = setup.exact()?.energy();
        let signed = leads_by_cayley(lab.method.info().kind);
        lab.run(format!("h c u = -{growth}"), &setup, |run| {
            std::iter::once(energy(run, all)).chain(signed.then(|| sign_kept(run, SPIN))).collect::<Vec<_>>()
        })?;
    }
    Ok(())
}

pub(crate) const STEP_LENGTHS: Case = Case {
    name: "step-lengths",
    hard: "A step of 1e-12 s moves the sleigh by less than the rounding of its place; one of 1e3 or 1e12 s is beyond \
           all stability.",
    shows: "The way is right to the rounding of one place, not of a thousand. Long steps are refused, except on a \
            straight line, which they keep.",
    bar: "The rounding of a place of 1 m, and of the way; the energy within its own size, on the line within rounding.",
    claim: Claim::Continuation,
    refusable: true,
};

pub(crate) fn step_lengths(lab: &mut Lab) -> Result<(), HardCaseError> {
    let mut short = Setup::new(-1.0, 0.3, 1e-12, 1e-9);
    (short.start.x, short.start.heading) = (1.0, 0.3);
    let end = short.exact()?.at(short.duration());
    let bar = f64::EPSILON + rounding(short.steps as usize, short.duration());
    lab.run("h = 1e-12 s", &short, |run| ends_at(run, [0, 1, HEADING], [end.x, end.y, end.heading], bar))?;
    for step in [1e3, 1e12] {
        let straight = Setup::new(1.0, 0.0, step, 10.0 * step);
        lab.run(format!("h = {step:e} s, straight"), &straight, |run| [energy(run, rounding(10, 1.0))])?;
        let turning = Setup::new(1.0, 0.3, step, 10.0 * step);
        let all = turning.exact()?.energy();
        lab.run(format!("h = {step:e} s, turning"), &turning, |run| [energy(run, all)])?;
    }
    Ok(())
}

pub(crate) const OFFSETS: Case = Case {
    name: "offsets",
    hard: "The offset a -> 0, where the turn diverges and nothing straightens; a = 0 exactly; and a < 0.",
    shows: "The closed form, uniformly. With a = 0 the spin is constant; with -a and -u, the axis reversed, the motion \
            is the same.",
    bar: "The method's order over the run, and rounding; rounding alone for the constant and for the mirror image.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn offsets(lab: &mut Lab) -> Result<(), HardCaseError> {
    for body in [[1.0, 1.0, 1e-12], [1.0, 1.0, 0.0], [1.0, 1.0, -0.5]] {
        let [_, inertia, offset] = body;
        let setup = Setup { body, ..Setup::new(-1.0, 0.3, 0.05, 20.0) };
        follows_exactly(lab, &format!("I = {inertia:e}, a = {offset:e}"), &setup)?;
    }
    let still = Setup { body: [1.0, 1.0, 0.0], ..Setup::new(-1.0, 0.3, 0.05, 50.0) };
    let bar = rounding(still.steps as usize, 1.0);
    lab.run("a = 0, the spin", &still, |run| [follows(run, [SPIN], |_| [0.3], 0.3 * bar)])?;

    let setup = Setup::new(-1.0, 0.3, 0.05, 20.0);
    let mut mirrored = Setup { body: [1.0, 1.0, -0.5], ..Setup::new(1.0, 0.3, 0.05, 20.0) };
    mirrored.start.heading = PI;
    let (run, image) = (lab.record(&setup)?, lab.record(&mirrored)?);
    let seen = |node: &harness::stability::Seen| {
        let [x, y, heading, speed, spin, _] = node.values;
        [x, y, heading - PI, -speed, spin]
    };
    let bar = rounding(setup.steps as usize, lengths(&setup)?);
    lab.judge("the mirror image", &run, [agrees(&run, &image, MOTION, seen, bar)]);
    Ok(())
}

pub(crate) const CUSP: Case = Case {
    name: "cusp",
    hard: "The speed passes through zero, where the path has a cusp: a step by arc length stalls there, and a \
           direction is 0/0.",
    shows: "The closed form, through the cusp, and the constraint in it.",
    bar: "The method's order over the run, and rounding; the constraint to rounding.",
    claim: Claim::Order,
    refusable: false,
};

pub(crate) fn cusp(lab: &mut Lab) -> Result<(), HardCaseError> {
    follows_exactly(lab, "", &Setup::new(-0.5, 0.6, 0.05, 10.0))
}

pub(crate) const NEGATIVE_SUBSTEPS: Case = Case {
    name: "negative-substeps",
    hard: "Compositions go back within a step. Beside the unstable line such a sub-step may have no solution though \
           the whole step has one.",
    shows: "The sign of the spin is kept and the sleigh turns around; or an error.",
    bar: "As small-spin at h = 0.5 s; at h = 4 s the energy to its own size, and the sign as in long-step.",
    claim: Claim::Continuation,
    refusable: true,
};

pub(crate) fn negative_substeps(lab: &mut Lab) -> Result<(), HardCaseError> {
    turns_around(lab, 1e-8, 0.5)?;
    let setup = Setup::new(-1.0, 1e-8, 4.0, 200.0);
    let all = setup.exact()?.energy();
    let signed = leads_by_cayley(lab.method.info().kind);
    lab.run("h = 4 s", &setup, |run| {
        std::iter::once(energy(run, all)).chain(signed.then(|| sign_kept(run, SPIN))).collect::<Vec<_>>()
    })
}

/// What the errors of a motion are multiplied by in its place: the way, and the turn that may lead it astray.
fn lengths(setup: &Setup) -> Result<f64, HardCaseError> {
    let ([kappa, all], exact) = (setup.rates()?, setup.exact()?);
    let reach = exact.energy().sqrt() * (2.0 / setup.body[0]).sqrt() * setup.duration();
    Ok((1.0 + reach) * (1.0 + all * setup.duration()) * (1.0 + kappa * setup.duration()))
}

/// The whole motion, against the closed form.
pub(crate) fn follows_exactly(lab: &mut Lab, label: &str, setup: &Setup) -> Result<(), HardCaseError> {
    let ([kappa, all], exact) = (setup.rates()?, setup.exact()?);
    let (time, speed) = (setup.duration(), exact.energy().sqrt() * (2.0 / setup.body[0]).sqrt());
    let rate = kappa + all;
    let relative = lab.accuracy(setup.step * rate, rate * time, setup.steps);
    let run = lab.record(setup)?;
    let heading = relative * all * time;
    let path = |t| {
        let now = exact.at(t);
        [now.x, now.y]
    };
    let found = [
        follows(&run, [SPEED], |t| [exact.at(t).speed], relative * speed),
        follows(&run, [SPIN], |t| [exact.at(t).turn_rate], relative * all),
        follows(&run, [HEADING], |t| [exact.at(t).heading], heading),
        follows(&run, PLACE, path, heading.max(relative) * speed * time),
    ];
    let held = lab.constraint(&run, speed + all * setup.body[2].abs());
    lab.judge(label, &run, found.into_iter().chain(held));
    Ok(())
}

pub(crate) const ROUND_OFF: Case = Case {
    name: "round-off",
    hard: "Circles for ever: 1.3e7 steps of dla, more than a million turns, and 2e4 of every other method. Rounding \
           errors of one sign add up.",
    shows: "The constraint does not grow. Spin and energy walk at random, except with methods to which a circle is no \
            exact solution (rk4, rk4-projected, implicit-midpoint, gni).",
    bar: "sqrt(N) roundings: a walk of independent ones stays below ten of its standard deviations.",
    claim: Claim::Constraint,
    refusable: false,
};

pub(crate) fn round_off(lab: &mut Lab) -> Result<(), HardCaseError> {
    // The one that the case is about is fast, and makes them all.
    let steps = if lab.method.info().kind == MethodKind::Dla { 13_000_000 } else { 20_000 };
    let mut setup = Setup { body: [1.0, 1.0, 0.0], steps, every: 100, ..Setup::new(1.0, 1.0, 0.5, 1.0) };
    if lab.order() < 8 && lab.method.info().kind != MethodKind::Dla {
        setup.step = 0.05;
    }
    let walk = 10.0 * (steps as f64).sqrt() * f64::EPSILON;
    // Circles are not exact to these: what they lose is not rounding.
    let dissipates = matches!(
        lab.method.info().kind,
        MethodKind::Rk4 | MethodKind::Rk4Projected | MethodKind::ImplicitMidpoint | MethodKind::Gni
    );
    lab.run("", &setup, |run| {
        let mut found = vec![constraint(run, 1.0)];
        if !dissipates {
            found.push(energy(run, walk));
            found.push(follows(run, [SPIN], |_| [1.0], walk));
        }
        found
    })
}
