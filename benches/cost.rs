//! What everything costs in time: a step of every method, of every effect, the parts of a step, an ensemble, a report.
//!
//! The same cases as in `instructions`. Times of a shared machine wander; ratios of what ran side by side are in `step` and in
//! `noslip precision`.

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

// What must be the same is counted, not timed.
#[allow(dead_code)]
mod cases;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::time::Duration;

fn cost(criterion: &mut Criterion) {
    let cases = cases::all();
    for of_group in cases.chunk_by(|a, b| a.group == b.group) {
        let mut group = criterion.benchmark_group(of_group[0].group);
        group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_millis(800)).sample_size(20);
        for case in of_group {
            // Steps, solutions, sleighs or pages.
            group.throughput(Throughput::Elements(case.times()));
            group.bench_function(&case.name, |bencher| bencher.iter(|| (case.run)(case.times())));
        }
        group.finish();
    }
}

criterion_group!(benches, cost);
criterion_main!(benches);
