use crate::element::Element;
use crate::joint::{Joint, JointElement};
use crate::system_element::SystemElement;
use crate::{AssemblyError, AssemblyState, ConstraintRow};
use dla::NotANumber;
use lagrangian::System;
use lagrangian::linear::larger;

/// The most coordinates that an element may have.
pub const WIDEST: usize = 24;

/// A large system as an assembly of small ones: elements on coordinates that they share.
///
/// A body brings coordinates of its own; what acts on bodies or joins them is an element on theirs. Lagrangian, forces and
/// constraints of the whole are the sums and lists of those of the elements, so that its equations have a sparse matrix whose
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
#[derive(Debug, Default)]
pub struct Assembly {
    placed: Vec<PlacedElement>,
    angles: Vec<bool>,
    rows: usize,
}

/// An element where it acts.
#[derive(Debug)]
pub(crate) struct PlacedElement {
    pub(crate) element: Box<dyn Element>,
    pub(crate) name: &'static str,
    /// The coordinates of the assembly that are those of the element.
    pub(crate) at: Box<[usize]>,
    /// The first of its constraint rows.
    pub(crate) row: usize,
    pub(crate) rows: usize,
    /// Which of its coordinates each is measured from, where it says so.
    pub(crate) origins: Option<Box<[Option<usize>]>>,
}

impl PlacedElement {
    /// The element's part of a vector of the assembly.
    #[inline(always)]
    pub(crate) fn gather(&self, from: impl Fn(usize) -> f64, into: &mut [f64; WIDEST]) -> usize {
        for (slot, at) in into.iter_mut().zip(&self.at) {
            *slot = from(*at);
        }
        self.at.len()
    }
}

impl Assembly {
    /// An assembly of nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a system with coordinates of its own, and returns which those are.
    pub fn body<Sys, const N: usize, const M: usize>(&mut self, name: &'static str, system: Sys) -> [usize; N]
    where
        Sys: System<N, M> + Send + Sync + 'static,
    {
        let at = lagrangian::from_fn(|i| self.angles.len() + i);
        self.angles.extend(system.angles());
        self.place(name, Box::new(SystemElement { system: Box::new(system) }), &at);
        at
    }

    /// Adds a system on coordinates that there are: a spring between bodies, a force, a blade under a body.
    ///
    /// # Errors
    /// [`AssemblyError::Coordinates`] where one of them is not there, or is named twice.
    pub fn attach<Sys, const N: usize, const M: usize>(
        &mut self,
        name: &'static str,
        system: Sys,
        at: [usize; N],
    ) -> Result<(), AssemblyError>
    where
        Sys: System<N, M> + Send + Sync + 'static,
    {
        self.check(name, &at)?;
        self.place(name, Box::new(SystemElement { system: Box::new(system) }), &at);
        Ok(())
    }

    /// Adds a joint on coordinates that there are.
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
        self.place(name, Box::new(JointElement { joint }), &at);
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

    fn place(&mut self, name: &'static str, element: Box<dyn Element>, at: &[usize]) {
        let (_, rows) = element.size();
        let mut origins = vec![None; at.len()];
        element.origins(&mut origins);
        let origins = origins.iter().any(Option::is_some).then(|| origins.into());
        self.placed.push(PlacedElement { element, name, at: at.into(), row: self.rows, rows, origins });
        self.rows += rows;
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
        Some(ConstraintRow { element: after, name: placed.name, row: row - placed.row })
    }

    /// What each element says of a state, from its coordinates and velocities.
    pub(crate) fn say<T>(
        &self,
        state: &AssemblyState,
        mut of: impl FnMut(&dyn Element, &[f64], &[f64]) -> T,
        mut with: impl FnMut(T),
    ) {
        let (mut q, mut v) = ([0.0; WIDEST], [0.0; WIDEST]);
        for placed in &self.placed {
            let n = placed.gather(|i| state.q(i), &mut q);
            for (k, origin) in placed.origins.iter().flatten().enumerate() {
                q[k] = origin.map_or(q[k], |origin| state.apart(placed.at[k], placed.at[origin]));
            }
            placed.gather(|i| state.v(i), &mut v);
            with(of(placed.element.as_ref(), &q[..n], &v[..n]));
        }
    }

    /// The first element with a function that is not finite at a state, or has no finite derivative there; coordinates and rows in the
    /// numbers of the assembly.
    #[must_use]
    #[cold]
    pub fn not_a_number(&self, t: f64, state: &AssemblyState) -> Option<(usize, &'static str, NotANumber)> {
        let (mut places, mut found) = (self.placed.iter().enumerate(), None);
        self.say(
            state,
            |element, q, v| element.not_a_number(t, q, v),
            |missing| {
                let placed = places.next();
                if let (None, Some((element, placed)), Some(missing)) = (found, placed, missing) {
                    let missing = missing.renumbered(|i| placed.at.get(i).copied().unwrap_or(i), placed.row);
                    found = Some((element, placed.name, missing));
                }
            },
        );
        found
    }

    /// The energy (J).
    #[must_use]
    pub fn energy(&self, t: f64, state: &AssemblyState) -> f64 {
        let mut total = 0.0;
        self.say(state, |element, q, v| element.energy(t, q, v), |energy| total += energy);
        total
    }

    /// The power of all forces and of time (W).
    #[must_use]
    pub fn power(&self, t: f64, state: &AssemblyState) -> f64 {
        let mut total = 0.0;
        self.say(state, |element, q, v| element.power(t, q, v), |power| total += power);
        total
    }

    /// The largest residual `|A v + b|` of all constraints (m/s), and the largest `|g|` of those on positions (m).
    #[must_use]
    pub fn misses(&self, t: f64, state: &AssemblyState) -> [f64; 2] {
        let mut most = [0.0; 2];
        let each = |miss: [f64; 2]| most = [larger(most[0], miss[0]), larger(most[1], miss[1])];
        self.say(state, |element, q, v| element.misses(t, q, v), each);
        most
    }
}
