use crate::{Checkpoint, Observer, Report, View, Work};
use std::io;
use std::ops::ControlFlow;

/// A node that was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The number of steps made so far.
    pub k: u64,
    /// Time (s).
    pub t: f64,
    /// Configuration, angles with their full turns.
    pub q: Vec<f64>,
    /// Velocity.
    pub v: Vec<f64>,
    /// Energy (J).
    pub energy: f64,
    /// Work done since the start (J), so that `E(t) - E(0) - work` is the error of the energy.
    pub work: f64,
    /// Largest constraint residual `|A(q) v + b|`.
    pub constraint: f64,
    /// Largest of the functions of the constraints on positions; `None` if there are none.
    pub position: Option<f64>,
    /// Constraint forces averaged over the step that led here; `None` at the start.
    pub multipliers: Option<Vec<f64>>,
}

impl Node {
    /// The node of a view, with the work since the start (J) and the constraint forces.
    #[must_use]
    pub fn of(view: &View<'_>, work: f64, multipliers: Option<Vec<f64>>) -> Self {
        Self {
            k: view.k,
            t: view.t,
            q: view.state.unwrapped(),
            v: view.state.v().to_vec(),
            energy: view.energy(),
            work,
            constraint: view.constraint(),
            position: view.position(),
            multipliers,
        }
    }

    /// One number for each of the [columns](Trajectory::columns).
    pub fn numbers(&self) -> impl Iterator<Item = f64> {
        let Self { t, q, v, energy, work, constraint, .. } = self;
        [*t].into_iter().chain(q.iter().copied()).chain(v.iter().copied()).chain([*energy, *work, *constraint])
    }
}

/// Which nodes are kept: the first, every `every`-th and the last.
#[derive(Debug, Clone, PartialEq)]
struct Choice {
    every: u64,
    time: f64,
    multipliers: Option<Vec<f64>>,
    work: Work,
    /// The number of the last node that was kept.
    last: Option<u64>,
}

impl Choice {
    fn every(every: u64) -> Self {
        Self { every: every.max(1), time: 0.0, multipliers: None, work: Work::default(), last: None }
    }

    fn node(&mut self, view: &View<'_>) -> Node {
        self.last = Some(view.k);
        Node::of(view, self.work.total(), self.multipliers.clone())
    }

    fn start(&mut self, view: &View<'_>) -> Node {
        (self.time, self.multipliers) = (view.t, None);
        self.work.start(view);
        self.node(view)
    }

    fn step(&mut self, view: &View<'_>, report: &Report) -> Option<Node> {
        // Work never ends a run.
        let _ = self.work.step(view, report);
        let rows = report.impulses[0].len();
        let multipliers = self.multipliers.get_or_insert_with(|| vec![0.0; rows]);
        report.multipliers_into(view.t - self.time, multipliers);
        self.time = view.t;
        view.k.is_multiple_of(self.every).then(|| self.node(view))
    }

    fn end(&mut self, view: &View<'_>) -> Option<Node> {
        self.work.end(view);
        (self.last != Some(view.k)).then(|| self.node(view))
    }
}

/// The observer that keeps the first node, every `every`-th and the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    nodes: Vec<Node>,
    choice: Choice,
}

impl Trajectory {
    /// Keeps every `every`-th node; 0 counts as 1.
    #[must_use]
    pub fn every(every: u64) -> Self {
        Self { nodes: Vec::new(), choice: Choice::every(every) }
    }

    /// As [`every`](Self::every), for a run that goes on from a checkpoint, whose work [`Work::load`] gave: keeps the nodes after it.
    #[must_use]
    pub fn resumed(every: u64, t: f64, work: Work) -> Self {
        Self { nodes: Vec::new(), choice: Choice { time: t, work, ..Choice::every(every) } }
    }

