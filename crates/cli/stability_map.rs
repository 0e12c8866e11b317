use crate::args::LyapunovArguments;
use crate::chart_file::ChartFile;
use crate::compare::unless_interrupted;
use crate::coordinate::Range;
use crate::error::CliError;
use crate::exponents::{provenance, refused, schedule};
use crate::interrupt::Interrupt;
use crate::provenance::label;
use crate::starts::with_energy;
use crate::{progress, table, terminal};
use harness::Method;
use harness::analysis::{LyapunovError, LyapunovRequest, MotionVerdict, in_parallel, lyapunov};
use report::{Cells, Chart, Layer};
use scene::{AnyScene, Built, Column};
use serde_json::{Value, json};

/// The most starts.
const MOST: usize = 1_000_000;

/// The largest exponent of every start of a grid.
pub(crate) struct Map<'a> {
    pub(crate) arguments: &'a LyapunovArguments,
    pub(crate) scene: &'a AnyScene,
    pub(crate) method: Method,
    /// Across and upwards.
    pub(crate) axes: [&'a Range; 2],
    pub(crate) file: Option<ChartFile<'a>>,
}

/// The result of a start.
enum Cell {
    /// The largest exponent, with its interval (1/s), and what the motion is.
    Exponent(f64, Option<f64>, MotionVerdict),
    /// There is no such start.
    None,
    Failed(String),
    Refused(LyapunovError),
    /// A signal came before.
    Left,
}

/// The names of the verdicts, in the order in which they are counted.
const VERDICTS: [&str; 6] = ["chaotic", "regular", "periodic", "steady", "running away", "undecided"];

impl Cell {
    /// The name of what the motion is.
    fn verdict(&self) -> Option<&'static str> {
        if let Self::Exponent(.., verdict) = self { Some(verdict.name()) } else { None }
    }
}

/// How many starts were left out since a signal came.
fn count_left(cells: &[Cell]) -> usize {
    cells.iter().filter(|cell| matches!(cell, Cell::Left)).count()
}

impl Map<'_> {
    pub(crate) fn on(self, system: &Built<'_>, (q, v): (&[f64], &[f64])) -> Result<(), CliError> {
        let [across, up] = self.axes;
        let on = |range: &Range| range.on(system).map_err(|problem| CliError::Request(format!("--map: {problem}")));
        let quantities = [on(across)?, on(up)?];
        let [across_of, up_of] = quantities;
        if across_of == up_of {
            return Err(CliError::Request(format!(
                "--map: both axes are {}; choose two different quantities",
                up.name
            )));
        }
        let count = across.cells * up.cells;
        if count > MOST {
            return Err(CliError::Request(format!("--map: {count} starts; accepted are at most {MOST}")));
        }
        let (schedule, settle) = schedule(self.arguments, self.scene);
        let interrupt = Interrupt::listen();
        let bar = progress::bar("starts", count as u64);
        let start = (q.to_vec(), v.to_vec());
        let cell = |i: usize| {
            if interrupt.asked() {
                return Cell::Left;
            }
            let start = system.with(&start, across_of, across.value(i % across.cells));
            let start = start.and_then(|start| system.with(&start, up_of, up.value(i / across.cells)));
            let start = match self.arguments.energy {
                Some(wanted) => start.and_then(|start| with_energy(system, &start, wanted)),
                None => start,
            };
            let cell = match start {
                Some((q, v)) => {
                    let request = LyapunovRequest { schedule, settle, exponents: Some(1), q, v };
                    match lyapunov(&*system.mechanism(), system.own(), &self.method, &request, &mut ()) {
                        // One that a signal may have ended is left out.
                        Ok(_) if interrupt.asked() => return Cell::Left,
                        Ok(found) => match found.failure {
                            Some(failure) => Cell::Failed(failure.to_string()),
                            None => Cell::Exponent(found.exponents[0], found.ci[0], found.verdict),
                        },
                        Err(error) => Cell::Refused(error),
                    }
                }
                None => Cell::None,
            };
            bar.inc(1);
            cell
        };
        let cells = interrupt.attend(|| in_parallel(count, cell));
        bar.finish_and_clear();
        let columns = quantities.map(|k| system.quantities()[k].column());
        self.tell(&columns, &cells)
    }
}

