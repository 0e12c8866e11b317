use crate::analysis::{Analysis, AnalysisResult};
use crate::args::LyapunovArguments;
use crate::coordinate::Range;
use crate::error::CliError;
use crate::interrupt::Interrupt;
use crate::lyapunov::{again, refused, schedule};
use crate::progress;
use crate::starts::with_energy;
use harness::analysis::{LyapunovError, LyapunovRequest, MotionVerdict, lyapunov};
use report::{Cells, Chart, Layer};
use scene::{Built, Column, StartPlace};
use serde_json::{Value, json};

/// The most starts.
const MOST: usize = 1_000_000;
/// The names of the verdicts, in the order in which they are counted.
const VERDICTS: [&str; 6] = ["chaotic", "regular", "periodic", "steady", "running away", "undecided"];

/// The result of a start.
enum Cell {
    /// The largest exponent, with its interval (1/s), and what the motion is.
    Exponent(f64, Option<f64>, MotionVerdict),
    /// There is no such start.
    None,
    Failed(String),
    Refused(LyapunovError),
}

/// The largest exponent of every start of a grid.
struct Map<'a> {
    /// Across and upwards.
    axes: [&'a Range; 2],
    /// Row by row; `None` of a start that was left out since a signal came.
    cells: Vec<Option<Cell>>,
}

/// Computes the map; `axes` are the horizontal and the vertical one.
pub(crate) fn map(
    arguments: &LyapunovArguments,
    analysis: &Analysis<'_>,
    axes: [&Range; 2],
    system: &Built<'_>,
    start: &StartPlace,
) -> Result<(), CliError> {
    let [across, up] = axes;
    let on = |range: &Range| range.on(system).map_err(|problem| CliError::Request(format!("--map: {problem}")));
    let quantities = [on(across)?, on(up)?];
    let [across_of, up_of] = quantities;
    if across_of == up_of {
        return Err(CliError::Request(format!("--map: both axes are {}; choose two different quantities", up.name)));
    }
    let count = across.cells * up.cells;
    if count > MOST {
        return Err(CliError::Request(format!("--map: {count} starts; accepted are at most {MOST}")));
    }
    let (schedule, settle) = schedule(arguments, analysis);
    let interrupt = Interrupt::listen();
    let cell = |i: usize| {
        let start = system.with(start, across_of, across.value(i % across.cells));
        let start = start.and_then(|start| system.with(&start, up_of, up.value(i / across.cells)));
        let start = match arguments.energy {
            Some(wanted) => start.and_then(|start| with_energy(system, &start, wanted)),
            None => start,
        };
        let Some((q, v)) = start else { return Some(Cell::None) };
        let request = LyapunovRequest { schedule, settle, exponents: Some(1), q, v };
        match lyapunov(&*system.mechanism(), system.own(), &analysis.method, &request, &mut ()) {
            // A motion that a signal may have ended is left out.
            Ok(_) if interrupt.asked() => None,
            Ok(found) => Some(match found.failure {
                Some(failure) => Cell::Failed(failure.to_string()),
                None => Cell::Exponent(found.exponents[0], found.ci[0], found.verdict),
            }),
            Err(error) => Some(Cell::Refused(error)),
        }
    };
    let cells = interrupt.attend(|| progress::in_parallel("starts", count, &interrupt, cell));
    let map = Map { axes, cells: cells.into_iter().map(Option::flatten).collect() };
    map.tell(arguments, analysis, &quantities.map(|k| system.quantities()[k].column()))
}

