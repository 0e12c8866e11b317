use crate::parts::{Hinge, Motor, RotorElement};
use crate::{Assembly, AssemblyError, AssemblyState};
use lagrangian::{Piecewise, System};
use sleigh::{Sleigh, SleighError, SleighState, TimeFunction};

/// One blade of a train: a sleigh, hinged by a bar ahead of its blade to the one before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trailer {
    /// The sleigh: mass, inertia, offset of its centre of mass ahead of its blade.
    pub sleigh: Sleigh,
    /// The distance `b` of the hinge behind the blade before it (m); zero puts it on that blade.
    pub hitch: f64,
    /// The distance `d` of the hinge ahead of the trailer's own blade (m), which must not be zero.
    pub bar: f64,
}

impl Trailer {
    /// A trailer of mass `m` (kg), inertia `I` about its centre of mass (kg m^2) and offset `a` (m).
    ///
    /// # Errors
    /// [`SleighError`] names the parameter that is not finite, or that must be positive and is not.
    pub fn new(mass: f64, inertia: f64, offset: f64, hitch: f64, bar: f64) -> Result<Self, SleighError> {
        Ok(Self { sleigh: Sleigh::new(mass, inertia, offset)?, hitch, bar })
    }

    fn checked(&self) -> Result<(), AssemblyError> {
        let Self { hitch, bar, .. } = *self;
        if !hitch.is_finite() {
            return Err(AssemblyError::Number { what: "the hitch of a trailer", accepted: "finite", value: hitch });
        }
        if !bar.is_finite() || bar == 0.0 {
            let accepted = "finite and not zero";
            return Err(AssemblyError::Number { what: "the bar of a trailer", accepted, value: bar });
        }
        Ok(())
    }

    /// Hinges it to the blade before it.
    fn hinge(&self, assembly: &mut Assembly, before: [usize; 3], own: [usize; 3]) -> Result<(), AssemblyError> {
        let at = [before[0], before[1], before[2], own[0], own[1], own[2]];
        assembly.join("hinge", Hinge::new([-self.hitch, 0.0], [self.bar, 0.0]), at)
    }
}

/// The heading of the first blade.
const HEADING: usize = 2;

/// A train of blades: a body with a blade, and trailers each hinged to the one before it.
///
/// The coordinates of the assembly are `(x, y, theta)` of every blade in their order, and then the angle in space of a
/// [rotor](Self::with_rotor).
#[derive(Debug)]
pub struct Train {
    /// The assembly.
    pub assembly: Assembly,
    trailers: Vec<Trailer>,
    /// The rate of the rotor relative to the first blade at the start (rad/s), if there is a rotor.
    rotor_rate: Option<f64>,
}

impl Train {
    /// A train behind the system `lead`, which may have constraints beside its blade's. `body` makes the body of each trailer, with its
    /// effects.
    ///
    /// # Errors
    /// [`AssemblyError::Number`] if a bar has no length, or a distance is not finite.
    pub fn new<Lead, Body, const M: usize>(
        lead: Lead,
        trailers: Vec<Trailer>,
        body: impl Fn(&Trailer) -> Body,
    ) -> Result<Self, AssemblyError>
    where
        Lead: System<3, M> + Piecewise + Send + Sync + 'static,
        Body: System<3, 1> + Piecewise + Send + Sync + 'static,
    {
        let mut assembly = Assembly::new();
        let mut before = assembly.body("blade", lead);
        for trailer in &trailers {
            trailer.checked()?;
            let own = assembly.body("blade", body(trailer));
            trailer.hinge(&mut assembly, before, own)?;
            before = own;
        }
        Ok(Self { assembly, trailers, rotor_rate: None })
    }

    /// The train with a rotor on a bearing in the first blade, as a [`Flywheel`](sleigh::Flywheel): its spin inertia (kg m^2), its rate
    /// relative to the blade at the start (rad/s), and the torque of its motor (N m) unless the bearing is free.
    ///
    /// # Errors
    /// [`AssemblyError::Number`] if the inertia is not positive.
    pub fn with_rotor(mut self, inertia: f64, rate: f64, torque: Option<TimeFunction>) -> Result<Self, AssemblyError> {
        if !(inertia.is_finite() && inertia > 0.0) {
            let what = "the inertia of the rotor";
            return Err(AssemblyError::Number { what, accepted: "finite and positive", value: inertia });
        }
        let [rotor] = self.assembly.body("rotor", RotorElement { inertia });
        if let Some(torque) = torque {
            self.assembly.attach("motor", Motor { torque }, [HEADING, rotor])?;
        }
        self.rotor_rate = Some(rate);
        Ok(self)
    }

    /// The trailers, from the first.
    #[must_use]
    pub fn trailers(&self) -> &[Trailer] {
        &self.trailers
    }

