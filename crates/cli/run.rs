use crate::args::RunArguments;
use crate::error::CliError;
use crate::files::check_file;
use crate::trajectory_file::{self, Format};
use crate::{inspect, json, progress, table, terminal};
use dla::{Schedule, State, Trajectory};
use harness::{Kind, Method, Request, integrate_pieces};
use scene::{Scene, SceneSystem, Visitor};
use std::path::Path;

/// `noslip run`: one trajectory.
pub(crate) fn run(arguments: &RunArguments) -> Result<(), CliError> {
    let scene = inspect::load(&arguments.scene, arguments.method.as_deref())?;
    let method = Method::named(&scene.run.method, scene.run.alpha)?;
    let out = match &arguments.out {
        Some(path) => {
            let format = Format::of(path)?;
            trajectory_file::check_size(scene.run.steps(), arguments.every)?;
            check_file(path, arguments.scene.force)?;
            Some((path.as_path(), format))
        }
        None => None,
    };
    if arguments.scene.alpha.is_some() && method.info().kind != Kind::DlaAlpha {
        let name = method.info().name;
        terminal::say("warning", &format!("--alpha is the weight of dla-alpha; {name} has none and ignores it"));
    }
    scene.visit(Run { arguments, scene: &scene, method, out })?
}

struct Run<'a> {
    arguments: &'a RunArguments,
    scene: &'a Scene,
    method: Method,
    out: Option<(&'a Path, Format)>,
}

impl Run<'_> {
    /// Integrates once more, now to keep the nodes, and writes them.
    fn write<Sys, const N: usize, const M: usize>(
        &self,
        system: &Sys,
        schedule: &Schedule,
        mut state: State<N>,
    ) -> Result<(), CliError>
    where
        Sys: SceneSystem<N, M>,
    {
        let Some((path, format)) = self.out else { return Ok(()) };
        let mut trajectory = Trajectory::<N, M>::every(self.arguments.every);
        // A failure here is the one that the record already tells of.
        let _ = integrate_pieces(system, &self.method, schedule, &mut state, &mut trajectory);
        trajectory_file::write(system, trajectory.nodes(), path, format, self.arguments.scene.force)
    }
}

impl Visitor for Run<'_> {
    type Output = Result<(), CliError>;

    fn visit<Sys, const N: usize, const M: usize>(self, system: &Sys, q: [f64; N], v: [f64; N]) -> Self::Output
    where
        Sys: SceneSystem<N, M>,
    {
        let schedule = inspect::schedule(self.scene);
        let bar = progress::bar(self.method.info().name, schedule.steps);
        let request = Request { schedule, q, v, samples: 1 };
        let record = harness::run(system, &self.method, &request, &mut |steps| bar.inc(steps));
        bar.finish_and_clear();

        let written = self.write(system, &schedule, State::new(q, v, system.angles()));
        let end = system.sleigh_state(&record.q, &record.v);
        // What was computed is shown even where its file could not be written.
        if self.arguments.scene.json {
            terminal::print_json(&json::record(&self.scene.name, &record, &end))?;
        } else {
            let file = self.out.and_then(|(path, _)| written.is_ok().then_some(path));
            terminal::print(&table::one_run(self.scene, &record, &end, file))?;
        }
        let computed = CliError::of_failures(table::failure(&record));
        if let (Err(_), Err(error)) = (&computed, &written) {
            terminal::say("error", error);
        }
        computed.and(written)
    }
}
