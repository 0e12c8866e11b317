use crate::args::RunArguments;
use crate::error::CliError;
use crate::files::refuse_existing;
use crate::trajectory_file::{Columns, Format};
use crate::{inspect, json, progress, table, terminal};
use dla::{State, Trajectory};
use harness::{Method, Request, integrate};
use scene::{Scene, SceneSystem, Visitor};

/// `noslip run`: one trajectory.
pub(crate) fn run(arguments: &RunArguments) -> Result<(), CliError> {
    let scene = inspect::load(&arguments.scene, arguments.method.as_deref())?;
    let method = Method::named(&scene.run.method, scene.run.alpha)?;
    if let Some(path) = &arguments.out {
        Format::of(path)?;
        refuse_existing(path, arguments.scene.force)?;
    }
    scene.visit(Run { arguments, scene: &scene, method })
}

struct Run<'a> {
    arguments: &'a RunArguments,
    scene: &'a Scene,
    method: Method,
}

impl Visitor for Run<'_> {
    type Output = Result<(), CliError>;

    fn visit<Sys, const N: usize, const M: usize>(self, system: &Sys, q: [f64; N], v: [f64; N]) -> Self::Output
    where
        Sys: SceneSystem<N, M>,
    {
        let Self { arguments, scene, method } = self;
        let schedule = inspect::schedule(scene);
        let bar = progress::bar(method.info().name, schedule.steps);
        let request = Request { schedule, q, v, samples: 1 };
        let record = harness::run(system, &method, &request, &mut |steps| bar.inc(steps));
        bar.finish_and_clear();

        if let Some(path) = &arguments.out {
            let mut trajectory = Trajectory::<N, M>::every(arguments.every);
            let mut state = State::new(q, v, system.angles());
            // A failure here is the one that the record already tells of.
            let _ = integrate(system, &method, &schedule, &mut state, &mut trajectory);
            let columns = Columns::new(system, trajectory.nodes());
            columns.write(path, Format::of(path)?, arguments.scene.force)?;
        }
        let end = system.sleigh_state(&record.q, &record.v);
        if arguments.scene.json {
            terminal::print_json(&json::record(&scene.name, &record, &end))?;
        } else {
            terminal::print(&table::one_run(scene, &record, &end, arguments.out.as_deref()))?;
        }
        table::failure(&record).map_or(Ok(()), Err)
    }
}
