//! The runs of a hard case by one method.

use super::case::{Cases, Check, HardCase, Kind, Run, SLEIGH, makes};
use super::formulas::Formulas;
use crate::error::CliError;
use crate::inspect::method_names;
use dla::{AnyState, Dependency, Hint, Schedule, StepError};
use harness::Method;
use harness::stability::check::{self, Finding};
use harness::stability::{Recorded, Recorder, Trial, VALUES, Verdict, claims, judge};
use scene::{AnyScene, Setting, with_settings};

impl HardCase {
    /// Makes the runs of the case by the method, and judges them.
    pub(super) fn verdict(&'static self, cases: &'static Cases, method: &Method) -> Result<Verdict, CliError> {
        let case = self.case();
        let makers = self.runs.iter().filter(|run| makes(&run.methods, method));
        let trials: Result<Vec<_>, _> =
            makers.map(|run| Bench { shared: &self.shared, run, method }.trial(cases)).collect();
        let fault = |problem| CliError::Computation(vec![format!("the hard case {}: {problem}", case.name)]);
        Ok(judge(&case, claims(method.info().kind, case.claim), &trials.map_err(fault)?))
    }
}

/// A run to be made by a method.
struct Bench<'a> {
    shared: &'static Run,
    run: &'static Run,
    method: &'a Method,
}

impl Bench<'_> {
    fn trial(&self, cases: &'static Cases) -> Result<Trial, String> {
        let other = self.run.other.as_ref().or(self.shared.other.as_ref());
        let other = other.map(|set| self.record(Some(set))).transpose()?.map(|(.., recorded)| recorded);
        let (scene, names, recorded) = self.record(None)?;
        let mut formulas = Formulas::new(self.method, &scene, &names, (&recorded, other.as_ref()))?;
        for line in self.shared.abbreviations.iter().chain(&self.run.abbreviations) {
            formulas.abbreviate(line)?;
        }
        if let Some(text) = self.run.largest.as_ref().or(self.shared.largest.as_ref()) {
            let sizes = formulas.series(std::slice::from_ref(text))?;
            formulas.set("largest", check::largest("", sizes.iter().map(|(_, size)| *size), 0.0).measured);
        }
        let names = if self.run.like.is_empty() { &self.shared.like } else { &self.run.like };
        let own = if self.run.checks.is_empty() { &self.shared.checks } else { &self.run.checks };
        let (mut findings, mut asked_for) = (Vec::new(), false);
        for check in names.iter().filter_map(|name| cases.lists.get(name)).flatten().chain(own) {
            if makes(&check.methods, self.method) && (check.except.is_empty() || !makes(&check.except, self.method)) {
                asked_for |= check.kind == Kind::Dependent;
                findings.extend(self.found(check, &mut formulas, &recorded)?);
            }
        }
        // An error that the case asks for is no failure.
        let told = asked_for && findings.iter().any(|found: &Finding| found.what == NAMELESS && found.holds());
        let mut trial = Trial::new(
            &*self.run.label,
            &if told { Recorded { failure: None, ..recorded.clone() } } else { recorded.clone() },
        );
        trial.add(findings);
        Ok(trial)
    }

    /// The findings of a check.
    fn found(
        &self,
        check: &'static Check,
        formulas: &mut Formulas<'_>,
        run: &Recorded,
    ) -> Result<Vec<Finding>, String> {
        if let (Some(part), Some(length)) = (&check.part, &check.length) {
            formulas.set_own(part, length)?;
        }
        let what = check.what.as_deref().unwrap_or(check.kind.what());
        let from = check.from.as_ref().map_or(Ok(0.0), |from| formulas.value(from))?;
        let texts = check.kind.texts(&check.of);
        if check.kind == Kind::Ends || check.kind == Kind::Dependent {
            let ended = check.kind == Kind::Dependent || run.end().is_some();
            let Some(off) = formulas.last(&texts)?.filter(|_| ended).map(f64::abs) else { return Ok(Vec::new()) };
            let bar = formulas.bar(check)?;
            return Ok(if check.kind == Kind::Ends {
                vec![check::measured(what, off, bar)]
            } else {
                dependent(run, off, bar)
            });
        }
        let series = formulas.series(&texts)?;
        let values = || series.iter().filter(|(t, _)| *t >= from).map(|(_, value)| *value);
        if check.kind == Kind::Energy {
            formulas.set_other_worst(&texts)?;
        }
        let bar = formulas.bar(check)?;
        let above = check.above.as_ref().map(|above| formulas.value(above)).transpose()?;
        Ok(match check.kind {
            Kind::Constant => vec![check::constant(values(), bar)],
            Kind::Sign => vec![check::sign_kept(values().take_while(|x| above.is_none_or(|least| x.abs() > least)))],
            // A run that was refused has no nodes at all.
            Kind::Nearest if run.failure.is_some() => Vec::new(),
            Kind::Nearest => vec![check::measured(what, values().map(f64::abs).fold(f64::INFINITY, f64::min), bar)],
            _ => vec![check::largest(what, values(), bar)],
        })
    }

    /// The scene of the run, the names of the recorded values, and the record. With `more` settings, it is the other run.
    fn record(&self, more: Option<&[String]>) -> Result<(AnyScene, Vec<String>, Recorded), String> {
        let begin = if self.shared.scene.contains("[system]") { "" } else { SLEIGH };
        let text = [begin, &self.shared.scene, &self.run.scene].concat();
        let set = self.shared.set.iter().chain(&self.run.set).chain(more.unwrap_or_default());
        let set: Vec<Setting> = set.map(|setting| setting.parse()).collect::<Result<_, String>>()?;
        let origin = &self.run.label;
        let text = with_settings(&text, origin, &set).map_err(|error| error.to_string())?;
        let mut scene = AnyScene::parse(&text, origin, &method_names()).map_err(|error| error.to_string())?;
        if let (AnyScene::Sleigh(scene), Some([speed, spin])) = (&mut scene, self.run.beyond) {
            (scene.start.speed, scene.start.turn_rate) = (speed, spin);
        }
        let built = scene.built_for_analysis().map_err(|error| error.to_string())?;
        let system = built.system();
        let mechanism = system.mechanism();
        // The first three values are places, the next ones rates; a sleigh has the rates of its body and of a rotor.
        let last = system.named("rotor_rate").unwrap_or(VALUES - 1);
        let places = [0, 1, 2, 3, 4, last];
        let names = system.quantities();
        let names = places.iter().filter_map(|k| names.get(*k)).map(|quantity| quantity.name.clone()).collect();
        let look = |state: &AnyState| -> [f64; VALUES] {
            // Velocities use the angles that the method sees; places count whole turns.
            let place = state.unwrapped();
            std::array::from_fn(|i| if i < 3 { place[i] } else { system.value(places[i], 0.0, state.q(), state.v()) })
        };
        let mut state = mechanism.state(&built.q, &built.v);
        let mut recorder = Recorder::new(self.run.every.max(self.shared.every), &look);
        let (other, run) = (more.is_some(), scene.run());
        let from = if other { 0 } else { self.run.from.max(self.shared.from) };
        let end = from + (run.duration / run.step).round().max(1.0) as u64;
        let schedule = Schedule { t0: 0.0, step: run.step, steps: end };
        let mut outcome =
            harness::Run::of(&*mechanism, self.method).after(from).observe(&mut recorder).moves(&schedule, &mut state);
        if !other && (self.run.back || self.shared.back) && outcome.is_ok() {
            state = state.reversed();
            // The return continues the same run: a new run would begin by removing a slip from the velocity.
            let back = Schedule { steps: 2 * end, ..schedule };
            outcome =
                harness::Run::of(&*mechanism, self.method).after(end).observe(&mut recorder).moves(&back, &mut state);
        }
        let recorded = recorder.recorded(outcome.err());
        Ok((scene, names, recorded))
    }
}