    /// The state with the first blade at `start` and the trailers at these headings (rad), hinged, with no blade slipping. A trailer
    /// beyond the end of the list has the heading of the blade before it.
    ///
    /// With the hinge `H = P - b e` of a blade, the next has `P+ = H - d e+`, `omega+ = n+ . H' / d` and `u+ = e+ . H'`.
    #[must_use]
    pub fn start(&self, start: &SleighState, headings: &[f64]) -> AssemblyState {
        let (q, v) = self.start_on_turntable(0.0, start, headings);
        AssemblyState::new(&self.assembly, &q, &v)
    }

    /// Configuration and velocity of the start on a plane that turns at the rate `Omega` about the origin (rad/s). Each blade then has the
    /// velocity of the plane across it, `s = Omega n . (-y, x)`, and the next blade has `omega+ = (n+ . H' - s+) / d`.
    #[must_use]
    pub fn start_on_turntable(&self, table_rate: f64, start: &SleighState, headings: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let across = |x: f64, y: f64, sin: f64, cos: f64| table_rate * (x * cos + y * sin);
        let (mut q, mut v) = (Vec::new(), Vec::new());
        let ([mut x, mut y, mut heading], [mut vx, mut vy, mut rate]) = start.to_coordinates();
        let (sin, cos) = heading.sin_cos();
        let s = across(x, y, sin, cos);
        (vx, vy) = (vx - s * sin, vy + s * cos);
        q.extend([x, y, heading]);
        v.extend([vx, vy, rate]);
        for (k, trailer) in self.trailers.iter().enumerate() {
            let (sin, cos) = heading.sin_cos();
            let hinge = [x - trailer.hitch * cos, y - trailer.hitch * sin];
            let moving = [vx + trailer.hitch * rate * sin, vy - trailer.hitch * rate * cos];
            heading = headings.get(k).copied().unwrap_or(heading);
            let (sin, cos) = heading.sin_cos();
            (x, y) = (hinge[0] - trailer.bar * cos, hinge[1] - trailer.bar * sin);
            let (along, s) = (moving[0] * cos + moving[1] * sin, across(x, y, sin, cos));
            rate = (moving[1] * cos - moving[0] * sin - s) / trailer.bar;
            (vx, vy) = (along * cos - s * sin, along * sin + s * cos);
            q.extend([x, y, heading]);
            v.extend([vx, vy, rate]);
        }
        if let Some(relative) = self.rotor_rate {
            q.push(q[HEADING]);
            v.push(v[HEADING] + relative);
        }
        (q, v)
    }

    /// The smooth piece of the train that holds at the time `t` (s), continued to all times.
    #[must_use]
    pub fn smooth_piece(&self, t: f64) -> Self {
        let Self { assembly, trailers, rotor_rate } = self;
        Self { assembly: assembly.smooth_piece(t), trailers: trailers.clone(), rotor_rate: *rotor_rate }
    }

    /// Place (m) and heading (rad) of every trailer behind a first blade, hinged as they are, with these headings: with the hinge
    /// `H = P - b e` of a blade, the next has `P+ = H - d e+`.
    #[must_use]
    pub fn places(&self, first: [f64; 3], headings: &[f64]) -> Vec<[f64; 3]> {
        let mut before = first;
        let behind = |(trailer, heading): (&Trailer, &f64)| {
            let ([x, y, turned], (sin, cos)) = (before, heading.sin_cos());
            let hinge = [x - trailer.hitch * turned.cos(), y - trailer.hitch * turned.sin()];
            before = [hinge[0] - trailer.bar * cos, hinge[1] - trailer.bar * sin, *heading];
            before
        };
        self.trailers.iter().zip(headings).map(behind).collect()
    }

    /// Whether the train has a rotor.
    #[must_use]
    pub fn has_rotor(&self) -> bool {
        self.rotor_rate.is_some()
    }

    /// Angle (rad) and rate (rad/s) of the rotor relative to the first blade, from coordinates and velocities of the assembly; `None`
    /// without a rotor.
    #[must_use]
    pub fn rotor(&self, q: &[f64], v: &[f64]) -> Option<[f64; 2]> {
        let rotor = 3 * (1 + self.trailers.len());
        self.rotor_rate?;
        Some([q.get(rotor)? - q.get(HEADING)?, v.get(rotor)? - v.get(HEADING)?])
    }

    /// Place, heading, speed and turn rate of a blade, counted from 0, from coordinates and velocities of the assembly; NaN if these lack the
    /// blade.
    #[must_use]
    pub fn blade(&self, q: &[f64], v: &[f64], k: usize) -> SleighState {
        let of = |x: &[f64]| [0, 1, 2].map(|i| x.get(3 * k + i).copied().unwrap_or(f64::NAN));
        SleighState::from_coordinates(&of(q), &of(v))
    }
}
