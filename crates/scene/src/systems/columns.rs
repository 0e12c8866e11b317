use super::{EffectPower, SceneSystem};
use assembly::parts::Train;
use dla::Node;
use sleigh::SleighState;

/// The name and the unit of a column of numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// The name, by which a column is one of its file.
    pub name: String,
    /// The unit, as a reader of the file sees it.
    pub unit: String,
    /// Whether all of its numbers are whole ones: a file stores them as integers.
    pub whole: bool,
}

impl Column {
    /// A column.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), whole: false }
    }

    /// A column of whole numbers without a unit, such as the number of a member.
    pub fn whole(name: impl Into<String>) -> Self {
        Self { whole: true, ..Self::new(name, "") }
    }
}

/// The columns that every sleigh has.
const SLEIGH: [(&str, &str); 11] = [
    ("t", "s"),
    ("x", "m"),
    ("y", "m"),
    ("heading", "rad"),
    ("speed", "m/s"),
    ("turn_rate", "rad/s"),
    ("energy", "J"),
    ("constraint", "m/s"),
    ("constraint_force", "N"),
    ("center_x", "m"),
    ("center_y", "m"),
];

/// The columns of a rotor.
const ROTOR: [(&str, &str); 2] = [("rotor_angle", "rad"), ("rotor_rate", "rad/s")];

/// The columns of a sleigh: what a scene does not have has no column.
pub(super) fn of_sleigh(rotor: bool, powers: &[EffectPower]) -> Vec<Column> {
    let mut columns: Vec<_> = SLEIGH.iter().map(|(name, unit)| Column::new(*name, *unit)).collect();
    if rotor {
        columns.extend(ROTOR.map(|(name, unit)| Column::new(name, unit)));
    }
    if !powers.is_empty() {
        columns.push(Column::new("work", "J"));
    }
    columns.extend(powers.iter().map(|power| Column::new(format!("power_{}", power.name), "W")));
    columns
}

/// The numbers of a node in these columns, of the smooth piece that holds there.
pub(super) fn row_of_sleigh(piece: &dyn SceneSystem, node: &Node) -> Vec<f64> {
    let Node { t, q, v, energy, constraint, .. } = node;
    let SleighState { x, y, heading, speed, turn_rate } = piece.sleigh_state(q, v);
    let [center_x, center_y] = piece.centre(q);
    let lambda = piece.mechanism().motion(*t, q, v).map_or_else(|_| Vec::new(), |[_, lambda]| lambda);
    // The first constraint is that of the blade.
    let force = lambda.first().copied().unwrap_or(f64::NAN);
    let mut row = Vec::with_capacity(SLEIGH.len() + 4);
    row.extend([*t, x, y, heading, speed, turn_rate, *energy, *constraint, force, center_x, center_y]);
    row.extend(piece.rotor(q, v).into_iter().flatten());
    let powers = piece.powers(*t, q, v, &lambda);
    if !powers.is_empty() {
        row.push(node.work);
    }
    row.extend(powers.iter().map(|power| power.power));
    row
}

/// The columns of a train: its first blade, the headings of the others, and the rotor, if there is one.
pub(super) fn of_train(train: &Train) -> Vec<Column> {
    let own = SLEIGH[..7].iter().copied().chain([("work", "J"), ("constraint", "m/s"), ("hinges", "m")]);
    let others = (1..=train.trailers().len()).map(|k| Column::new(format!("heading_{k}"), "rad"));
    let rotor = if train.has_rotor() { &ROTOR[..] } else { &[] };
    let named = |(name, unit)| Column::new(name, unit);
    own.map(named).chain(others).chain(rotor.iter().copied().map(named)).collect()
}

/// The numbers of a node in these columns.
pub(super) fn row_of_train(train: &Train, node: &Node) -> Vec<f64> {
    let Node { t, q, v, energy, work, constraint, position, .. } = node;
    let SleighState { x, y, heading, speed, turn_rate } = train.blade(q, v, 0);
    let hinges = position.unwrap_or(f64::NAN);
    let mut row = vec![*t, x, y, heading, speed, turn_rate, *energy, *work, *constraint, hinges];
    row.extend((1..=train.trailers().len()).map(|k| train.blade(q, v, k).heading));
    row.extend(train.rotor(q, v).into_iter().flatten());
    row
}
