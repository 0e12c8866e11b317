use super::{LaneState, Systems};
use lagrangian::{Reduced, System, velocity_of};

/// The order in which the coordinates of the stages are computed, and which of them are computed only at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Order<const N: usize> {
    /// The coordinates of an iteration: angles, and the others after them.
    pub(super) iterated: [[bool; N]; 2],
    /// Of these, those that velocities are computed from before they are computed themselves: they start at the predictor.
    pub(super) carried: [bool; N],
    /// Coordinates that nothing depends on, or only what is not iterated either: quadratures.
    pub(super) quadratures: [[bool; N]; 2],
}

impl<const N: usize> Order<N> {
    /// The order for all systems; none where one has no reduced equations by hand.
    ///
    /// Dependence is found by evaluating the model with NaN in place of a coordinate: a result that depends on it becomes NaN, since a
    /// model has no branches.
    pub(super) fn of<Sys, const W: usize, const M: usize>(
        systems: &impl Systems<Sys, W>,
        t: f64,
        state: &LaneState<N, W>,
    ) -> Option<Self>
    where
        Sys: System<N, M>,
    {
        // What the accelerations depend on, and each velocity.
        let (mut iterated, mut along) = ([false; N], [[false; N]; N]);
        for lane in 0..W {
            let (system, xi) = (systems.of(lane), state.xi(lane));
            system.reduced().reduced_motion(t, &state.q(lane), &xi)?;
            for k in 0..N {
                let mut q = state.q(lane);
                q[k] = f64::NAN;
                iterated[k] |= system.reduced().reduced_motion(t, &q, &xi)?[..N - M].iter().any(|a| a.is_nan());
                let velocity = velocity_of(system, t, &q, &xi).ok()?;
                for j in 0..N {
                    along[j][k] |= velocity[j].is_nan();
                }
            }
        }
        for _ in 0..N {
            let known = iterated;
            for k in 0..N {
                iterated[k] |= (0..N).any(|j| known[j] && along[j][k]);
            }
        }
        let angles = systems.of(0).angles();
        let chosen = |f: &dyn Fn(usize) -> bool| lagrangian::from_fn(f);
        let before = |k: usize, j: usize| angles[k] && !angles[j];
        Some(Self {
            iterated: [chosen(&|k| iterated[k] && angles[k]), chosen(&|k| iterated[k] && !angles[k])],
            carried: chosen(&|k| iterated[k] && (0..N).any(|j| iterated[j] && along[j][k] && !before(k, j))),
            quadratures: [chosen(&|k| !iterated[k] && angles[k]), chosen(&|k| !iterated[k] && !angles[k])],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Same;
    use sleigh::effects::Bowl;
    use sleigh::{RoundWell, Sleigh};

    fn order<Sys: System<3, 1>>(system: &Sys) -> Order<3> {
        let starts: Vec<_> = (0..8).map(|i| ([0.1 * f64::from(i), 0.0, 0.3], [-1.0, 0.2, 0.0])).collect();
        let state = LaneState::<3, 8>::new(&starts, system.angles());
        Order::of(&Same(system), 0.0, &state).unwrap()
    }

    const NONE: [bool; 3] = [false; 3];
    const PLACE: [bool; 3] = [true, true, false];
    const HEADING: [bool; 3] = [false, false, true];

    /// Nothing depends on where a free sleigh is; the force of a bowl does; in its own axes the places depend on each other, and
    /// nothing on the heading.
    #[test]
    fn what_depends_on_what() {
        let sleigh = Sleigh::new(1.0, 1.0, 0.5).unwrap();
        let bowl = lagrangian::With { body: sleigh, effects: Bowl::new([0.1, 0.2], [0.0; 2]).unwrap() };
        let well = RoundWell::new(sleigh, 0.1, [0.0; 2]).unwrap();
        let free = Order { iterated: [NONE; 2], carried: NONE, quadratures: [HEADING, PLACE] };
        assert_eq!(order(&sleigh), free);
        assert_eq!(order(&bowl), Order { iterated: [HEADING, PLACE], carried: NONE, quadratures: [NONE; 2] });
        assert_eq!(order(&well), Order { iterated: [NONE, PLACE], carried: PLACE, quadratures: [HEADING, NONE] });
    }
}