impl Map<'_> {
    fn tell(&self, axes: &[Column; 2], cells: &[Cell]) -> Result<(), CliError> {
        if let Some(error) =
            cells.iter().find_map(|cell| if let Cell::Refused(error) = cell { Some(*error) } else { None })
        {
            return Err(refused(error));
        }
        let [across, up] = &self.axes;
        let value = |cell: &Cell| if let Cell::Exponent(value, ..) = cell { Some(*value) } else { None };
        let values: Vec<Option<f64>> = cells.iter().map(value).collect();
        let known: Vec<f64> = values.iter().copied().flatten().collect();
        let failures: Vec<&String> =
            cells.iter().filter_map(|cell| if let Cell::Failed(why) = cell { Some(why) } else { None }).collect();
        let shared = &self.arguments.scene;
        let left = count_left(cells);
        let made = (left > 0).then(|| format!("{} of {} starts finished", cells.len() - left, cells.len()));
        let written = self.file.map_or(Ok(()), |file| {
            let row = |(i, cell): (usize, &Cell)| match cell {
                Cell::Exponent(value, ci, _) => {
                    let [a, b] = [across.value(i % across.cells), up.value(i / across.cells)];
                    Some(vec![a, b, *value, ci.unwrap_or(f64::NAN)])
                }
                _ => None,
            };
            let rows: Vec<Vec<f64>> = cells.iter().enumerate().filter_map(row).collect();
            let columns = [&axes[..], &["exponent", "ci"].map(|name| Column::new(name, "1/s"))].concat();
            let provenance = provenance(self.arguments, self.scene, made.as_deref());
            let chart = || self.chart(&axes.each_ref().map(label), values.clone());
            file.write(shared.force, &provenance, (&columns, &rows), chart)
        });
        if shared.json {
            terminal::print_json(&self.json(cells, &values, failures.len()))?;
        } else {
            terminal::print(&self.text(&known, cells, failures.len()))?;
            if let (Some(path), Ok(())) = (&self.arguments.out, &written) {
                terminal::print(&format!("written    {}\n", path.display()))?;
            }
        }
        let failed = failures
            .first()
            .map(|first| format!("{} of {} starts failed; the first failure: {first}", failures.len(), cells.len()));
        unless_interrupted(made, None, CliError::of_failures(failed).and(written))
    }

    fn chart(&self, labels: &[String; 2], values: Vec<Option<f64>>) -> Chart {
        let [across, up] = &self.axes;
        Chart {
            title: format!("{}: largest Lyapunov exponent over starts", self.scene.title()),
            axes: labels.each_ref().map(|label| format!("{label} at the start")),
            decades: [false; 2],
            layers: vec![Layer::Cells(Cells {
                label: "exponent [1/s]".to_owned(),
                ranges: [across.ends, up.ends],
                columns: across.cells,
                values,
            })],
        }
    }

    fn json(&self, cells: &[Cell], values: &[Option<f64>], failed: usize) -> Value {
        let [across, _] = &self.axes;
        let axis = |range: &Range| json!({"name": range.name, "from": range.ends[0], "to": range.ends[1], "cells": range.cells});
        let ci: Vec<Option<f64>> =
            cells.iter().map(|cell| if let Cell::Exponent(_, ci, _) = cell { *ci } else { None }).collect();
        let verdicts: Vec<Option<&str>> = cells.iter().map(Cell::verdict).collect();
        json!({
            "scene": self.scene.name(),
            "method": self.method.info().name,
            "step": self.scene.run().actual_step(),
            "duration": self.scene.run().duration,
            "axes": self.axes.iter().map(|range| axis(range)).collect::<Vec<_>>(),
            "exponents": values.chunks(across.cells).collect::<Vec<_>>(),
            "ci": ci.chunks(across.cells).collect::<Vec<_>>(),
            "verdicts": verdicts.chunks(across.cells).collect::<Vec<_>>(),
            "failed": failed,
        })
    }

    fn text(&self, known: &[f64], cells: &[Cell], failed: usize) -> String {
        let (run, count, left) = (self.scene.run(), cells.len(), count_left(cells));
        let (least, largest) =
            known.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        let counted = |name: &&str| cells.iter().filter(|cell| cell.verdict() == Some(name)).count();
        let verdicts: Vec<String> = VERDICTS.iter().map(|name| format!("{} {name}", counted(name))).collect();
        let lines = [
            ("scene", format!("{} ({})", self.scene.title(), self.scene.name())),
            (
                "run",
                format!(
                    "{} s by {} with steps of {} s, from each start",
                    table::number(run.duration),
                    run.method,
                    table::number(run.actual_step())
                ),
            ),
            (
                "starts",
                format!(
                    "{count}: {} measured, {failed} failed, {} outside the energy surface{}",
                    known.len(),
                    count - known.len() - failed - left,
                    if left > 0 { format!(", {left} left out") } else { String::new() }
                ),
            ),
            (
                "largest exponent",
                if known.is_empty() { "none".to_owned() } else { format!("from {least:+.4} to {largest:+.4} 1/s") },
            ),
            ("verdicts", verdicts.join(", ")),
        ];
        table::aligned(&lines.map(|(name, value)| (name.to_owned(), value)))
    }
}
