use crate::tools::{bent, run, train};
use assembly::Solver;

#[test]
fn cost_is_in_proportion() {
    for blades in [1, 10, 100, 1000, 10_000] {
        let train = train(blades);
        let mut state = bent(&train);
        let clock = std::time::Instant::now();
        let mut method = assembly::Dla::new(&train.assembly, Solver::Best).unwrap();
        let setup = clock.elapsed();
        let clock = std::time::Instant::now();
        let _ = assembly::OneStep::step(&mut method, &train.assembly, 0.0, 0.02, &mut state).unwrap();
        let first = clock.elapsed();
        let usage = || std::fs::read_to_string("/proc/thread-self/schedstat").unwrap().split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-6;
        let cpu = usage();
        let clock = std::time::Instant::now();
        let mut it = 0;
        for k in 1..6 {
            it += assembly::OneStep::step(&mut method, &train.assembly, f64::from(k) * 0.02, 0.02, &mut state).unwrap().iterations;
        }
        println!("cpu {} ms", (usage() - cpu) / 5.0); println!("{blades} setup {setup:?} first {first:?} step {:?} iterations {it}/5 {:?}", clock.elapsed() / 5, train.assembly.misses(0.0, &state));
        let _ = run;
    }
}
