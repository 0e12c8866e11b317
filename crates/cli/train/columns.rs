use crate::columns_file::Columns;
use assembly::parts::Train;
use harness::AssemblyNode;
use scene::Column;
use sleigh::SleighState;

/// The columns of a train: those of its first blade, the headings of the others, and the rotor, where there is one.
pub(super) fn columns(train: &Train) -> Vec<Column> {
    let own = [
        ("t", "s"),
        ("x", "m"),
        ("y", "m"),
        ("heading", "rad"),
        ("speed", "m/s"),
        ("turn_rate", "rad/s"),
        ("energy", "J"),
        ("work", "J"),
        ("constraint", "m/s"),
        ("hinges", "m"),
    ];
    let others = (1..=train.trailers().len()).map(|k| Column::new(format!("heading_{k}"), "rad"));
    let rotor = [("rotor_angle", "rad"), ("rotor_rate", "rad/s")].into_iter().filter(|_| train.has_rotor());
    let named = |(name, unit)| Column::new(name, unit);
    own.into_iter().map(named).chain(others).chain(rotor.map(named)).collect()
}

/// The numbers of a node in these columns.
pub(super) fn row(train: &Train, node: &AssemblyNode) -> Vec<f64> {
    let SleighState { x, y, heading, speed, turn_rate } = first(&node.q, &node.v);
    let AssemblyNode { t, energy, work, constraint, joint, .. } = *node;
    let mut row = vec![t, x, y, heading, speed, turn_rate, energy, work, constraint, joint];
    row.extend((1..=train.trailers().len()).map(|k| node.q[3 * k + 2]));
    row.extend(train.rotor(&node.q, &node.v).into_iter().flatten());
    row
}

/// A picture shows so many trailers.
pub(super) const SHOWN: usize = 60;

/// Places and headings of the trailers along a run, one after the other: those that a picture shows.
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

/// The state of the first blade.
fn first(q: &[f64], v: &[f64]) -> SleighState {
    let of = |x: &[f64]| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
    SleighState::from_coordinates(&of(q), &of(v))
}
