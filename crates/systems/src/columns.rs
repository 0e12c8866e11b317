use crate::SceneSystem;
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

/// The columns of a sleigh: what a scene does not have has no column.
pub(crate) fn of_sleigh<S, const N: usize, const M: usize>(system: &S, node: &Node<N, M>) -> Vec<Column>
where
    S: SceneSystem<N, M> + ?Sized,
{
    let mut columns: Vec<_> = SLEIGH.iter().map(|(name, unit)| Column::new(*name, *unit)).collect();
    if system.rotor(&node.q, &node.v).is_some() {
        columns.extend([Column::new("rotor_angle", "rad"), Column::new("rotor_rate", "rad/s")]);
    }
    let powers = system.powers(node.t, &node.q, &node.v, &[0.0; M]);
    if !powers.is_empty() {
        columns.push(Column::new("work", "J"));
    }
    columns.extend(powers.iter().map(|power| Column::new(format!("power_{}", power.name), "W")));
    columns
}

/// The numbers of a node in these columns.
pub(crate) fn row_of_sleigh<S, const N: usize, const M: usize>(system: &S, node: &Node<N, M>) -> Vec<f64>
where
    S: SceneSystem<N, M> + ?Sized,
{
    // The numbers of a node are those of the smooth piece that begins there.
    let piece = system.scene_piece(node.t);
    let SleighState { x, y, heading, speed, turn_rate } = piece.sleigh_state(&node.q, &node.v);
    let [center_x, center_y] = piece.centre(&node.q);
    let lambda = piece.motion(node.t, &node.q, &node.v).map_or([f64::NAN; M], |motion| motion.multiplier);
    // The first constraint is that of the blade.
    let force = lambda.first().copied().unwrap_or(0.0);
    let mut row = Vec::with_capacity(SLEIGH.len() + 4);
    row.extend([node.t, x, y, heading, speed, turn_rate, node.energy, node.constraint, force, center_x, center_y]);
    row.extend(piece.rotor(&node.q, &node.v).into_iter().flatten());
    let powers = piece.powers(node.t, &node.q, &node.v, &lambda);
    if !powers.is_empty() {
        row.push(node.work);
    }
    row.extend(powers.iter().map(|power| power.power));
    row
}
