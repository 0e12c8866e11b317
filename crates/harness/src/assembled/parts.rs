use super::meter::AssemblyMeter;
use super::step::{AssemblyStep, LastNode};
use assembly::{Assembly, AssemblyError, AssemblyMethod, AssemblyState};
use dla::{Halved, Substeps, Undivided};
use lagrangian::linear::larger;
use std::ops::ControlFlow;

/// A step that was made in parts.
pub(super) struct Parted {
    /// The node at which an event has ended the run within it.
    pub(super) last: Option<LastNode>,
    pub(super) iterations: u32,
    pub(super) parts: u64,
}

/// Makes the step `(k, t, h)`, which has failed as a whole, in parts; nothing where `stops` gave it up. The meter is shown the work of
/// each.
///
/// # Errors
/// [`Undivided`] where it cannot be made in parts either.
pub(super) fn in_parts(
    assembly: &Assembly,
    method: &mut dyn AssemblyMethod,
    (limits, (k, t, h), failure): (Substeps, (u64, f64, f64), AssemblyError),
    (state, meter): (&mut AssemblyState, &mut AssemblyMeter<'_>),
    stops: impl Fn() -> bool,
    mut look: impl FnMut(&mut dyn AssemblyMethod, AssemblyStep<'_>) -> ControlFlow<LastNode>,
) -> Result<Option<Parted>, Undivided<AssemblyError>> {
    let mut start = state.clone();
    let (mut last, mut iterations, mut parts) = (None, 0, 0);
    let made = limits.divide((t, h), failure, AssemblyError::may_hold_in_parts, |(t, h), _| {
        start.copy_from(state);
        let made = method.step(assembly, t, h, state)?;
        if let Err(failure) = resolves(assembly, method, (t, h), (&start, state)) {
            state.copy_from(&start);
            return Err(failure);
        }
        (iterations, parts) = (iterations + made, parts + 1);
        if let ControlFlow::Break((end, found)) =
            look(method, AssemblyStep { k, t0: t, h, before: &start, after: state })
        {
            meter.over(assembly, (t, &start), (end, &found));
            last = Some((end, found));
            return Ok(ControlFlow::Break(()));
        }
        meter.over(assembly, (t, &start), (t + h, state));
        Ok(if stops() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    })?;
    let given_up = made.is_break() && last.is_none();
    Ok((!given_up).then_some(Parted { last, iterations, parts }))
}

/// Whether a step from time `t` to `t + h` resolves the motion: see [`Halved`].
///
/// # Errors
/// [`AssemblyError::Unresolved`] where it does not, and that of a half that fails.
pub(super) fn resolves(
    assembly: &Assembly,
    method: &mut dyn AssemblyMethod,
    (t, h): (f64, f64),
    (before, after): (&AssemblyState, &AssemblyState),
) -> Result<(), AssemblyError> {
    let half = 0.5 * h;
    let mut middle = before.clone();
    method.step(assembly, t, half, &mut middle)?;
    let mut end = middle.clone();
    method.step(assembly, t + half, half, &mut end)?;
    let halved = |i: usize| Halved {
        v: [before, &middle, &end, after].map(|state| state.v(i)),
        moved: [&end, after].map(|state| state.moved_since(before, i)),
    };
    let all = || (0..before.len()).map(halved);
    let place = (0..before.len()).fold(0.0, |most, i| larger(most, before.unwrapped(i)));
    let velocity = all().flat_map(|one| one.v).fold(0.0, larger);
    let nothing = Halved::nothing(h, place, velocity);
    if all().all(|one| one.is_resolved(h, velocity, nothing)) { Ok(()) } else { Err(AssemblyError::Unresolved) }
}
