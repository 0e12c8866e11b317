use crate::Trajectory;
use arrays::ArrayColumn;
use std::io::{self, Seek, Write};

/// Writes the nodes of a trajectory as an archive of NumPy arrays, one for each of the [columns](Trajectory::columns). The array
/// `metadata` holds the text.
///
/// # Errors
/// The errors of the writer.
///
/// ```
/// use noslip::prelude::*;
///
/// let mut file = std::io::Cursor::new(Vec::new());
/// noslip::write_npz(&Trajectory::every(1), &mut file, &["x", "theta"], "an empty run")?;
/// assert!(file.into_inner().starts_with(b"PK"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_npz(
    trajectory: &Trajectory,
    file: &mut (impl Write + Seek),
    names: &[&str],
    metadata: &str,
) -> io::Result<()> {
    let names = Trajectory::columns(names);
    let columns: Vec<_> = names.iter().map(|name| ArrayColumn { name, whole: false }).collect();
    let nodes = trajectory.nodes();
    arrays::write(file, &columns, nodes.len() as u64, metadata, |push| {
        nodes.iter().try_for_each(|node| push(&node.numbers().collect::<Vec<f64>>()))
    })
}
