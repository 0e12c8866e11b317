//! The systems of one shape as the arms of one type.
//!
//! A method is compiled once for every type of system. Some seventy systems are nine types here, and what an arm adds is its
//! own functions, once for every kind of number, since the calls are not inlined. So no test passes a system itself to a
//! method, a run or a derivative: it passes the arm.

use crate::attitudes::{angles, cylinder};
use crate::constraints::{classes, driven as led, holonomic, redundant, starts};
use crate::energy::{order, refusals, systems as energy};
use crate::lobatto::{failures as dropping, systems as lobatto};
use crate::rest::{disk, systems as rest};
use crate::runs::{counter_example, events, failures, observers, scripted};
use crate::systems::{alternating, continued, degenerate, driven, lanes, models as small};
use crate::{corners, drive};
use dla::{
    AnyState, FullMechanics, Method, Observer, OneStep, OwnMethods, Piece, RunError, Schedule, State, Stepper, Subject,
    make_steps, piece_by_piece,
};
use lagrangian::{Motion, Piecewise, Reduced, ReducedError, Scalar, System, With};
use sleigh::effects::{Bowl, Drag, EggCrate, Hills, Slope, Torque};
use sleigh::{CentreOfMass, Guided, Sleigh};
use std::sync::LazyLock;
use test_systems::{ChaplyginBall, CompoundPendulum, IsokineticParticle, SleighOnArm, Suslov, TurntableBall, shape};

/// A method as what a system brings of its own: observers and runs that ask for one by its name make it.
pub(crate) struct Own<Step>(pub(crate) Step);

/// The name of a method that takes the steps of the run.
pub(crate) static OWN: LazyLock<Method> = LazyLock::new(|| Method::named("dla", None).unwrap());

/// The name of a method that makes steps of its own within a step.
pub(crate) static OWN_STEPS: LazyLock<Method> = LazyLock::new(|| Method::named("taylor", None).unwrap());

impl<Step: OneStep<N, M> + Clone, const N: usize, const M: usize> OwnMethods<N, M> for Own<Step> {
    fn closed_map<'a>(&'a self, _t: f64, _general: Stepper<'a, N, M>) -> Stepper<'a, N, M> {
        Box::new(self.0.clone())
    }

    fn series(&self, _t: f64, _tolerance: f64) -> Option<Stepper<'_, N, M>> {
        Some(Box::new(self.0.clone()))
    }
}

/// Makes a run with a method, which observers find by the names above.
pub(crate) fn run_own<Step: OneStep<N, M> + Clone, const N: usize, const M: usize>(
    system: &dyn FullMechanics<N, M>,
    method: Step,
    schedule: &Schedule,
    state: &mut State<N>,
    observer: &mut dyn Observer,
) -> Result<u64, RunError> {
    let (own, mut moved) = (Own(method), AnyState::from(*state));
    let subject = Subject::new(system, &own);
    let made = piece_by_piece(0, &subject, schedule, &mut moved, |piece, Piece { steps, schedule }, state| {
        make_steps(piece, &mut *piece.integrator(&OWN), &schedule, steps, state, observer)
    });
    *state = *moved.typed().unwrap();
    made
}

shape! {
    /// One coordinate, no constraint.
    #[derive(Copy)]
    pub(crate) Free<1, 0> {
        Oscillator: small::Oscillator,
        Falling: observers::Falling,
    }
}

shape! {
    /// One coordinate, one constraint.
    #[derive(Copy)]
    pub(crate) One<1, 1> {
        Line: drive::Line,
        Nowhere: starts::Nowhere,
        Point: scripted::Point,
        Led: observers::Led,
    }
}

shape! {
    /// Two coordinates, one constraint.
    #[derive(Copy)]
    pub(crate) Two<2, 1> {
        Cart: rest::Cart<false>,
        CartInBasis: rest::Cart<true>,
        Pendulum: rest::Pendulum,
        Swung: order::Swung,
        Rail: refusals::Rail,
        Lift: holonomic::Lift,
        Led: led::Led,
        Ring: starts::Ring,
        Along: classes::Row<classes::Along>,
        Across: classes::Row<classes::Across>,
        Turning: classes::Row<classes::Turning>,
        Vanishing: classes::Row<classes::Vanishing>,
        Dropping: degenerate::Dropping,
        Pushed: events::Pushed,
        Brake: failures::Brake,
        Braked: counter_example::Pushed,
        Lifted: counter_example::Lifted,
        Isokinetic: IsokineticParticle,
    }
}

shape! {
    /// Three coordinates, one constraint.
    #[derive(Copy)]
    pub(crate) Three<3, 1> {
        Corners: corners::Skate,
        Skate: rest::Skate<false>,
        SkateInBasis: rest::Skate<true>,
        Rosenberg: lobatto::Particle,
        InField: energy::Particle,
        Wrapped: energy::Wrapped,
        Moving: lobatto::Moving,
        Well: driven::Well,
        Particle: small::Particle,
        Hyperbolic: small::Hyperbolic,
        Pushed: small::Pushed,
        Wheel: continued::Wheel,
        Swivelling: lanes::Swivelling,
        Once: degenerate::Once,
    }
}

