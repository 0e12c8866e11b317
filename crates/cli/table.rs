use comfy_table::{CellAlignment, Table, presets};
use harness::Record;
use lagrangian::Shown;
use scene::AnyScene;
use sleigh::SleighState;
use std::fmt::Write;
use std::path::Path;

/// The cell of a run with the error at its end.
type Cell = fn(&Record, Option<f64>) -> String;

/// The columns of a comparison: headings and cells.
const CELLS: [(&str, Cell); 14] = [
    ("method", |record, _| record.method.name.to_owned()),
    ("order", |record, _| record.method.order.to_string()),
    ("step [s]", |record, _| number(record.step)),
    ("steps", |record, _| record.steps.to_string()),
    ("constraint [m/s]", |record, _| format!("{:.1e}", record.constraint_max)),
    ("over steps [m/s]", |record, _| short(Some(record.step_constraint_max).filter(|most| !most.is_nan()))),
    ("energy error [J]", |record, _| format!("{:.1e}", record.energy.max_error)),
    ("amplitude [J]", |record, _| format!("{:.1e}", record.energy.drift.amplitude)),
    ("energy drift [W]", |record, _| {
        let interval = record.energy.drift.slope_ci.map_or_else(String::new, |interval| format!(" ± {interval:.0e}"));
        format!("{:+.1e}{interval}", record.energy.drift.slope)
    }),
    ("verdict", |record, _| record.verdict().map_or_else(|| "-".to_owned(), |verdict| verdict.to_string())),
    ("end error", |_, error| short(error)),
    ("Newton", |Record { newton, .. }, _| if newton.max == 0 { "-".to_owned() } else { format!("{:.2}", newton.mean) }),
    ("ns/step", |record, _| format!("{:.1}", record.wall_seconds * 1e9 / record.steps.max(1) as f64)),
    ("cost [s/s]", |record, _| short(record.seconds_per_simulated_second())),
];

/// The headings of a comparison.
pub(crate) fn headings() -> [&'static str; CELLS.len()] {
    CELLS.map(|(heading, _)| heading)
}

/// A number in two digits; `-` if there is none.
fn short(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.1e}"))
}

/// The meaning of the columns.
pub(crate) const INTRO: &str = "Every method from the same start with the same step. Constraint: the largest \
    |A(q) v + b| at a node, for a blade its sideways slip. Over steps: the largest residual of the discrete constraint between two \
    nodes, which is round-off for the methods that solve that constraint, such as dla. Energy error: the largest |E - E0 - work| at a \
    node; the work is that of what drives or brakes the scene. Amplitude: how much the energy error oscillates: half its range after a \
    straight line is subtracted, over 1/32 of the run. Energy drift: the slope of that line, with its 95 % confidence interval. Verdict: \
    whether the energy error is bounded, grows, or has diverged, by a test. End error: distance at the end from the closed form, or from gauss16 at a \
    quarter of the step where there is none, in metres or radians, whichever is larger. Newton: iterations a step. ns/step: time of the \
    steps alone, median of repeated runs. Cost: that time for each second of the motion. A method \
    that failed has no numbers: its row says at which step, when and why.";

/// The row of one method, for any number of coordinates.
pub(crate) struct ComparisonRow {
    pub(crate) cells: Vec<String>,
    pub(crate) json: serde_json::Value,
    /// The methods that it overtakes in a longer run; `None` if there are none.
    pub(crate) better: Option<String>,
    pub(crate) failure: Option<String>,
    /// The method refuses the scene.
    pub(crate) refused: bool,
}

impl ComparisonRow {
    /// The failure; `None` if the method only refuses the scene.
    pub(crate) fn unexpected(self) -> Option<String> {
        self.failure.filter(|_| !self.refused)
    }
}

/// A number on the screen: six digits. Files have all digits.
pub(crate) fn number(value: f64) -> String {
    Shown(value).to_string()
}

/// A row of a comparison. If the method refuses the scene or failed, the row is short, and its last cell says why and at which step.
pub(crate) fn cells(record: &Record, error: Option<f64>) -> Vec<String> {
    if let Some(reason) = record.refusal() {
        return vec![record.method.name.to_owned(), record.method.order.to_string(), format!("refused: {reason}")];
    }
    if let Some(failure) = &record.failure {
        return vec![record.method.name.to_owned(), record.method.order.to_string(), format!("failed at {failure}")];
    }
    CELLS.iter().map(|(_, cell)| cell(record, error)).collect()
}

