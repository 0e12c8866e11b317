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
    ("ns/step", |record, _| nanoseconds(record.wall_seconds * 1e9 / record.steps.max(1) as f64)),
    ("cost [s/s]", |record, _| short(record.seconds_per_simulated_second())),
];

/// The headings of a comparison.
pub(crate) fn headings() -> [&'static str; CELLS.len()] {
    CELLS.map(|(heading, _)| heading)
}

/// A time (ns) without digits that are noise.
fn nanoseconds(time: f64) -> String {
    if time < 1000.0 { format!("{time:.1}") } else { format!("{time:.0}") }
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

/// The columns that fit a screen of 80 characters, and what they are called there.
const NARROW: [(&str, &str); 6] = [
    ("method", "method"),
    ("constraint [m/s]", "constraint"),
    ("energy error [J]", "energy error"),
    ("verdict", "verdict"),
    ("end error", "end error"),
    ("ns/step", "ns/step"),
];

/// The table of a comparison, with all columns if it may be `wide`. Methods that refuse or fail follow it, by their reasons.
pub(crate) fn comparison(scene: &AnyScene, rows: &[ComparisonRow], interrupted: Option<&str>, wide: bool) -> String {
    let name = |heading: &'static str| match NARROW.iter().find(|(own, _)| *own == heading) {
        _ if wide => Some(heading),
        narrow => narrow.map(|(_, name)| *name),
    };
    let shown: Vec<(usize, &str)> =
        CELLS.iter().enumerate().filter_map(|(column, (heading, _))| Some((column, name(heading)?))).collect();
    let (made, left): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row.cells.len() == CELLS.len());
    let headings: Vec<&str> = shown.iter().map(|(_, name)| *name).collect();
    let cells: Vec<Vec<String>> =
        made.iter().map(|row| shown.iter().map(|(column, _)| row.cells[*column].clone()).collect()).collect();
    let mut text = format!("{} ({}), {} s\n", scene.title(), scene.name(), number(scene.run().duration));
    text += &right_aligned(&headings, &cells);
    let left: Vec<(String, String)> =
        left.into_iter().map(|row| (row.cells[0].clone(), row.cells.last().cloned().unwrap_or_default())).collect();
    text += &by_reason(&left);
    let better = rows.iter().filter_map(|row| row.better.clone());
    let interrupted = interrupted.map(|made| format!("interrupted: {made}"));
    better.chain(interrupted).for_each(|line| text += &indented(&line));
    text
}

/// A sentence for each reason, with the methods that have the reason.
pub(crate) fn by_reason(methods: &[(String, String)]) -> String {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for (name, reason) in methods {
        match reasons.iter_mut().find(|(other, _)| other == reason) {
            Some((_, names)) => names.push(name),
            None => reasons.push((reason, vec![name])),
        }
    }
    reasons.into_iter().map(|(reason, names)| indented(&format!("{}: {reason}", names.join(", ")))).collect()
}

/// A text in lines, those after the first indented.
pub(crate) fn indented(text: &str) -> String {
    format!("{}\n", wrapped_to(text, WIDTH - 4).join("\n    "))
}

/// No line of words is longer (characters).
pub(crate) const WIDTH: usize = 80;

/// A sentence on lines of its own.
pub(crate) fn wrapped(sentence: &str) -> String {
    wrapped_to(sentence, WIDTH).iter().map(|line| format!("{line}\n")).collect()
}

/// A text in lines of at most `width` characters.
pub(crate) fn wrapped_to(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last().map_or(0, |line| line.chars().count());
        match lines.last_mut() {
            Some(last) if line == 0 => last.push_str(word),
            Some(last) if line + 1 + word.chars().count() <= width => *last += &format!(" {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
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
    rest.push(("time", format!("{seconds:.3e} s, {per_step:.1} ns a step with what is measured at each node")));
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

/// Names and values in two columns: one line each for another program, and as wide as a screen on one.
pub(crate) fn listed<K: AsRef<str>, V: AsRef<str>>(lines: &[(K, V)]) -> String {
    let most = if console::Term::stdout().is_term() { WIDTH } else { usize::MAX };
    aligned_to(lines, most)
}

/// Names and values in two columns; a long value continues on the next line.
pub(crate) fn aligned<K: AsRef<str>, V: AsRef<str>>(lines: &[(K, V)]) -> String {
    aligned_to(lines, WIDTH)
}

fn aligned_to<K: AsRef<str>, V: AsRef<str>>(lines: &[(K, V)], most: usize) -> String {
    let width = lines.iter().map(|(name, _)| name.as_ref().chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    // A value has some room whatever the names are.
    let room = most.saturating_sub(width + 2).max(WIDTH / 3);
    for (name, value) in lines {
        let (name, value) = (name.as_ref(), value.as_ref());
        if value.chars().count() <= room {
            let _ = writeln!(text, "{name:<width$}  {value}");
            continue;
        }
        for (k, line) in wrapped_to(value, room).into_iter().enumerate() {
            let _ = writeln!(text, "{:<width$}  {line}", if k == 0 { name } else { "" });
        }
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