shape! {
    /// Three coordinates, two constraints.
    #[derive(Copy)]
    pub(crate) ThreeTwo<3, 2> {
        Dropping: dropping::Dropping,
        Towed: continued::Towed,
        Twice: degenerate::Twice,
        Pendulum: CompoundPendulum,
        OnArm: SleighOnArm,
    }
}

shape! {
    /// Four coordinates, two constraints.
    #[derive(Copy)]
    pub(crate) Four<4, 2> {
        TwoBlades: redundant::TwoBlades,
        Disk: small::Disk,
        Suslov: Suslov,
    }
}

shape! {
    /// Five coordinates, two constraints.
    #[derive(Copy)]
    pub(crate) Five<5, 2> {
        AngleBall: angles::AngleBall,
        Disk: disk::Disk,
    }
}

shape! {
    /// Six coordinates, three constraints.
    #[derive(Copy)]
    pub(crate) Six<6, 3> {
        InCylinder: cylinder::Ball,
        Chaplygin: ChaplyginBall,
        OnTurntable: TurntableBall,
    }
}

/// It never jumps.
impl Piecewise for Free {
    fn piece(&self, _t: f64) -> Self {
        *self
    }
}

impl Piecewise for One {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        if let Self::Led(led) = self { led.jumps(from, to) } else { Vec::new() }
    }
    fn piece(&self, t: f64) -> Self {
        if let Self::Led(led) = self { led.piece(t).into() } else { *self }
    }
}

impl Piecewise for Two {
    fn jumps(&self, from: f64, to: f64) -> Vec<f64> {
        if let Self::Pushed(pushed) = self { pushed.jumps(from, to) } else { Vec::new() }
    }
    fn piece(&self, t: f64) -> Self {
        if let Self::Pushed(pushed) = self { pushed.piece(t).into() } else { *self }
    }
}

/// The same with equations by hand. It is a type of its own, since methods take another way for a system without them.
macro_rules! by_hand {
    ($(#[$text:meta])* $name:ident<$n:literal, $m:literal> { $($arm:ident: $type:ty,)* }) => {
        shape! {
            $(#[$text])*
            pub(crate) $name<$n, $m> { $($arm: $type,)* }
            fn reduced(&self) -> impl Reduced<$n, $m> {
                self
            }
        }

        impl Reduced<$n, $m> for $name {
            #[inline(never)]
            fn motion(&self, t: f64, q: &[f64; $n], v: &[f64; $n]) -> Option<Motion<$n, $m>> {
                match self { $(Self::$arm(x) => System::reduced(x).motion(t, q, v),)* }
            }
            #[inline(never)]
            fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; $n], xi: &[S; $n]) -> Option<[S; $n]> {
                match self { $(Self::$arm(x) => System::reduced(x).reduced_motion(t, q, xi),)* }
            }
            #[inline(never)]
            fn velocity<S: Scalar>(
                &self,
                t: S,
                q: &[S; $n],
                xi: &[S; $n],
                derived: impl FnOnce() -> Result<[S; $n], ReducedError>,
            ) -> Result<[S; $n], ReducedError> {
                match self { $(Self::$arm(x) => System::reduced(x).velocity(t, q, xi, derived),)* }
            }
            fn reconstruction(&self) -> Option<u32> {
                match self { $(Self::$arm(x) => System::reduced(x).reconstruction(),)* }
            }
            fn stands_alone(&self) -> bool {
                match self { $(Self::$arm(x) => System::reduced(x).stands_alone(),)* }
            }
            #[inline(never)]
            fn response(&self, t: f64, q: &[f64; $n], force: &[f64; $n]) -> Option<Motion<$n, $m>> {
                match self { $(Self::$arm(x) => System::reduced(x).response(t, q, force),)* }
            }
            #[inline(never)]
            fn pushed_motion<S: Scalar>(&self, t: S, q: &[S; $n], xi: &[S; $n], force: &[S; $n]) -> Option<[S; $n]> {
                match self { $(Self::$arm(x) => System::reduced(x).pushed_motion(t, q, xi, force),)* }
            }
        }
    };
}

by_hand! {
    /// Three coordinates, one constraint: sleighs, whose motion is known by hand, and what acts on them.
    ByHand<3, 1> {
        Sleigh: Sleigh,
        OnTurntable: Guided<0>,
        InBowl: With<Sleigh, Bowl>,
        InOneBowl: With<Sleigh, (Bowl,)>,
        OverHills: With<Sleigh, Hills>,
        Dragged: With<Sleigh, Drag>,
        Twisted: With<Sleigh, Torque>,
        TwistedOnce: With<Sleigh, (Torque,)>,
        Nested: With<Sleigh, ((Bowl, EggCrate), Drag)>,
        Crowd: With<Sleigh, (Bowl, Drag, Slope, EggCrate, Torque)>,
        Forced: With<Sleigh, lobatto::Forces>,
        InPotential: With<Sleigh, energy::Potential>,
        ComForced: With<CentreOfMass, lobatto::Forces>,
        ComInPotentialForced: With<CentreOfMass, (energy::Potential, lobatto::Forces)>,
        ComInPotential: With<CentreOfMass, energy::Potential>,
        ComBraked: With<CentreOfMass, (energy::Potential, energy::Friction)>,
        ComInBowl: With<CentreOfMass, alternating::Bowl>,
    }
}

/// None of them jumps.
impl Piecewise for ByHand {
    fn piece(&self, _t: f64) -> Self {
        self.clone()
    }
}