/// The methods that a method overtakes in a longer run; `None` if there are none.
pub(crate) fn better(record: &Record, better: &[(&str, f64)]) -> Option<String> {
    let overtaken: Vec<String> = better.iter().map(|(name, from)| format!("{name} from {from:.1e} s")).collect();
    let name = record.method.name;
    (!overtaken.is_empty()).then(|| format!("{name} has a smaller energy error than {}", overtaken.join(", ")))
}

/// The table of a comparison, split into several tables if it is wider than `room` (characters).
pub(crate) fn comparison(
    scene: &AnyScene,
    rows: &[ComparisonRow],
    interrupted: Option<&str>,
    room: Option<usize>,
) -> String {
    // A refusal or a failure needs more room than a column has: its text follows the row.
    let short = |row: &ComparisonRow| row.cells.len() < CELLS.len();
    let remark = |row: &ComparisonRow| row.cells.last().filter(|_| short(row)).cloned();
    let own = |row: &ComparisonRow| row.cells[..row.cells.len() - usize::from(short(row))].to_vec();
    let cells: Vec<_> = rows.iter().map(own).collect();
    let mut text = format!("{} ({}), {} s\n", scene.title(), scene.name(), number(scene.run().duration));
    let headings = headings();
    let parts = parts(&headings, &cells, room);
    for (k, columns) in parts.iter().enumerate() {
        // A short row has no numbers for the tables after the first.
        let rows: Vec<_> = rows.iter().zip(&cells).filter(|(row, _)| k == 0 || !short(row)).collect();
        let remarks = std::iter::once(None).chain(rows.iter().map(|(row, _)| remark(row)));
        let pick = |cells: &Vec<String>| columns.iter().filter_map(|column| cells.get(*column).cloned()).collect();
        let (cells, header): (Vec<Vec<String>>, Vec<&str>) = (
            rows.iter().map(|(_, cells)| pick(cells)).collect(),
            columns.iter().map(|column| headings[*column]).collect(),
        );
        text += if k == 0 { "" } else { "\n" };
        for (line, remark) in right_aligned(&header, &cells).lines().zip(remarks) {
            let _ = match remark {
                Some(remark) => writeln!(text, "{line}  {remark}"),
                None => writeln!(text, "{line}"),
            };
        }
    }
    for better in rows.iter().filter_map(|row| row.better.as_ref()) {
        let _ = writeln!(text, " {better}");
    }
    if let Some(made) = interrupted {
        let _ = writeln!(text, " interrupted: {made}");
    }
    text
}

/// The columns of each of the tables that are no wider than the room, the first column in all of them.
fn parts(header: &[&str], rows: &[Vec<String>], room: Option<usize>) -> Vec<Vec<usize>> {
    // A space on each side, one of which is trimmed at the end of a line.
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|cells| cells.get(column)).map(String::as_str);
        cells.chain([header[column]]).map(|text| text.chars().count()).max().unwrap_or(0) + 2
    };
    let mut parts = vec![vec![0]];
    let mut used = width(0);
    for column in 1..header.len() {
        if room.is_some_and(|room| used + width(column) > room + 1) {
            parts.push(vec![0]);
            used = width(0);
        }
        used += width(column);
        if let Some(part) = parts.last_mut() {
            part.push(column);
        }
    }
    // In a room narrower than any column, every column has a table of its own, and the first none.
    parts.retain(|part| part.len() > 1);
    parts
}

/// A table, all columns but the first aligned to the right.
pub(crate) fn right_aligned(header: &[&str], rows: &[Vec<String>]) -> String {
    tabulated(header, rows, CellAlignment::Right)
}

/// A table of words.
pub(crate) fn left_aligned(header: &[&str], rows: &[Vec<String>]) -> String {
    tabulated(header, rows, CellAlignment::Left)
}

fn tabulated(header: &[&str], rows: &[Vec<String>], alignment: CellAlignment) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_header(header);
    table.add_rows(rows);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(alignment);
    }
    let mut text = String::new();
    for line in table.trim_fmt().lines() {
        let _ = writeln!(text, "{line}");
    }
    text
}

