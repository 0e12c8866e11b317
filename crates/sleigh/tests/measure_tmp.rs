#![allow(missing_docs)]
use sleigh::{Exact, Sleigh, SleighState};
#[test]
fn measure() {
    let mut worst = [0.0f64; 5];
    let mut n = 0;
    for line in std::fs::read_to_string("/tmp/rand_rows.txt").unwrap().lines().filter(|l| !l.starts_with('#')) {
        let Some((i, o)) = line.split_once('|') else { continue };
        let p = |s: &str| s.split_whitespace().map(|v| v.parse::<f64>().unwrap()).collect::<Vec<_>>();
        let (i, o) = (p(i), p(o));
        if o.len() < 6 {
            continue;
        }
        n += 1;
        let s = Sleigh::new(i[0], i[1], i[2]).unwrap();
        let st = SleighState { x: i[3], y: i[4], heading: i[5], speed: i[6], turn_rate: i[7] };
        let e = Exact::new(&s, &st).unwrap();
        let r = e.at(i[8]);
        let k = (s.pivot_inertia() / i[0]).sqrt();
        let uu = i[6].hypot(k * i[7]);
        let turn = (o[2] - i[5]).abs();
        let err = [
            (r.x - o[0]).hypot(r.y - o[1]) / o[5],
            (r.x - o[0]).hypot(r.y - o[1]) / o[5] / (1.0 + turn / 8.0),
            (r.heading - o[2]).abs() / (turn + i[5].abs()),
            (r.speed - o[3]).abs() / uu,
            (r.turn_rate / o[4] - 1.0).abs(),
        ];
        if err[1] > 1e-15 {
            println!("{err:8.1e?} {}", &line[..line.find('|').unwrap()]);
        }
        for j in 0..5 {
            worst[j] = worst[j].max(err[j]);
        }
    }
    println!("{n} {worst:8.1e?}");
}
