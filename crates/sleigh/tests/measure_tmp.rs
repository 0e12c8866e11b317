#![allow(missing_docs)]
use sleigh::{Exact, Sleigh, SleighState};
#[test]
fn measure() {
    let mut worst = [0.0f64; 5];
    for line in include_str!("golden/exact.txt").lines().filter(|l| !l.starts_with('#')) {
        let (i, o) = line.split_once('|').unwrap();
        let p = |s: &str| s.split_whitespace().map(|v| v.parse::<f64>().unwrap()).collect::<Vec<_>>();
        let (i, o) = (p(i), p(o));
        let s = Sleigh::new(i[0], i[1], i[2]).unwrap();
        let st = SleighState { x: i[3], y: i[4], heading: i[5], speed: i[6], turn_rate: i[7] };
        let e = Exact::new(&s, &st).unwrap();
        let n = 2000;
        let t0 = std::time::Instant::now();
        for k in 0..n {
            std::hint::black_box(e.at(std::hint::black_box(i[8] + 1e-16 * k as f64)));
        }
        let us = t0.elapsed().as_secs_f64() / n as f64 * 1e6;
        let r = e.at(i[8]);
        let k = (s.pivot_inertia() / i[0]).sqrt();
        let uu = i[6].hypot(k * i[7]);
        let len = o[5].max(1e-300);
        let err = [
            (r.x - o[0]).hypot(r.y - o[1]) / len,
            (r.heading - o[2]).abs() / (o[2] - i[5]).abs().max(1e-300),
            (r.speed - o[3]).abs() / uu,
            (r.turn_rate / o[4] - 1.0).abs(),
        ];
        println!(
            "{us:6.2}us xy {:8.1e} th {:8.1e} u {:8.1e} w {:8.1e}  {}",
            err[0],
            err[1],
            err[2],
            err[3],
            &line[..line.find('|').unwrap()]
        );
        for j in 0..4 {
            worst[j] = worst[j].max(err[j]);
        }
    }
    println!("{worst:?}");
}
