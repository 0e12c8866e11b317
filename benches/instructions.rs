//! How many instructions a step takes, counted by callgrind: what an effect adds, and that one which is absent adds nothing.
//!
//! The program runs itself under `valgrind --tool=callgrind`, each case with two numbers of steps; the difference is the
//! steps alone. Counts repeat to the instruction where times do not. Valgrind knows not every AVX instruction, so build for a machine that
//! it does know: `RUSTFLAGS="-C target-cpu=x86-64-v2" cargo bench --bench instructions`.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use dla::{Dla, Form, Gauss, OneStep, Schedule, State, drive};
use lagrangian::{System, With};
use scene::{Acting, Scene, SceneSystem, Visitor};
use sleigh::effects::{Bowl, Drag, EggCrate};
use sleigh::{Guide, Guided, Sleigh, SleighState};
use std::hint::black_box;
use std::process::{Command, ExitCode};

const FEW: u64 = 100;
const MANY: u64 = 600;
/// What counts as the same: the issue of inlining decisions, not of terms.
const SAME: f64 = 0.02;

/// Name, what it runs, and the case that it must cost the same as.
type Case = (&'static str, fn(u64), Option<&'static str>);

const CASES: &[Case] = &[
    ("dla, the sleigh itself", |steps| dla(&sleigh(), steps), None),
    ("dla, no effect, typed", |steps| dla(&with(()), steps), Some("dla, the sleigh itself")),
    ("dla, no effect, scene", |steps| scene("", steps), Some("dla, the sleigh itself")),
    ("dla, bowl, typed", |steps| dla(&with((bowl(),)), steps), None),
    ("dla, bowl, scene", |steps| scene(BOWL, steps), None),
    ("dla, bowl + drag, typed", |steps| dla(&with((bowl(), drag())), steps), None),
    ("dla, bowl + drag, list", |steps| dla(&with(vec![Acting::Bowl(bowl()), Acting::Drag(drag())]), steps), None),
    ("dla, bowl + drag + egg crate, typed", |steps| dla(&with((bowl(), drag(), egg_crate())), steps), None),
    ("dla, bowl + drag + egg crate, list", |steps| dla(&with(three()), steps), None),
    ("dla, servo, typed", |steps| servo(&With { body: guided(), effects: () }, steps), None),
    ("dla, servo, scene", |steps| scene(SERVO, steps), Some("dla, servo, typed")),
    ("gauss8, the sleigh itself", |steps| gauss(&sleigh(), steps), None),
    ("gauss8, no effect, typed", |steps| gauss(&with(()), steps), Some("gauss8, the sleigh itself")),
    ("gauss8, bowl, typed", |steps| gauss(&with((bowl(),)), steps), None),
];

const BOWL: &str = "\n[[effects]]\nkind = \"bowl\"\nstiffness = [0.1, 0.1]\n";

const SERVO: &str = "\n[[effects]]\nkind = \"servo\"\nspeed = 0.7\n";

/// A sleigh whose speed is imposed.
fn guided() -> Guided<1> {
    Guided::<1>::servo(sleigh(), Guide::Speed(0.7.into())).expect("finite")
}

fn sleigh() -> Sleigh {
    Sleigh::new(1.0, 1.0, 0.5).expect("positive parameters")
}

fn with<E>(effects: E) -> With<Sleigh, E> {
    With { body: sleigh(), effects }
}

fn bowl() -> Bowl {
    Bowl::new([0.1; 2], [0.0; 2]).expect("finite")
}

fn drag() -> Drag {
    Drag::new(0.01, 0.01).expect("positive")
}

fn egg_crate() -> EggCrate {
    EggCrate::new(0.1, [1.0; 2]).expect("finite")
}

fn three() -> Vec<Acting> {
    vec![Acting::Bowl(bowl()), Acting::Drag(drag()), Acting::EggCrate(egg_crate())]
}

