//! The words of the first screen on its numbers.

use crate::row_verdict::{Energy, slips};
use crate::table::{WIDTH, aligned, number, wrapped_to};
use harness::precision::Cheapest;
use scene::AnyScene;
use serde_json::Value;

/// The columns, each a question.
pub(crate) const COLUMNS: [&str; 5] = ["method", "does it slip?", "does its energy drift?", "error at the end", "time"];

/// The meaning of the columns.
const MEANINGS: [&str; 5] = [
    "The integrator, by the name that commands and files use; `noslip list methods` says what each is. All methods \
        start from the same state and make the same steps.",
    "The largest sideways speed |A(q) v + b| of the blade over all nodes, which the constraint says is zero. \"no\": \
        the speed is below round-off, the number of steps times 2.2e-16.",
    "What |E - E0 - work| does over the run; the work of what drives or brakes the scene is no error. \"drifts\": the slope of its \
     straight line differs from zero at the 99 % level. \"swings\": to and fro, without a drift. \"wanders\": like a random walk. \
     \"rounding\": the energy error is below the round-off of all \
         steps. \"not clear\": the run is too short; a run of the named length would show a drift of the measured \
             slope.",
    "How far the blade (m) or its heading (rad) is from the reference at the end, whichever is larger. The reference \
        is the closed form of the motion, or gauss16 with a quarter of the step where no closed form is known.",
    "Processor time of the steps alone, the median of repeated runs.",
];

/// Where to go on.
pub(crate) const FURTHER: &str = "\
what the columns mean            noslip --explain
every method on every scene      noslip --all
one run, and its picture         noslip plot turnaround
a scene of your own              noslip new my.toml; noslip compare my.toml
";

/// The row of the table: the answers of a row of `compare --json` to the columns' questions.
pub(crate) fn cells(row: &Value) -> Vec<String> {
    if let Some(failure) = row["failure"]["reason"].as_str() {
        return vec![method(row).to_owned(), format!("failed: {failure}")];
    }
    vec![
        method(row).to_owned(),
        if slips(row) { format!("yes, {:.1e} m/s", slip(row)) } else { "no".to_owned() },
        Energy::of(row).cell(),
        row["error"].as_f64().map_or_else(|| "-".to_owned(), |error| format!("{error:.1e}")),
        duration(row["wall_seconds"].as_f64().unwrap_or(f64::NAN)),
    ]
}

fn method(row: &Value) -> &str {
    row["method"].as_str().unwrap_or_default()
}

/// The largest residual of the constraint (m/s).
fn slip(row: &Value) -> f64 {
    row["constraint"]["max"].as_f64().unwrap_or(f64::NAN)
}

/// Another method whose energy error becomes larger in a run of that length (s).
fn better(row: &Value) -> Option<(&str, f64)> {
    let other = row["better_than"].as_array()?.first()?;
    Some((other["method"].as_str()?, other["from"].as_f64()?))
}

/// A time, in the unit that it is read in.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.3} ms", s * 1e3),
        s if s < 1.0 => format!("{:.1} ms", s * 1e3),
        s => format!("{s:.1} s"),
    }
}

/// The heading: the scene, the duration and the step.
pub(crate) fn heading(scene: &AnyScene) -> String {
    let run = scene.run();
    format!("{}, {} s in steps of {} s", scene.title(), number(run.duration), number(run.step))
}

/// The sentences on the methods that hold the constraint, and on drifts and their speed.
pub(crate) fn sentences(rows: &[&Value]) -> Vec<String> {
    let made: Vec<&Value> = rows.iter().filter(|row| row["failure"]["reason"].is_null()).copied().collect();
    vec![constraint(&made), energy(&made)]
}

fn constraint(made: &[&Value]) -> String {
    let (slipping, holding): (Vec<&Value>, Vec<&Value>) = made.iter().copied().partition(|row| slips(row));
    let most = |some: &[&Value]| some.iter().map(|row| slip(row)).fold(0.0, f64::max);
    let held = (!holding.is_empty()).then(|| {
        let plural = if holding.len() == 1 { "s" } else { "" };
        format!("{} hold{plural} the no-slip constraint to round-off", list(&holding))
    });
    let slips = (!slipping.is_empty())
        .then(|| format!("the blade of {} slips sideways, by up to {:.1e} m/s", list(&slipping), most(&slipping)));
    sentence(held.into_iter().chain(slips))
}

