//! The power of what drives or brakes a scene, by name.

use dla::Stepper;
use lagrangian::{Effect, System, With, force_power, lagrangian_power};
use sleigh::closed::ClosedForm;
use sleigh::effects::EffectList;
use sleigh::series::{InOwnAxes, OwnPush, PushInOwnAxes};
use sleigh::{Flywheel, Guided, Sleigh, SleighBody, Taylor};

/// The power of one effect at one node.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectPower {
    /// The effect's kind, numbered from the second effect of the same kind on.
    pub name: String,
    /// The power that the effect feeds into the energy (W).
    pub power: f64,
}

/// The effects of a scene, perhaps none.
pub(super) trait SceneEffects<B, const N: usize>: Effect<B, N> + PushInOwnAxes {
    /// The power of each effect that has power.
    fn powers(&self, body: &B, t: f64, q: &[f64; N], v: &[f64; N]) -> Vec<EffectPower>;
}

impl<B, const N: usize> SceneEffects<B, N> for () {
    fn powers(&self, _body: &B, _t: f64, _q: &[f64; N], _v: &[f64; N]) -> Vec<EffectPower> {
        Vec::new()
    }
}

/// One effect alone, without a body, as a system: its parts of a Lagrangian and of the forces.
struct EffectAlone<'a, B, E> {
    body: &'a B,
    effect: &'a E,
}

impl<B, E: Effect<B, N>, const N: usize> System<N, 0> for EffectAlone<'_, B, E> {
    fn lagrangian<S: lagrangian::Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> S {
        self.effect.lagrangian(self.body, t, q, v).unwrap_or(S::zero())
    }
    fn constraint<S: lagrangian::Scalar>(&self, _t: S, _q: &[S; N]) -> lagrangian::Constraint<S, N, 0> {
        ([], [])
    }
    fn force<S: lagrangian::Scalar>(&self, t: S, q: &[S; N], v: &[S; N]) -> Option<[S; N]> {
        self.effect.force(self.body, t, q, v)
    }
}

impl<B: SleighBody, const N: usize> SceneEffects<B, N> for EffectList {
    fn powers(&self, body: &B, t: f64, q: &[f64; N], v: &[f64; N]) -> Vec<EffectPower> {
        let mut powers: Vec<EffectPower> = Vec::new();
        for effect in self.all() {
            if effect.is_ground() {
                continue;
            }
            let kind = effect.kind();
            let before = self.all().iter().take_while(|other| !std::ptr::eq(*other, effect));
            let number = 1 + before.filter(|other| other.kind() == kind).count();
            powers.push(EffectPower { name: numbered(kind, number), power: power_of(body.sleigh(), effect, t, q, v) });
        }
        powers
    }
}

/// The power of an effect.
fn power_of<B, E: Effect<B, N>, const N: usize>(body: &B, effect: &E, t: f64, q: &[f64; N], v: &[f64; N]) -> f64 {
    let alone = EffectAlone { body, effect };
    force_power(&alone, t, q, v).unwrap_or(0.0) + lagrangian_power(&alone, t, q, v)
}

/// The name of effect `number`, counted from 1 among the effects of its kind.
fn numbered(kind: &str, number: usize) -> String {
    if number == 1 { kind.to_owned() } else { format!("{kind}_{number}") }
}

/// A body of a scene: a sleigh, perhaps with a rotor, perhaps guided.
pub(super) trait SceneBody<const N: usize, const M: usize>: SleighBody + ClosedForm<N, M> {
    /// The power of everything that drives the body's own coordinates and constraints, which have the multipliers `lambda`.
    fn powers(&self, t: f64, q: &[f64; N], v: &[f64; N], lambda: &[f64; M]) -> Vec<EffectPower>;

    /// The series method of the body under this push, with this tolerance; `None` if the body has no such series.
    fn series(&self, _push: OwnPush, _tolerance: f64) -> Option<Stepper<'static, N, M>> {
        None
    }
}

impl SceneBody<3, 1> for Sleigh {
    fn series(&self, push: OwnPush, tolerance: f64) -> Option<Stepper<'static, 3, 1>> {
        Some(Box::new(Taylor::in_axes(self.own_axes()?.pushed(push)?, tolerance)))
    }

    fn powers(&self, _t: f64, _q: &[f64; 3], _v: &[f64; 3], _lambda: &[f64; 1]) -> Vec<EffectPower> {
        Vec::new()
    }
}

impl<const K: usize, const M: usize> SceneBody<3, M> for Guided<K>
where
    Self: System<3, M>,
{
    /// The power of moving masses follows from their Lagrangians. A constraint `A v + b = 0` with the multiplier `lambda` has the power
    /// `-lambda . b`.
    fn powers(&self, t: f64, q: &[f64; 3], v: &[f64; 3], lambda: &[f64; M]) -> Vec<EffectPower> {
        let (_, b) = self.constraint(t, q);
        let power = |rows: std::ops::Range<usize>| -rows.map(|k| lambda[k] * b[k]).sum::<f64>();
        let masses = self.masses().iter().enumerate();
        let mut powers: Vec<_> = masses
            .map(|(k, mass)| EffectPower { name: numbered("moving_mass", k + 1), power: power_of(self, mass, t, q, v) })
            .collect();
        if self.table_rate() != 0.0 {
            powers.push(EffectPower { name: "turntable".to_owned(), power: power(0..1) });
        }
        if let Some(name) = self.guided_by() {
            powers.push(EffectPower { name: name.to_owned(), power: power(1..M) });
        }
        powers
    }
}

impl<B: SceneBody<3, M>, const M: usize> SceneBody<4, M> for Flywheel<B> {
    fn powers(&self, t: f64, q: &[f64; 4], v: &[f64; 4], lambda: &[f64; M]) -> Vec<EffectPower> {
        let mut powers = self.body().powers(t, &[q[0], q[1], q[2]], &[v[0], v[1], v[2]], lambda);
        if let Some(torque) = self.torque() {
            powers.push(EffectPower { name: "flywheel".to_owned(), power: torque.value(t) * v[3] });
        }
        powers
    }
}

/// The powers of a body and of what acts on it.
pub(super) fn of<B, E, const N: usize, const M: usize>(
    system: &With<B, E>,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
    lambda: &[f64; M],
) -> Vec<EffectPower>
where
    B: SceneBody<N, M>,
    E: SceneEffects<B, N>,
{
    let mut powers = system.effects.powers(&system.body, t, q, v);
    powers.extend(system.body.powers(t, q, v, lambda));
    powers
}
