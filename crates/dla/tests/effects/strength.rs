//! An effect of no strength does nothing; one of some strength does.

use crate::effects::balance::sine;
use crate::effects::tools::{laden, moving, run, sleigh, steps};
use dla::Dla;
use scene::AnyEffect;
use sleigh::effects::{Bowl, Drag, EggCrate, Hill, Hills, MovingMass, Slope, Thrust, Torque};
use sleigh::{Guided, Table, TimeFunction};

/// Every effect that acts, with its strength in proportion to `k`.
fn effects(k: f64) -> Vec<(&'static str, AnyEffect)> {
    let table = TimeFunction::Table(Table::new(vec![0.0, 1.0], vec![k, -2.0 * k]).unwrap());
    let hill = Hill { height: k, x: 0.5, y: 0.5, width: 0.7 };
    vec![
        ("slope", AnyEffect::Slope(Slope::new([k, 2.0 * k]).unwrap())),
        ("bowl", AnyEffect::Bowl(Bowl::new([k, 2.0 * k], [0.3, 0.1]).unwrap())),
        ("egg_crate", AnyEffect::EggCrate(EggCrate::new(k, [1.0, 2.0]).unwrap())),
        ("hills", AnyEffect::Hills(Hills::new(vec![hill, hill]).unwrap())),
        ("drag", AnyEffect::Drag(Drag::new(k, 2.0 * k).unwrap())),
        ("thrust", AnyEffect::Thrust(Thrust::new(sine(k, 1.0, 0.3)).unwrap())),
        ("torque", AnyEffect::Torque(Torque::new(table).unwrap())),
    ]
}

#[test]
fn no_strength_is_no_effect() {
    let count = 100;
    let end = |effects: Vec<AnyEffect>| {
        let mut method = Dla::midpoint();
        run(&laden(sleigh(), effects), &mut method, &steps(0.05, count), moving().to_coordinates(), ()).unwrapped()
    };
    let free = end(vec![]);
    let off = |q: [f64; 3], free: [f64; 3]| (0..3).map(|i| (q[i] - free[i]).abs()).fold(0.0, f64::max);
    // Each step may round differently, in the last digits of coordinates below 4.
    let rounding = 16.0 * f64::EPSILON * count as f64;
    for ((name, none), (_, some)) in effects(0.0).into_iter().zip(effects(0.1)) {
        let (none, some) = (off(end(vec![none]), free), off(end(vec![some]), free));
        println!("{name}: {none:.1e} and {some:.1e}");
        assert!(none <= rounding && some > 1e-2, "{name}: {none:e} and {some:e}");
    }

    let guided = |body: Guided<0>| {
        let mut method = Dla::midpoint();
        run(&laden(body, vec![]), &mut method, &steps(0.05, count), moving().to_coordinates(), ()).unwrapped()
    };
    let on = |rate| guided(Guided::turntable(sleigh(), rate).unwrap());
    assert!(off(on(0.0), free) <= rounding && off(on(0.1), free) > 1e-2);
    // A mass must be positive; the smallest has no effect on a double.
    let with =
        |mass| guided(Guided::from(sleigh()).carrying(vec![MovingMass::new(mass, sine(0.3, 2.0, 0.0), 0.2).unwrap()]));
    assert!(off(with(f64::MIN_POSITIVE), free) <= rounding && off(with(0.1), free) > 1e-2);
}