    /// The nodes kept, in the order of time.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The names of the columns of a file: time, the coordinates under these names, their rates (`x'`), energy, work and the largest
    /// residual of a constraint. A trajectory of a system of text has the same columns.
    #[must_use]
    pub fn columns(names: &[&str]) -> Vec<String> {
        let rates: Vec<String> = names.iter().map(|name| format!("{name}'")).collect();
        let own = |names: &[&str]| names.iter().copied().map(str::to_owned).collect::<Vec<_>>();
        [own(&["t"]), own(names), rates, own(&["energy", "work", "constraint"])].concat()
    }

    /// Writes the nodes as CSV, in these [columns](Self::columns), all digits of each number.
    ///
    /// ```
    /// # use dla::Trajectory;
    /// let mut text = Vec::new();
    /// Trajectory::every(1).write_csv(&mut text, &["x", "theta"])?;
    /// assert_eq!(text, b"t,x,theta,x',theta',energy,work,constraint\n");
    /// # Ok::<(), std::io::Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of writing.
    pub fn write_csv(&self, mut to: impl io::Write, names: &[&str]) -> io::Result<()> {
        writeln!(to, "{}", Self::columns(names).join(","))?;
        for node in &self.nodes {
            for (k, x) in node.numbers().enumerate() {
                write!(to, "{}{x:?}", if k == 0 { "" } else { "," })?;
            }
            writeln!(to)?;
        }
        Ok(())
    }
}

/// The observer that hands on the nodes a [`Trajectory`] would keep, as they come: the memory holds none of them.
pub struct Nodes<'a> {
    choice: Choice,
    sink: &'a mut dyn FnMut(&Node),
}

impl<'a> Nodes<'a> {
    /// Hands on every `every`-th node, besides the first and the last; 0 counts as 1.
    pub fn every(every: u64, sink: &'a mut dyn FnMut(&Node)) -> Self {
        Self { choice: Choice::every(every), sink }
    }

    /// The same observer for a run that goes on from a checkpoint after `k` steps, at time `t` (s), whose work [`Work::load`] gave, and
    /// which [`save`](Self::save) wrote to: it hands on the same nodes as a run without the checkpoint does from there.
    #[must_use]
    pub fn resumed(self, (k, t): (u64, f64), work: Work, checkpoint: &Checkpoint) -> Self {
        let last = k.is_multiple_of(self.choice.every).then_some(k);
        // They are unknown if the run had no such observer.
        let multipliers = checkpoint.list("multipliers").ok();
        Self { choice: Choice { time: t, work, last, multipliers, ..self.choice }, ..self }
    }

    /// Adds the multipliers of the step to the last node to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        if let Some(multipliers) = &self.choice.multipliers {
            checkpoint.put("multipliers", multipliers);
        }
    }
}

impl std::fmt::Debug for Nodes<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Nodes").field("choice", &self.choice).finish_non_exhaustive()
    }
}

impl Trajectory {
    fn take(&mut self, node: Option<Node>) {
        self.nodes.extend(node);
    }
}

impl Nodes<'_> {
    fn take(&mut self, node: Option<Node>) {
        node.into_iter().for_each(|node| (self.sink)(&node));
    }
}

/// Observers that take the nodes of a choice.
macro_rules! takes_nodes {
    ($($observer:ty),*) => { $(
        impl Observer for $observer {
            fn start(&mut self, node: &View<'_>) {
                let node = self.choice.start(node);
                self.take(Some(node));
            }

            fn resume(&mut self, node: &View<'_>) {
                self.choice.work.resume(node);
            }

            fn step(&mut self, node: &View<'_>, report: &Report) -> ControlFlow<()> {
                let node = self.choice.step(node, report);
                self.take(node);
                ControlFlow::Continue(())
            }

            fn measures_work(&self) -> bool {
                true
            }

            fn part(&mut self, end: &View<'_>, report: &Report) -> ControlFlow<()> {
                self.choice.work.part(end, report)
            }

            fn end(&mut self, node: &View<'_>) {
                let node = self.choice.end(node);
                self.take(node);
            }
        }
    )* };
}

takes_nodes!(Trajectory, Nodes<'_>);
