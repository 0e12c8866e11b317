//! The meaning of the formulas of a hard case: numbers of the run and the method, and of each node.

use super::case::Check;
use expression::{Expression, Graph, Names, Tape, parse};
use harness::Method;
use harness::stability::check::{rounding, truncation};
use harness::stability::{Claim, Recorded, Seen, claims};
use lagrangian::linear::larger;
use scene::{AnyScene, Scene};
use sleigh::Exact;

/// Formulas and the values of their names: of a node, of the node of the other run, and of the closed form.
pub(super) struct Formulas<'a> {
    names: Names,
    graph: Graph,
    meanings: Vec<Expression>,
    values: Vec<f64>,
    /// Count of the numbers of a node.
    width: usize,
    run: &'a Recorded,
    other: Option<&'a Recorded>,
    exact: Option<Exact>,
    asks_exact: bool,
    method: &'a Method,
}

/// The numbers of the closed form.
const EXACT: [&str; 5] = ["exact_x", "exact_y", "exact_heading", "exact_speed", "exact_turn_rate"];

impl<'a> Formulas<'a> {
    /// The formulas of a run of a scene, and of another run if there is one; `seen` names the values of a node.
    pub(super) fn new(
        method: &'a Method,
        scene: &AnyScene,
        seen: &[String],
        (run, other): (&'a Recorded, Option<&'a Recorded>),
    ) -> Result<Self, String> {
        let node = || ["t"].into_iter().chain(seen.iter().map(String::as_str)).chain(["energy_error", "constraint"]);
        let exact =
            if let AnyScene::Sleigh(scene) = scene { scene.exact().map_err(|error| error.to_string())? } else { None };
        let mut formulas = Self {
            names: Names::new(),
            graph: Graph::new(),
            meanings: Vec::new(),
            values: Vec::new(),
            width: seen.len() + 3,
            run,
            other,
            exact,
            asks_exact: false,
            method,
        };
        for name in node().map(str::to_owned).chain(node().map(|name| format!("other_{name}"))) {
            formulas.set(&name, f64::NAN);
        }
        for name in EXACT.into_iter().chain(["own", "other_worst", "largest"]) {
            formulas.set(name, f64::NAN);
        }
        formulas.set_constants(scene);
        for (name, value) in seen.iter().zip(run.nodes.first().map_or([f64::NAN; 6], |node| node.values)) {
            formulas.set(&format!("{}_0", name.replace('\'', "_dot")), value);
        }
        Ok(formulas)
    }

    fn set_constants(&mut self, scene: &AnyScene) {
        let (info, settings) = (self.method.info(), scene.run());
        let flag = |holds: bool| f64::from(u8::from(holds));
        let claimed = |claim| flag(claims(info.kind, claim).is_ok());
        let adaptive = flag(self.method.is_adaptive());
        let steps = (settings.duration / settings.step).round().max(1.0);
        for (name, value) in [
            ("eps", f64::EPSILON),
            ("order", f64::from(info.order)),
            ("adaptive", adaptive),
            ("tolerance", adaptive * Method::TOLERANCE),
            ("keeps_energy", claimed(Claim::Energy)),
            ("keeps_constraint", claimed(Claim::Constraint)),
            ("symmetric", claimed(Claim::Symmetry)),
            ("step", settings.step),
            ("steps", steps),
            ("duration", steps * settings.step),
            ("rounding", rounding(steps as usize, 1.0)),
        ] {
            self.set(name, value);
        }
        if let AnyScene::Sleigh(scene) = scene {
            let Scene { sleigh, start, .. } = &**scene;
            let gyration = (sleigh.pivot_inertia() / sleigh.mass()).sqrt();
            // The speed and the spin that have all the energy, and the rate (1/s) at which a spin grows or decays on a straight line.
            let all = start.speed.hypot(gyration * start.turn_rate);
            for (name, value) in [
                ("m", sleigh.mass()),
                ("J", sleigh.pivot_inertia()),
                ("a", sleigh.offset()),
                ("U", all),
                ("W", all / gyration),
                ("kappa", (all * sleigh.spin_gain()).abs()),
            ] {
                self.set(name, value);
            }
        }
    }

    /// Sets the value of a name, and adds the name if it is new.
    pub(super) fn set(&mut self, name: &str, value: f64) {
        if let Some(k) = self.names.position(name) {
            self.values[k] = value;
        } else if self.names.add(name).is_ok() {
            let variable = self.graph.variable(self.values.len() as u32);
            self.meanings.push(variable);
            self.values.push(value);
        }
    }

    /// A name stands for a formula: `NAME = FORMULA`.
    pub(super) fn abbreviate(&mut self, line: &str) -> Result<(), String> {
        let (name, text) = line.split_once('=').ok_or_else(|| format!("`{line}` is no abbreviation"))?;
        let meaning = self.built(text)?;
        self.names.add(name.trim()).map_err(|error| error.to_string())?;
        self.meanings.push(meaning);
        self.values.push(f64::NAN);
        Ok(())
    }

