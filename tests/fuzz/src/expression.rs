//! Any bytes: they are an expression, or an error that says where; an expression comes back from its own text, and is differentiated
//! and evaluated within the limits.

#![no_main]

use expression::{Error, Graph, Names, Tape, parse};
use libfuzzer_sys::fuzz_target;

fn run(text: &str, names: &Names) -> Result<(), Error> {
    let syntax = parse(text, names)?;
    let mut graph = Graph::with_limit(1 << 18);
    let variables: Vec<_> = (0..4).map(|k| graph.variable(k)).collect();
    let e = graph.build(&syntax, &variables)?;
    let mut outputs = vec![e];
    outputs.extend(graph.gradient(e, &[0, 1, 2, 3]));
    outputs.extend(graph.hessian(e, &[0, 1], &[0, 1]).concat());
    let tape = Tape::new(&graph, &outputs)?;
    let (mut scratch, mut values) = (vec![0.0; tape.scratch()], vec![0.0; tape.outputs()]);
    tape.evaluate(&[0.5, 1.5, -0.5, 2.0], &mut scratch, &mut values)?;
    let printed = graph.text(e, names)?;
    if printed.len() < 1 << 12 {
        // Deep texts of short ones may be beyond the limits.
        match parse(&printed, names).and_then(|again| graph.build(&again, &variables)) {
            Ok(_) | Err(Error::TooDeep { .. } | Error::GraphFull { .. }) => {}
            Err(error) => panic!("{printed}: {error}"),
        }
    }
    Ok(())
}

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let names = Names::of(["x", "y", "x'", "θ"]).expect("these are names");
    if let Err(error) = run(text, &names) {
        assert!(!error.to_string().is_empty());
        assert!(error.column().is_none_or(|column| column <= text.chars().count() + 1), "{error}");
    }
});