const NAMELESS: &str = "runs that go on, or fail without naming the constraints";

/// Findings of a run that must end with an error of the second row: the distance from the place where that row vanishes, and whether the
/// error names the row. Empty if the method lacks a basis there.
fn dependent(run: &Recorded, off: f64, bar: f64) -> Vec<Finding> {
    let hint = run.failure.and_then(|failure| failure.hint());
    let source = run.failure.map(|failure| failure.source);
    if hint == Some(Hint::OtherMethod) || matches!(source, Some(StepError::LeavesBasis)) {
        return Vec::new();
    }
    let named = match source {
        Some(StepError::Dependent(found)) => found.dependency == Dependency::RankDrops && found.rows.contains(1),
        _ => hint == Some(Hint::Constraints),
    };
    let nameless = check::measured(NAMELESS, f64::from(u8::from(!named)), 0.0);
    vec![check::measured("distance from where the row vanishes", off, bar), nameless]
}

impl Kind {
    fn what(self) -> &'static str {
        match self {
            Self::Follows => "distance from the closed form",
            Self::Agrees => "distance of two runs that are images of one another",
            Self::Size => "largest size",
            Self::Energy => "energy error",
            Self::Constraint => "constraint residual",
            Self::Ends => "distance at the end",
            Self::Constant | Self::Nearest | Self::Sign | Self::Dependent => "",
        }
    }

    /// The formulas that a check of this kind evaluates.
    fn texts(self, of: &[String]) -> Vec<String> {
        match self {
            Self::Energy => vec!["energy_error".to_owned()],
            Self::Constraint => vec!["constraint".to_owned()],
            _ => of.to_vec(),
        }
    }
}