/// Picks one of the kinds, with its number.
type Measured = fn(Energy) -> Option<f64>;

fn energy(made: &[&Value]) -> String {
    let of = |kind: Measured| -> (Vec<&Value>, f64) {
        let some: Vec<&Value> = made.iter().filter(|row| kind(Energy::of(row)).is_some()).copied().collect();
        let most = some.iter().filter_map(|row| kind(Energy::of(row))).map(f64::abs).fold(0.0, f64::max);
        (some, most)
    };
    let kinds: [(Measured, &str); 5] = [
        (|energy| (energy == Energy::Rounding).then_some(0.0), "keeps its value to round-off"),
        (
            |energy| if let Energy::Swings(by) = energy { Some(by) } else { None },
            "swings, by up to {} J, without a drift",
        ),
        (|energy| if let Energy::Drifts(by) = energy { Some(by) } else { None }, "drifts, by {} J/s"),
        (|energy| if let Energy::Wanders(by) = energy { Some(by) } else { None }, "wanders, by up to {} J"),
        (|energy| matches!(energy, Energy::Open(_)).then_some(0.0), "needs a longer run to show its drift"),
    ];
    let mut parts = Vec::new();
    for (kind, does) in kinds {
        let (some, most) = of(kind);
        if !some.is_empty() {
            parts.push(format!("the energy of {} {}", list(&some), does.replace("{}", &format!("{most:.1e}"))));
        }
    }
    let better = made.iter().find_map(|row| Some((method(row), better(row)?)));
    parts.extend(better.map(|(method, (other, from))| {
        format!("in runs longer than {from:.0} s the energy error of {other} is larger than that of {method}")
    }));
    sentence(parts.into_iter())
}

/// The cheapest method at each of the errors.
pub(crate) fn prices(prices: &[Cheapest], motion: f64) -> String {
    let told = prices.iter().map(|price| {
        let error = format!("{:e}", price.error);
        match &price.methods[..] {
            [] => format!("no method reaches an error of {error} m in the time allowed"),
            [(method, seconds), rest @ ..] => {
                let next = rest.first().zip(price.factor());
                let next = next.map_or_else(
                    || ", and no other method reaches this error in the time allowed".to_owned(),
                    |((other, _), factor)| format!(", and {other} takes {factor:.1} times as long"),
                );
                format!("{method} is cheapest at an error of {error} m ({} for {motion} s{next})", duration(*seconds))
            }
        }
    });
    sentence(told)
}

/// The meaning of each column, for the page.
pub(crate) fn notes() -> Vec<(String, String)> {
    COLUMNS.iter().zip(MEANINGS).map(|(column, meaning)| ((*column).to_owned(), meaning.to_owned())).collect()
}

/// The meaning of the columns for the terminal.
pub(crate) fn explanation() -> String {
    let one = |(column, meaning): (&&str, &str)| {
        let lines = wrapped_to(meaning, WIDTH - 4);
        format!("{column}\n{}\n", lines.iter().map(|line| format!("    {line}\n")).collect::<String>())
    };
    let columns: String = COLUMNS.iter().zip(MEANINGS).map(one).collect();
    columns + &aligned(&[("noslip compare SCENE", "more columns, any methods, any scene")])
}

/// Joins parts to a sentence, with a capital letter only if a word begins it: names of methods are small.
fn sentence(parts: impl Iterator<Item = String>) -> String {
    let text = parts.collect::<Vec<_>>().join("; ");
    let capital = ["the ", "an "].iter().any(|word| text.starts_with(word));
    let mut letters = text.chars();
    match letters.next().filter(|_| capital) {
        Some(first) => format!("{}{}.", first.to_uppercase(), letters.as_str()),
        None => format!("{text}."),
    }
}

/// Names as a sentence has them: `a, b and c`.
fn list(rows: &[&Value]) -> String {
    let names: Vec<&str> = rows.iter().map(|row| method(row)).collect();
    match names[..] {
        [.., _, last] => format!("{} and {last}", names[..names.len() - 1].join(", ")),
        _ => names.concat(),
    }
}