/// The first steps of the turn-around.
fn go<Sys: System<3, 1>>(system: &Sys, mut method: impl OneStep<Sys, 3, 1>, steps: u64) {
    let (q, v) = black_box(SleighState { speed: -1.0, turn_rate: 0.1, ..SleighState::default() }).to_coordinates();
    let mut state = State::new(q, v, system.angles());
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    drive(black_box(system), &mut method, &schedule, &mut state, ()).expect("the steps succeed");
    black_box(state);
}

fn servo<Sys: System<3, 2>>(system: &Sys, steps: u64) {
    let (q, v) = black_box(SleighState { speed: 0.7, turn_rate: 0.1, ..SleighState::default() }).to_coordinates();
    let mut state = State::new(q, v, system.angles());
    let schedule = Schedule { t0: 0.0, step: 0.05, steps };
    drive(black_box(system), &mut Dla::midpoint(), &schedule, &mut state, ()).expect("the steps succeed");
    black_box(state);
}

/// By the general midpoint step: its closed form knows no effects.
fn dla<Sys: System<3, 1>>(system: &Sys, steps: u64) {
    go(system, Dla::midpoint().solved(Form::General), steps);
}

fn gauss<Sys: System<3, 1>>(system: &Sys, steps: u64) {
    go(system, Gauss::<4>::default(), steps);
}

/// The same through a scene file.
fn scene(effects: &str, steps: u64) {
    let text = Scene::template().split("[[effects]]").next().expect("a first part").to_owned() + effects;
    let scene = Scene::parse(&text, "bench.toml", &["dla"]).expect("a valid scene");
    scene.visit(Steps(steps)).expect("a valid scene");
}

struct Steps(u64);

impl Visitor for Steps {
    type Output = ();

    fn visit<Sys, const N: usize, const M: usize>(self, system: &Sys, q: [f64; N], v: [f64; N])
    where
        Sys: SceneSystem<N, M>,
    {
        let mut state = State::new(black_box(q), black_box(v), system.angles());
        let schedule = Schedule { t0: 0.0, step: 0.05, steps: self.0 };
        let mut method = Dla::midpoint().solved(Form::General);
        drive(black_box(system), &mut method, &schedule, &mut state, ()).expect("the steps succeed");
        black_box(state);
    }
}

/// Instructions of this program with the given case and number of steps; `None` where valgrind cannot say.
fn count(case: usize, steps: u64) -> Option<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe().ok()?)
        .args(["--case", &case.to_string(), &steps.to_string()])
        .output()
        .ok()?;
    let log = String::from_utf8_lossy(&output.stderr).into_owned();
    let collected = log.lines().find_map(|line| line.split_once("Collected :"))?;
    collected.1.trim().parse().ok().filter(|_| output.status.success())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(at) = arguments.iter().position(|argument| argument == "--case") {
        let number = |k: usize| arguments[at + k].parse::<u64>().expect("a number");
        let case = usize::try_from(number(1)).expect("a case");
        CASES[case].1(number(2));
        return ExitCode::SUCCESS;
    }
    let mut counts: Vec<(&str, f64)> = Vec::new();
    let mut failed = false;
    println!("{:<40} {:>18}", "instructions a step", "count");
    for (case, (name, _, same)) in CASES.iter().enumerate() {
        let (Some(few), Some(many)) = (count(case, FEW), count(case, MANY)) else {
            println!("{name:<40} not counted: this needs valgrind, and a build for a processor that it knows");
            return ExitCode::SUCCESS;
        };
        let per_step = (many - few) as f64 / (MANY - FEW) as f64;
        counts.push((name, per_step));
        let other = same.and_then(|same| counts.iter().find(|(name, _)| *name == same));
        let verdict = match other {
            Some((_, other)) if (per_step / other - 1.0).abs() <= SAME => format!("  {:.3} of that", per_step / other),
            Some((_, other)) => {
                failed = true;
                format!("  {:.3} of that: NOT the same", per_step / other)
            }
            None => String::new(),
        };
        println!("{name:<40} {per_step:>18.1}{verdict}");
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
