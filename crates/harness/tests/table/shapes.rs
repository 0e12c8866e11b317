//! The systems of one shape as the arms of one type.
//!
//! A method is compiled once for every type of system. Twenty systems of five shapes are five types here, and what an
//! arm adds is compiled once for every kind of number, since the calls are not inlined.

use crate::table::systems::{Forces, InField, Magnetic, Moving, Thrust, Turntable};
use lagrangian::{Motion, Piecewise, Reduced, Scalar, System, With};
use sleigh::Sleigh;
use test_systems::{
    ChaplyginBall, ContactOscillator, KnifeEdge, Model, Particle, QuarticOscillator, RollerRacer, RollingDisk,
    Snakeboard, Suslov, shape,
};

/// A configuration and a velocity.
pub type Place<const N: usize> = ([f64; N], [f64; N]);

/// What is known of a system that is no [`Model`].
pub trait Known<const N: usize> {
    /// The state a time `t` (s) after the given one, in closed form.
    fn exact_from(&self, _start: &Place<N>, _t: f64) -> Option<Place<N>> {
        None
    }

    /// Integrals of the motion, by name.
    fn invariants(&self, _q: &[f64; N], _v: &[f64; N]) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

macro_rules! known {
    ($(#[$text:meta])* $name:ident<$n:literal, $m:literal>: $($model:ident)*; $($plain:ident: $type:ty),*) => {
        shape! {
            $(#[$text])*
            #[derive(Debug, Copy)]
            pub $name<$n, $m> { $($model: $model,)* $($plain: $type,)* }
            fn reduced(&self) -> impl Reduced<$n, $m> {
                self
            }
        }

        impl Piecewise for $name {
            fn piece(&self, _t: f64) -> Self {
                *self
            }
        }

        impl Reduced<$n, $m> for $name {
            #[inline(never)]
            fn motion(&self, t: f64, q: &[f64; $n], v: &[f64; $n]) -> Option<Motion<$n, $m>> {
                match self {
                    $(Self::$model(x) => x.reduced().motion(t, q, v),)*
                    $(Self::$plain(x) => x.reduced().motion(t, q, v),)*
                }
            }
            #[inline(never)]
            fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; $n], xi: &[S; $n]) -> Option<[S; $n]> {
                match self {
                    $(Self::$model(x) => x.reduced().reduced_motion(t, q, xi),)*
                    $(Self::$plain(x) => x.reduced().reduced_motion(t, q, xi),)*
                }
            }
        }

        impl Known<$n> for $name {
            fn exact_from(&self, start: &Place<$n>, t: f64) -> Option<Place<$n>> {
                match self {
                    $(Self::$model(x) => Model::exact_from(x, start, t),)*
                    $(Self::$plain(x) => Known::exact_from(x, start, t),)*
                }
            }
            fn invariants(&self, q: &[f64; $n], v: &[f64; $n]) -> Vec<(&'static str, f64)> {
                match self {
                    $(Self::$model(x) => Model::invariants(x, q, v),)*
                    $(Self::$plain(x) => Known::invariants(x, q, v),)*
                }
            }
        }
    };
}

known! {
    /// Three coordinates, one constraint.
    Three<3, 1>: Particle KnifeEdge ContactOscillator;
    Sleigh: Sleigh, InField: InField, Thrust: With<Sleigh, Thrust>, Pushed: With<InField, Thrust>, Forces: With<Sleigh, Forces>, Moving: Moving,
    Turntable: Turntable, Magnetic: Magnetic
}

known! {
    /// Four coordinates, two constraints.
    Four<4, 2>: RollingDisk RollerRacer Suslov;
}

known! {
    /// Five coordinates, two constraints.
    Five<5, 2>: Snakeboard;
}

known! {
    /// Six coordinates, three constraints.
    Six<6, 3>: ChaplyginBall;
}

known! {
    /// Seven coordinates, one constraint.
    Seven<7, 1>: QuarticOscillator;
}