    fn built(&mut self, text: &str) -> Result<Expression, String> {
        let syntax = parse(text.trim(), &self.names);
        let built = syntax.and_then(|syntax| self.graph.build(&syntax, &self.meanings));
        built.map_err(|error| format!("`{text}`: {error}"))
    }

    /// The operations of some formulas; the closed form is evaluated only for those that ask for it.
    fn tape(&mut self, texts: &[String]) -> Result<Tape, String> {
        self.asks_exact = texts.iter().any(|text| text.contains("exact_"));
        let built = texts.iter().map(|text| self.built(text)).collect::<Result<Vec<_>, _>>()?;
        Tape::new(&self.graph, &built).map_err(|error| error.to_string())
    }

    /// The value of a formula of one number, or the largest size of several.
    fn evaluated(&self, tape: &Tape) -> Result<f64, String> {
        let (mut scratch, mut found) = (vec![0.0; tape.scratch()], vec![0.0; tape.outputs()]);
        tape.evaluate(&self.values, &mut scratch, &mut found).map_err(|error| error.to_string())?;
        Ok(if let [one] = found[..] { one } else { found.into_iter().fold(0.0, larger) })
    }

    /// The value of a formula without values of a node.
    pub(super) fn value(&mut self, text: &str) -> Result<f64, String> {
        let tape = self.tape(&[text.to_owned()])?;
        self.evaluated(&tape)
    }

    /// The bar of a check; zero if it has none.
    pub(super) fn bar(&mut self, check: &Check) -> Result<f64, String> {
        check.bar.as_ref().map_or(Ok(0.0), |bar| self.value(bar))
    }

    /// Sets `own`: the error of the method with steps of `part` of a time constant, over `length` time constants.
    pub(super) fn set_own(&mut self, part: &str, length: &str) -> Result<(), String> {
        let (part, length, steps) = (self.value(part)?, self.value(length)?, self.value("steps")?);
        // An adaptive method has no error of its step, but meets its tolerance in each.
        let adaptive = self.method.is_adaptive();
        let own = if adaptive { Method::TOLERANCE * steps } else { truncation(self.method.info().order, part, length) };
        self.set("own", own);
        Ok(())
    }

    /// Sets `other_worst`: the largest size of the formulas in the other run.
    pub(super) fn set_other_worst(&mut self, texts: &[String]) -> Result<(), String> {
        if let Some(other) = self.other {
            let series = self.series_of(texts, other, None)?;
            self.set("other_worst", series.iter().fold(0.0, |worst, (_, value)| larger(worst, *value)));
        }
        Ok(())
    }

    /// Time and value at every node.
    pub(super) fn series(&mut self, texts: &[String]) -> Result<Vec<(f64, f64)>, String> {
        self.series_of(texts, self.run, self.other.filter(|_| texts.iter().any(|text| text.contains("other_"))))
    }

    fn series_of(
        &mut self,
        texts: &[String],
        run: &Recorded,
        other: Option<&Recorded>,
    ) -> Result<Vec<(f64, f64)>, String> {
        let tape = self.tape(texts)?;
        if other.is_some_and(|other| other.nodes.is_empty()) {
            return Ok(vec![(0.0, f64::NAN)]);
        }
        let count = other.map_or(usize::MAX, |other| other.nodes.len());
        let nodes = run.nodes.iter().enumerate().take(count);
        nodes.map(|(k, node)| Ok((node.t, self.at(&tape, node, other.map(|other| &other.nodes[k]))?))).collect()
    }

    /// The value at the last node; `None` if the other run did not come to its end.
    pub(super) fn last(&mut self, texts: &[String]) -> Result<Option<f64>, String> {
        let tape = self.tape(texts)?;
        let beside = match self.other.map(Recorded::end) {
            Some(None) => return Ok(None),
            other => other.flatten(),
        };
        self.run.nodes.last().map(|node| self.at(&tape, node, beside)).transpose()
    }

    fn at(&mut self, tape: &Tape, node: &Seen, beside: Option<&Seen>) -> Result<f64, String> {
        let width = self.width;
        for (seen, place) in [Some(node), beside].into_iter().zip([0, width]) {
            let Some(seen) = seen else { continue };
            let numbers = [seen.t].into_iter().chain(seen.values.into_iter().take(width - 3));
            let numbers = numbers.chain([seen.energy_error, seen.constraint]);
            self.values[place..place + width].iter_mut().zip(numbers).for_each(|(value, number)| *value = number);
        }
        if let Some(exact) = self.exact.as_ref().filter(|_| self.asks_exact) {
            let now = exact.at(node.t);
            let place = 2 * width;
            self.values[place..place + EXACT.len()].copy_from_slice(&[
                now.x,
                now.y,
                now.heading,
                now.speed,
                now.turn_rate,
            ]);
        }
        self.evaluated(tape)
    }
}
