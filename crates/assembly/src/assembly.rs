use crate::AssemblyError;
use crate::element::Element;
use crate::element::WIDEST;
use crate::joint::{Joint, JointElement};
use crate::system_element::SystemElement;
use dla::ConstraintRow;
use lagrangian::{Piecewise, System};
use std::ops::Range;
use std::sync::Arc;

/// A large system as an assembly of small ones: elements on coordinates that they share.
///
/// A body brings coordinates of its own; an effect or a joint is an element on the coordinates of bodies. The Lagrangian and forces of the
/// assembly are the sums over its elements, and its constraints are all their constraints, so its equations have a sparse matrix whose
/// pattern never changes.
///
/// ```
/// use assembly::parts::Hinge;
/// use assembly::Assembly;
/// use sleigh::Sleigh;
///
/// let sleigh = Sleigh::new(1.0, 1.0, 0.5)?;
/// let mut train = Assembly::new();
/// let first = train.body("blade", sleigh);
/// let second = train.body("blade", sleigh);
/// let [x, y, turn] = first;
/// train.join("hinge", Hinge::new([-0.5, 0.0], [0.5, 0.0]), [x, y, turn, second[0], second[1], second[2]])?;
/// assert_eq!((train.coordinates(), train.rows()), (6, 4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Assembly {
    placed: Vec<PlacedElement>,
    angles: Vec<bool>,
    rows: usize,
}

/// An element with its coordinates and rows in the assembly.
#[derive(Debug, Clone)]
pub(crate) struct PlacedElement {
    pub(crate) element: Arc<dyn Element>,
    pub(crate) name: &'static str,
    /// The element's coordinates, as numbers of coordinates of the assembly.
    pub(crate) at: Box<[usize]>,
    /// The first of the element's constraint rows.
    pub(crate) row: usize,
    pub(crate) rows: usize,
    /// For each coordinate of the element, the coordinate from which it is measured, if the element gives origins.
    pub(crate) origins: Option<Box<[Option<usize>]>>,
}

impl PlacedElement {
    /// The element's part of a vector of the assembly.
    #[inline(always)]
    pub(crate) fn gather(&self, from: impl Fn(usize) -> f64, into: &mut [f64]) {
        for (slot, at) in into.iter_mut().zip(&self.at) {
            *slot = from(*at);
        }
    }

    /// The coordinates of an element that has more than can be shared: they follow one another.
    #[inline(always)]
    pub(crate) fn wide(&self) -> Option<Range<usize>> {
        (self.at.len() > WIDEST).then(|| self.at[0]..self.at[0] + self.at.len())
    }
}

impl Assembly {
    /// An assembly of nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a system with coordinates of its own, and returns their numbers.
    pub fn body<Sys, const N: usize, const M: usize>(&mut self, name: &'static str, system: Sys) -> [usize; N]
    where
        Sys: System<N, M> + Piecewise + Send + Sync + 'static,
    {
        let first = self.angles.len();
        self.part(name, SystemElement { system: Box::new(system) });
        lagrangian::from_fn(|i| first + i)
    }

    /// Adds an element with coordinates of its own, of any number, and returns their numbers.
    pub fn part(&mut self, name: &'static str, element: impl Element + 'static) -> Range<usize> {
        let first = self.angles.len();
        self.angles.resize(first + element.size().0, false);
        element.angles(&mut self.angles[first..]);
        let own = first..self.angles.len();
        self.place(name, Arc::new(element), &own.clone().collect::<Vec<_>>());
        own
    }

    /// Adds a system on existing coordinates: a spring between bodies, a force, a blade under a body.
    ///
    /// # Errors
    /// [`AssemblyError::Coordinates`] if a coordinate does not exist, or is named twice.
    pub fn attach<Sys, const N: usize, const M: usize>(
        &mut self,
        name: &'static str,
        system: Sys,
        at: [usize; N],
    ) -> Result<(), AssemblyError>
    where
        Sys: System<N, M> + Piecewise + Send + Sync + 'static,
    {
        self.check(name, &at)?;
        self.place(name, Arc::new(SystemElement { system: Box::new(system) }), &at);
        Ok(())
    }

    /// Adds a joint on existing coordinates.
    ///
    /// # Errors
    /// As [`attach`](Self::attach).
    pub fn join<J, const N: usize, const M: usize>(
        &mut self,
        name: &'static str,
        joint: J,
        at: [usize; N],
    ) -> Result<(), AssemblyError>
    where
        J: Joint<N, M> + 'static,
    {
        self.check(name, &at)?;
        self.place(name, Arc::new(JointElement { joint }), &at);
        Ok(())
    }

    fn check(&self, name: &'static str, at: &[usize]) -> Result<(), AssemblyError> {
        let twice = |i: &usize| at.iter().filter(|j| *j == i).count() > 1;
        match at.iter().find(|i| **i >= self.angles.len() || twice(i)) {
            Some(coordinate) => Err(AssemblyError::Coordinates { name, coordinate: *coordinate }),
            None if at.len() > WIDEST => Err(AssemblyError::Wide { name, coordinates: at.len() }),
            None => Ok(()),
        }
    }

    fn place(&mut self, name: &'static str, element: Arc<dyn Element>, at: &[usize]) {
        let (_, rows) = element.size();
        let mut origins = vec![None; at.len()];
        element.origins(&mut origins);
        let origins = origins.iter().any(Option::is_some).then(|| origins.into());
        self.placed.push(PlacedElement { element, name, at: at.into(), row: self.rows, rows, origins });
        self.rows += rows;
    }

    /// The times at which one of its elements jumps, in the open interval from `from` to `to` (s), in any order.
    #[must_use]
    pub fn jump_times(&self, from: f64, to: f64) -> Vec<f64> {
        self.placed.iter().flat_map(|placed| placed.element.jump_times(from, to)).collect()
    }

    /// The smooth piece of it that holds at the time `t` (s), continued to all times: an assembly of the same pattern.
    #[must_use]
    pub fn smooth_piece(&self, t: f64) -> Self {
        let piece = |placed: &PlacedElement| {
            let element = placed.element.smooth_piece(t).map_or_else(|| Arc::clone(&placed.element), Arc::from);
            PlacedElement { element, ..placed.clone() }
        };
        Self { placed: self.placed.iter().map(piece).collect(), angles: self.angles.clone(), rows: self.rows }
    }

    /// How many coordinates there are.
    #[must_use]
    pub fn coordinates(&self) -> usize {
        self.angles.len()
    }

    /// How many constraint rows there are.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many elements there are.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.placed.len()
    }

    /// Which coordinates are angles.
    #[must_use]
    pub fn angles(&self) -> &[bool] {
        &self.angles
    }

    pub(crate) fn placed(&self) -> &[PlacedElement] {
        &self.placed
    }

    /// The constraint of that row.
    #[must_use]
    pub fn constraint(&self, row: usize) -> Option<ConstraintRow> {
        let after = self.placed.partition_point(|placed| placed.row + placed.rows <= row);
        let placed = self.placed.get(after)?;
        let count = |x: usize| u32::try_from(x).unwrap_or(u32::MAX);
        Some(ConstraintRow { element: count(after), row: count(row - placed.row), name: placed.name })
    }
}
