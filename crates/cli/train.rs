//! The output of commands on a train besides its first blade.

use crate::columns_file::Columns;
use crate::table;
use assembly::parts::Train;
use harness::{Record, Sample};
use serde_json::{Value, json};
use sleigh::SleighState;

/// The most trailers that a picture shows.
const SHOWN: usize = 60;

/// Places and headings along a run of the trailers that a picture shows, one trailer after the other.
pub(crate) fn followers(train: &Train, columns: &Columns) -> Vec<Vec<[f64; 3]>> {
    let column =
        |name: &str| columns.iter().find(|column| column.name == name).map_or(&[][..], |column| &column.values);
    let [x, y, heading] = ["x", "y", "heading"].map(column);
    let others: Vec<String> = (1..=train.trailers().len().min(SHOWN)).map(|k| format!("heading_{k}")).collect();
    let others: Vec<&[f64]> = others.iter().map(|name| column(name)).collect();
    let mut along = vec![Vec::new(); others.len()];
    for (k, first) in x.iter().zip(y).zip(heading).enumerate() {
        let ((x, y), heading) = first;
        let headings: Vec<f64> = others.iter().filter_map(|values| values.get(k)).copied().collect();
        let places = train.places([*x, *y, *heading], &headings);
        along.iter_mut().zip(places).for_each(|(one, place)| one.push(place));
    }
    along
}

/// As [`followers`], at the samples of a run.
pub(crate) fn followers_at(train: &Train, samples: &[Sample]) -> Vec<Vec<[f64; 3]>> {
    let place = |k: usize, sample: &Sample| {
        let SleighState { x, y, heading, .. } = train.blade(&sample.q, &[], k);
        [x, y, heading]
    };
    let shown = 1..=train.trailers().len().min(SHOWN);
    shown.map(|k| samples.iter().map(|sample| place(k, sample)).collect()).collect()
}

/// The last blade at the end of a run.
fn last(train: &Train, record: &Record) -> SleighState {
    train.blade(&record.q, &record.v, train.trailers().len())
}

/// Adds to the object of `run --json` the hinges and the last blade.
pub(crate) fn add_json(object: &mut Value, train: &Train, record: &Record) {
    object["constraint"]["leaf_max"] = json!(record.leaf_max);
    object["trailers"] = json!(train.trailers().len());
    let SleighState { x, y, heading, speed, turn_rate } = last(train, record);
    object["last"] = json!({"x": x, "y": y, "heading": heading, "speed": speed, "turn_rate": turn_rate});
}

/// The hinges and the last blade, for a person.
pub(crate) fn told(train: &Train, record: &Record) -> [(String, String); 3] {
    let last = last(train, record);
    let [x, y, heading] = [last.x, last.y, last.heading].map(table::number);
    let lines = [
        ("hinges", format!("{:.2e} m at most", record.leaf_max.unwrap_or(0.0))),
        ("trailers", train.trailers().len().to_string()),
        ("last blade", format!("x = {x} m, y = {y} m, heading {heading} rad")),
    ];
    lines.map(|(name, value)| (name.to_owned(), value))
}