impl Map<'_> {
    /// One value of every cell that has an exponent.
    fn each<T>(&self, of: impl Fn(f64, Option<f64>, &'static str) -> T) -> Vec<Option<T>> {
        let value = |cell: &Option<Cell>| match cell {
            Some(Cell::Exponent(value, ci, verdict)) => Some(of(*value, *ci, verdict.name())),
            _ => None,
        };
        self.cells.iter().map(value).collect()
    }

    fn exponents(&self) -> Vec<Option<f64>> {
        self.each(|value, _, _| value)
    }

    fn tell(&self, arguments: &LyapunovArguments, analysis: &Analysis<'_>, axes: &[Column; 2]) -> Result<(), CliError> {
        let done = || self.cells.iter().flatten();
        if let Some(error) = done().find_map(|cell| if let Cell::Refused(error) = cell { Some(*error) } else { None }) {
            return Err(refused(error));
        }
        let failures: Vec<&String> =
            done().filter_map(|cell| if let Cell::Failed(why) = cell { Some(why) } else { None }).collect();
        let (count, done, failed) = (self.cells.len(), done().count(), failures.len());
        let (again, notes) = again(arguments, analysis);
        let labels = axes.each_ref().map(crate::provenance::label);
        let mut lines = analysis.lines(analysis.scene.run().duration, ", from each start");
        lines.extend(self.lines(done, failed));
        analysis.tell(AnalysisResult {
            columns: [&axes[..], &["exponent", "ci"].map(|name| Column::new(name, "1/s"))].concat(),
            rows: &|| self.rows(),
            chart: &|| self.chart(analysis.scene.title(), &labels),
            object: &|| analysis.object(analysis.scene.run().duration, self.object(failed)),
            lines,
            again,
            notes,
            warning: None,
            failures: failures
                .first()
                .map(|first| format!("{failed} of {count} starts failed; the first failure: {first}"))
                .into_iter()
                .collect(),
            interrupted: (done < count).then(|| format!("{done} of {count} starts finished")),
        })
    }

    fn rows(&self) -> Vec<Vec<f64>> {
        let [across, up] = &self.axes;
        let numbers = self.each(|value, ci, _| [value, ci.unwrap_or(f64::NAN)]).into_iter().enumerate();
        let row = |(i, numbers): (usize, Option<[f64; 2]>)| {
            let [value, ci] = numbers?;
            Some(vec![across.value(i % across.cells), up.value(i / across.cells), value, ci])
        };
        numbers.filter_map(row).collect()
    }

    fn chart(&self, title: &str, labels: &[String; 2]) -> Chart {
        let [across, up] = &self.axes;
        Chart {
            title: format!("{title}: largest Lyapunov exponent over starts"),
            axes: labels.each_ref().map(|label| format!("{label} at the start")),
            decades: [false; 2],
            layers: vec![Layer::Cells(Cells {
                label: "exponent [1/s]".to_owned(),
                ranges: [across.ends, up.ends],
                columns: across.cells,
                values: self.exponents(),
            })],
        }
    }

    fn object(&self, failed: usize) -> Value {
        let cells = self.axes[0].cells;
        let axis = |of: &Range| json!({"name": of.name, "from": of.ends[0], "to": of.ends[1], "cells": of.cells});
        json!({
            "axes": self.axes.map(axis),
            "exponents": self.exponents().chunks(cells).collect::<Vec<_>>(),
            "ci": self.each(|_, ci, _| ci).chunks(cells).collect::<Vec<_>>(),
            "verdicts": self.each(|_, _, verdict| verdict).chunks(cells).collect::<Vec<_>>(),
            "failed": failed,
        })
    }

    /// The lines for a person on the `done` starts, of which `failed` failed.
    fn lines(&self, done: usize, failed: usize) -> Vec<(String, String)> {
        let known: Vec<f64> = self.exponents().into_iter().flatten().collect();
        let (least, largest) =
            known.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        let verdicts = self.each(|_, _, verdict| verdict);
        let counted = |name: &&str| verdicts.iter().filter(|verdict| **verdict == Some(*name)).count();
        let verdicts: Vec<String> = VERDICTS.iter().map(|name| format!("{} {name}", counted(name))).collect();
        let (count, measured) = (self.cells.len(), known.len());
        let left = if done < count { format!(", {} left out", count - done) } else { String::new() };
        let outside = done - measured - failed;
        let starts =
            format!("{count}: {measured} measured, {failed} failed, {outside} outside the energy surface{left}");
        let largest = if measured == 0 { "none".to_owned() } else { format!("from {least:+.4} to {largest:+.4} 1/s") };
        let lines = [("starts", starts), ("largest exponent", largest), ("verdicts", verdicts.join(", "))];
        lines.map(|(name, value)| (name.to_owned(), value)).to_vec()
    }
}
