//! The hard cases of `noslip stability`: what is run, and the physics by which the runs are judged.
//!
//! ```
//! use hard_cases::CASES;
//! use harness::{Method, stability::Outcome};
//!
//! let case = CASES.iter().find(|case| case.case().name == "long-step").unwrap();
//! let method = Method::named("dla", None)?;
//! assert!(case.takes(&method));
//! assert_ne!(case.verdict(&method)?.outcome, Outcome::Failed);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod driven;
mod error;
mod fields;
mod free;
mod lab;
mod large;
mod numbers;
mod one_row;
mod rest;
mod systems;
mod two_rows;

use harness::Method;
use harness::stability::{Case, Verdict, claims, judge};
use lab::Lab;

pub use error::HardCaseError;
pub use two_rows::TwoRows;

type Runs = fn(&mut Lab) -> Result<(), HardCaseError>;

/// A case, and what makes its runs.
#[derive(Debug, Clone, Copy)]
pub struct HardCase {
    case: Case,
    runs: Runs,
    /// Whether a scene has its system.
    of_a_scene: bool,
}

/// The cases.
pub const CASES: &[HardCase] = &[
    of_a_scene(free::SMALL_SPIN, free::small_spin),
    of_a_scene(free::TINY_SPIN, free::tiny_spin),
    of_a_scene(free::SUBNORMAL_SPIN, free::subnormal_spin),
    of_a_scene(free::STABLE_LINE, free::stable_line),
    of_a_scene(free::THERE_AND_BACK, free::there_and_back),
    of_a_scene(free::LONG_STEP, free::long_step),
    of_a_scene(free::STEP_LENGTHS, free::step_lengths),
    of_a_scene(free::NEGATIVE_SUBSTEPS, free::negative_substeps),
    of_a_scene(free::OFFSETS, free::offsets),
    of_a_scene(free::CUSP, free::cusp),
    of_a_scene(free::ROUND_OFF, free::round_off),
    of_a_scene(numbers::FAR_AWAY, numbers::far_away),
    of_a_scene(numbers::MANY_TURNS, numbers::many_turns),
    of_a_scene(numbers::LATE, numbers::late),
    of_a_scene(numbers::MASSES, numbers::masses),
    of_a_scene(numbers::LIGHT_INERTIA, numbers::light_inertia),
    of_a_scene(numbers::FAST, numbers::fast),
    of_a_scene(fields::STIFF_BOWL, fields::stiff_bowl),
    of_a_scene(fields::STEEP_HILL, fields::steep_hill),
    of_a_scene(fields::TURNING_POINTS, fields::turning_points),
    of_a_scene(fields::LOG_WELL, fields::log_well),
    of_a_scene(fields::ATTRACTOR, fields::attractor),
    of_a_scene(fields::ROUND_BOWL, fields::round_bowl),
    of_a_scene(fields::HEAVY_DRAG, fields::heavy_drag),
    of_a_scene(rest::SETTLES, rest::settles),
    of_a_scene(rest::TINY_SWING, rest::tiny_swing),
    of_a_scene(rest::BALANCE, rest::balance),
    of_a_scene(rest::CANCELLING_FORCES, rest::cancelling_forces),
    of_a_scene(driven::ROTOR_DRIVE, driven::rotor_drive),
    of_a_scene(driven::FAST_ROTOR, driven::fast_rotor),
    of_a_scene(driven::PLANIMETER, driven::planimeter),
    of_a_scene(driven::CORNERS, driven::corners),
    of_a_scene(driven::JUMPS, driven::jumps),
    of_a_scene(driven::TURNTABLE, driven::turntable),
    of_another_system(systems::PARALLEL_BLADES, systems::parallel_blades),
    of_another_system(systems::DROPPING_ROW, systems::dropping_row),
    of_another_system(systems::PSEUDO_HOLONOMIC, systems::pseudo_holonomic),
    of_another_system(one_row::GAUGE, one_row::gauge),
    of_another_system(one_row::FORCE_WITH_A_CORNER, one_row::force_with_a_corner),
    of_another_system(one_row::CHART_END, one_row::chart_end),
    of_another_system(large::MANY_BODIES, large::many_bodies),
];

const fn of_a_scene(case: Case, runs: Runs) -> HardCase {
    HardCase { case, runs, of_a_scene: true }
}

const fn of_another_system(case: Case, runs: Runs) -> HardCase {
    HardCase { case, runs, of_a_scene: false }
}

impl HardCase {
    /// The case, in words.
    #[must_use]
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// Whether the case has a row for the method: one whose system no scene has is made by a few methods.
    #[must_use]
    pub fn takes(&self, method: &Method) -> bool {
        self.of_a_scene || systems::METHODS.contains(&method.info().kind)
    }

    /// Makes the runs of the case by the method, and judges them.
    ///
    /// # Errors
    /// [`HardCaseError`] where a system of the case cannot be built.
    pub fn verdict(&self, method: &Method) -> Result<Verdict, HardCaseError> {
        let mut lab = Lab::new(*method);
        (self.runs)(&mut lab)?;
        Ok(judge(&self.case, claims(method.info().kind, self.case.claim), &lab.trials))
    }
}
