use crate::Assembly;
use crate::pattern::PatternPart;
use crate::terms;
use std::ops::Range;

/// The bodies of an assembly, and what their quasi-velocities are to the coordinates.
#[derive(Debug)]
pub(super) struct Frames {
    pub(super) bodies: Vec<BodyFrame>,
    /// For each coordinate, where its row of a frame begins, its first quasi-velocity, and how many there are.
    links: Vec<Link>,
    /// How many quasi-velocities there are in all.
    pub(super) quasi: usize,
    /// How many numbers the frames of all bodies have.
    pub(super) room: usize,
    /// For each element the quasi-velocities that it takes part in, with its constraints that no frame meets.
    pub(super) parts: Vec<PatternPart>,
}

/// A body: an element that brings coordinates of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct BodyFrame {
    pub(super) element: usize,
    /// Its first coordinate, and how many there are.
    at: usize,
    size: usize,
    /// Its first quasi-velocity, and how many there are.
    first: usize,
    pub(super) quasi: usize,
    /// Where its frame begins, and where its mass does.
    frame: usize,
    pub(super) mass: usize,
}

impl BodyFrame {
    pub(super) fn coordinates(&self) -> Range<usize> {
        self.at..self.at + self.size
    }

    pub(super) fn quasi_velocities(&self) -> Range<usize> {
        self.first..self.first + self.quasi
    }

    pub(super) fn frames(&self) -> Range<usize> {
        self.frame..self.frame + self.size * self.quasi
    }

    pub(super) fn masses(&self) -> Range<usize> {
        self.mass..self.mass + self.quasi * self.quasi
    }
}

#[derive(Debug, Clone, Copy)]
struct Link {
    frame: usize,
    first: usize,
    quasi: usize,
}

impl Frames {
    pub(super) fn of(assembly: &Assembly) -> Self {
        let mut frames = Self { bodies: Vec::new(), links: Vec::new(), quasi: 0, room: 0, parts: Vec::new() };
        let (mut row, mut mass) = (0, 0);
        for (element, placed) in assembly.placed().iter().enumerate() {
            let (size, all) = placed.element.size();
            let mut rows = all;
            if placed.at.first().is_some_and(|at| *at == frames.links.len()) {
                let quasi = placed.element.quasi_velocities();
                rows = if quasi < size { 0 } else { all };
                let (at, first, frame) = (frames.links.len(), frames.quasi, frames.room);
                frames.bodies.push(BodyFrame { element, at, size, first, quasi, frame, mass });
                frames.links.extend((0..size).map(|i| Link { frame: frame + i * quasi, first, quasi }));
                frames.quasi += quasi;
                frames.room += size * quasi;
                mass += quasi * quasi;
            }
            let mut at: Vec<usize> = placed
                .at
                .iter()
                .map(|i| frames.links[*i])
                .flat_map(|link| link.first..link.first + link.quasi)
                .collect();
            at.sort_unstable();
            at.dedup();
            frames.parts.push(PatternPart { at: at.into(), row, rows, acts: placed.element.acts() });
            row += rows;
        }
        frames
    }

    /// Whether the element is a body.
    pub(super) fn is_body(&self, element: usize) -> bool {
        self.bodies.binary_search_by_key(&element, |body| body.element).is_ok()
    }

    /// The row of a coordinate in the frames `w`, and where its quasi-velocities are among those of a part.
    fn row<'a>(&self, w: &'a [f64], part: &PatternPart, coordinate: usize) -> (&'a [f64], usize) {
        let Link { frame, first, quasi } = self.links[coordinate];
        (&w[frame..frame + quasi], part.at.partition_point(|at| *at < first))
    }

    /// `W' f` of a covector of an element.
    pub(super) fn reduce(&self, w: &[f64], part: &PatternPart, at: &[usize], f: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (i, f) in at.iter().zip(f) {
            let (row, place) = self.row(w, part, *i);
            for (out, w) in out[place..].iter_mut().zip(row) {
                *out += w * f;
            }
        }
    }

    /// `G W` of the rows `G` of an element.
    pub(super) fn reduce_rows(&self, w: &[f64], part: &PatternPart, at: &[usize], rows: &[f64], out: &mut [f64]) {
        let (n, k) = (at.len(), part.at.len());
        if k > 0 {
            for (row, out) in rows.chunks_exact(n).zip(out.chunks_exact_mut(k)) {
                self.reduce(w, part, at, row, out);
            }
        }
    }

    /// `W' B U` of a block `B` of an element, `W` and `U` frames; `half` has room for `B U`.
    pub(super) fn reduce_block(
        &self,
        [w, u]: [&[f64]; 2],
        part: &PatternPart,
        at: &[usize],
        block: &[f64],
        (half, out): (&mut [f64], &mut [f64]),
    ) {
        let k = part.at.len();
        self.reduce_rows(u, part, at, block, half);
        out.fill(0.0);
        for (i, coordinate) in at.iter().enumerate() {
            let (row, place) = self.row(w, part, *coordinate);
            for (a, w) in row.iter().enumerate() {
                for (out, x) in out[(place + a) * k..][..k].iter_mut().zip(&half[i * k..][..k]) {
                    *out += w * x;
                }
            }
        }
    }

    /// Adds the sums of the sizes of the terms of the equations in quasi-velocities, and of the constraints that no frame meets; `w` is
    /// filled with the frames at the configuration.
    pub(super) fn add_terms(
        &self,
        assembly: &Assembly,
        time: (f64, f64),
        (q, v): (&[f64], &[f64]),
        w: &mut [f64],
        sizes: &mut [f64],
    ) {
        for body in &self.bodies {
            let element = &assembly.placed()[body.element].element;
            if element.frame(time.0, &q[body.coordinates()], &mut w[body.frames()]).is_none() {
                return;
            }
        }
        terms::for_each(
            assembly,
            time,
            |i| q[i],
            |i| v[i],
            |k, placed, momentum, level| {
                for (i, size) in placed.at.iter().zip(momentum) {
                    let Link { frame, first, quasi } = self.links[*i];
                    for (to, w) in sizes[first..first + quasi].iter_mut().zip(&w[frame..]) {
                        *to += w.abs() * size;
                    }
                }
                let PatternPart { row, rows, .. } = self.parts[k];
                for (to, size) in sizes[self.quasi + row..][..rows].iter_mut().zip(level) {
                    *to += size;
                }
            },
        );
    }

    /// `W xi`.
    pub(super) fn combine(&self, w: &[f64], xi: &[f64], v: &mut [f64]) {
        for (link, v) in self.links.iter().zip(v) {
            let row = &w[link.frame..link.frame + link.quasi];
            *v = row.iter().zip(&xi[link.first..]).map(|(w, xi)| w * xi).sum();
        }
    }

    /// `M xi`, block by block.
    pub(super) fn momenta(&self, mass: &[f64], xi: &dyn Fn(usize) -> f64, out: &mut [f64]) {
        for body in &self.bodies {
            let rows = mass[body.masses()].chunks_exact(body.quasi.max(1));
            for (row, out) in rows.zip(&mut out[body.quasi_velocities()]) {
                *out = row.iter().enumerate().map(|(b, m)| m * xi(body.first + b)).sum();
            }
        }
    }
}