/// The end of the run of a sleigh, for a person.
pub(crate) fn end_of_sleigh(end: &SleighState) -> Vec<(String, String)> {
    let lines = [
        ("position", format!("x = {} m, y = {} m", number(end.x), number(end.y))),
        ("heading", format!("{} rad", number(end.heading))),
        ("velocity", format!("{} m/s along the blade, {} rad/s", number(end.speed), number(end.turn_rate))),
    ];
    lines.map(|(name, value)| (name.to_owned(), value)).to_vec()
}

/// The lines of one run of a scene; `end` has the lines on the state at its end.
pub(crate) fn one_run(
    scene: &AnyScene,
    record: &Record,
    end: Vec<(String, String)>,
    out: Option<&Path>,
) -> Vec<(String, String)> {
    /// A shorter time (s) to derive the equations is not shown.
    const NOTICED: f64 = 0.1;
    let (energy, newton, seconds) = (&record.energy, &record.newton, record.wall_seconds);
    let per_step = seconds * 1e9 / record.steps.max(1) as f64;
    let head = [
        ("scene", format!("{} ({})", scene.title(), scene.name())),
        ("method", format!("{}, order {}", record.method.name, record.method.order)),
        ("steps", format!("{} of {} s, to t = {} s", record.steps, number(record.step), number(record.t))),
    ];
    let mut rest = vec![
        ("energy", format!("{} J at the start, {} J at the end", number(energy.initial), number(energy.last))),
        ("energy error", format!("{:.2e} J at most", energy.max_error)),
        ("constraint", format!("{:.2e} m/s at most", record.constraint_max)),
    ];
    if newton.max > 0 {
        rest.push(("Newton", format!("{:.2} iterations a step, {} at most", newton.mean, newton.max)));
    }
    rest.push(("time", format!("{seconds:.3e} s, {per_step:.1} ns a step")));
    rest.extend(out.map(|path| ("written", path.display().to_string())));
    if record.derivation_seconds >= NOTICED {
        let seconds = record.derivation_seconds;
        rest.push(("derivation", format!("{seconds:.2} s besides, of the equations of motion in a basis")));
    }
    let named = |(name, value): (&str, String)| (name.to_owned(), value);
    head.into_iter().map(named).chain(end).chain(rest.into_iter().map(named)).collect()
}

/// A number of things: `1 step`, `2 steps`.
pub(crate) fn counted(count: u64, thing: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {thing}{plural}")
}

/// Names and values in two columns.
pub(crate) fn aligned<K: AsRef<str>, V: AsRef<str>>(lines: &[(K, V)]) -> String {
    let width = lines.iter().map(|(name, _)| name.as_ref().chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for (name, value) in lines {
        let _ = writeln!(text, "{:<width$}  {}", name.as_ref(), value.as_ref());
    }
    text
}

/// The error of a run that ended with a place, a velocity or an energy that is not a finite number; `None` if all are finite.
pub(crate) fn not_finite(record: &Record) -> Option<String> {
    let energies = [record.energy.last, record.energy.work, record.energy.max_error];
    let finite = record.q.iter().chain(&record.v).chain(&energies).all(|number| number.is_finite());
    (!finite && record.failure.is_none()).then(|| {
        format!("{}: the energy of the run is not a finite number: the velocities are too large", record.method.name)
    })
}

/// The failure of a run, told with how far the run is valid.
pub(crate) fn failure(record: &Record) -> Option<String> {
    if let Some(reason) = record.refusal() {
        return Some(format!("{} refused: {reason}", record.method.name));
    }
    record.failure.as_ref().map(|failure| {
        let mut told = format!(
            "{} failed at {failure}; the trajectory is valid up to t = {} s ({})",
            record.method.name,
            Shown(record.t),
            counted(record.steps, "step")
        );
        // Writing to a string cannot fail.
        if let Some(history) = failure.source.history().filter(|history| history.made() > 0) {
            let _ = write!(told, "; the corrections of the iteration were {history}");
        }
        if let Some(hint) = failure.hint() {
            let _ = write!(told, "; {hint}");
        }
        told
    })
}
