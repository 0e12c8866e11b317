use crate::Trajectory;
use arrays::ArrayColumn;
use std::io::{self, Seek, Write};

/// Writes the nodes of a trajectory as an archive of NumPy arrays, in the columns of [`Trajectory::write_csv`]: time, the coordinates under
/// these names, their rates (`x'`), energy, work and the largest residual of a constraint. The array `metadata` holds the text.
///
/// # Errors
/// Those of writing.
///
/// ```
/// use noslip::prelude::*;
///
/// let mut file = std::io::Cursor::new(Vec::new());
/// noslip::write_npz(&Trajectory::<2, 1>::every(1), &mut file, ["x", "theta"], "an empty run")?;
/// assert!(file.into_inner().starts_with(b"PK"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_npz<const N: usize, const M: usize>(
    trajectory: &Trajectory<N, M>,
    file: &mut (impl Write + Seek),
    names: [&str; N],
    metadata: &str,
) -> io::Result<()> {
    let rates = names.map(|name| format!("{name}'"));
    let rest = ["energy", "work", "constraint"];
    let names = ["t"].into_iter().chain(names).chain(rates.iter().map(String::as_str)).chain(rest);
    let columns: Vec<ArrayColumn<'_>> = names.map(|name| ArrayColumn { name, whole: false }).collect();
    let nodes = trajectory.nodes();
    arrays::write(file, &columns, nodes.len() as u64, metadata, |column, push| {
        nodes.iter().try_for_each(|node| {
            push(match column {
                0 => node.t,
                k if k <= N => node.q[k - 1],
                k if k <= 2 * N => node.v[k - N - 1],
                k if k == 2 * N + 1 => node.energy,
                k if k == 2 * N + 2 => node.work,
                _ => node.constraint,
            })
        })
    })
}
