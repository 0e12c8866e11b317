//! Texts that mean harm: an error or a result, within limits, and never a panic.

use crate::common::names;
use expression::{Error, Graph, Tape, parse};
use proptest::prelude::*;

/// All that is done with a text: derivatives, a tape, Rust and text again.
fn everything(text: &str) -> Result<(), Error> {
    let syntax = parse(text, &names())?;
    let mut graph = Graph::with_limit(1 << 20);
    let variables = crate::common::variables(&mut graph);
    let e = graph.build(&syntax, &variables)?;
    let mut outputs = vec![e];
    outputs.extend(graph.gradient(e, &[0, 1, 2]));
    outputs.extend(graph.hessian(e, &[0], &[0, 2]).concat());
    let tape = Tape::new(&graph, &outputs)?;
    let (mut scratch, mut values) = (vec![0.0; tape.scratch()], vec![0.0; tape.outputs()]);
    tape.evaluate(&[0.5, 1.5, -0.5, 2.0], &mut scratch, &mut values)?;
    syntax.evaluate(&[0.5, 1.5, -0.5, 2.0])?;
    graph.text(e, &names()).map(|_| ())
}

/// The error of a text that has one, in a sentence that says something.
fn survives(text: &str) {
    if let Err(error) = everything(text) {
        let said = error.to_string();
        assert!(!said.is_empty() && said.len() < 1000, "{said}");
        if let Some(column) = error.column() {
            assert!(column >= 1 && column <= text.chars().count() + 1, "{said}");
        }
    }
}

/// Words of expressions in any order.
fn words() -> impl Strategy<Value = String> {
    let words = prop::sample::select(vec![
        "x", "y", "x'", "mass", "pi", "sin", "cos", "atan2", "min", "sqrt", "abs", "sign", "log", "exp", "tanh", "(",
        ")", "(", ")", ",", "+", "-", "*", "/", "^", "**", "0", "1", "2", "0.5", "1e300", "1e-300", "1e308", "3", "θ",
        "'", ".", "e", " ", "x_dot",
    ]);
    prop::collection::vec(words, 0..24).prop_map(|words| words.concat())
}

/// Words that are more often right than wrong.
fn sentences() -> impl Strategy<Value = String> {
    let operand = prop::sample::select(vec![
        "x",
        "y",
        "x'",
        "(x)",
        "sin(x)",
        "cos(y)",
        "2",
        "0",
        "0.5",
        "1e300",
        "1e-300",
        "(x+y)",
        "(x-y)",
        "sqrt(x)",
        "-x",
        "--y",
        "(1-1)",
        "log(x)",
        "min(x,y)",
        "atan2(y,x)",
        "mass",
        "3",
        "16",
        "1e9",
        "(x*y)",
        "abs(x)",
        "sign(y)",
        "(2*x)",
        "exp(x)",
        "1e-320",
        "tan(x)",
        "sqrt(x)^1.5",
    ]);
    let operator = prop::sample::select(vec!["+", "-", "*", "/", "^", "**", "*", "+"]);
    prop::collection::vec((operand, operator, 0..4_usize), 1..16).prop_map(|words| {
        let mut text = String::new();
        let mut open = 0;
        for (operand, operator, parentheses) in words {
            if parentheses == 3 {
                text.push('(');
                open += 1;
            }
            text.push_str(operand);
            if parentheses == 2 && open > 0 {
                text.push(')');
                open -= 1;
            }
            text.push_str(operator);
        }
        text.push('x');
        text + &")".repeat(open)
    })
}

fn bytes() -> impl Strategy<Value = String> {
    prop::collection::vec(any::<u8>(), 0..64).prop_map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]
    #[test]
    fn any_text_ends(text in prop_oneof![words(), sentences(), bytes()]) {
        survives(&text);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000_000))]
    #[test]
    #[ignore = "slow"]
    fn a_million_texts_end(text in prop_oneof![words(), sentences(), bytes()]) {
        survives(&text);
    }
}

#[test]
fn deep_texts() {
    deep(&[100, 300, 10_000]);
    assert!(matches!(everything(&"(".repeat(300)), Err(Error::TooDeep { column: 257, .. })));
    assert_eq!(everything(&format!("{}x{}", "sin(".repeat(200), ")".repeat(200))), Ok(()));
}

#[test]
#[ignore = "slow"]
fn deep_texts_in_full() {
    deep(&[100, 300, 100_000]);
}

fn deep(depths: &[usize]) {
    for &n in depths {
        let (open, close) = ("(".repeat(n), ")".repeat(n));
        for text in [
            format!("{open}x{close}"),
            format!("{open}x"),
            format!("x{close}"),
            format!("{}x", "-".repeat(n)),
            format!("{}x", "+".repeat(n)),
            format!("x{}", "^x".repeat(n)),
            format!("x{}", "^2".repeat(n)),
            format!("{}x{close}", "sin(".repeat(n)),
            format!("{}x{close}", "sqrt(y*".repeat(n)),
            format!("{}x{close}", "2^(".repeat(n)),
            format!("{}x{close}", "(x+1)*(y-".repeat(n)),
            format!("{}x{close}", "x/(1+".repeat(n)),
            format!("{}x{}", "min(y,".repeat(n), close),
        ] {
            survives(&text);
        }
    }
}

#[test]
fn long_texts() {
    long(100_000);
}

#[test]
#[ignore = "slow"]
fn texts_that_are_nearly_too_long() {
    long(500);
}

/// Texts of `n` terms, and one that is longer than a text may be.
fn long(n: usize) {
    let many = |term: &dyn Fn(usize) -> String| (0..n).map(term).collect::<Vec<_>>();
    assert_eq!(everything(&many(&|_| "x".to_owned()).join("+")), Ok(()));
    assert_eq!(everything(&many(&|_| "x".to_owned()).join("*")), Ok(()));
    assert_eq!(everything(&many(&|_| "x".to_owned()).join("/")), Ok(()));
    for text in [
        many(&|k| format!("{k}*x")).join("+"),
        many(&|k| format!("(x+{k})")).join("*"),
        many(&|k| format!("sin({k}*x)")).join("+"),
        many(&|k| format!("sin(x+{k})")).join("*"),
        many(&|k| format!("cos(y)^{k}")).join("-"),
        many(&|k| format!("x^{k}")).join("/"),
        many(&|k| format!("(x-{k}*y)")).join("*"),
        "x".repeat(n),
        "1".repeat(n),
        "x ".repeat(n),
        "θ".repeat(2_000_000),
    ] {
        survives(&text);
    }
}

/// What a fuzzer has found.
#[test]
fn texts_that_have_failed() {
    for text in [
        // A constant out of range, which was none.
        "-(1e308*2*2)",
        "-(1e308 + 1e308) + x",
        // The root of x for itself and in the power of a root: a factor that stood there twice.
        "sqrt(x)*sqrt(x)^1.5 + sqrt(x)*sqrt(x)^1.5*y - mass*sqrt(x)^1.5/sqrt(x)^1.75*sqrt(x)",
        "(x -  y^-0^00)^20e30^y/sqrt(x^x + 9.^2)^510e30^y/sqrt(x^x + 1^y)^log(x -  y^-0^00)^20e30/y/sqrt(x^x + 5.^2)^510e30^y/sqrt(x)^0.5",
    ] {
        survives(text);
    }
}

#[test]
fn abbreviations_of_abbreviations() {
    abbreviated(1 << 12, 200);
}

#[test]
#[ignore = "slow"]
fn abbreviations_of_abbreviations_at_length() {
    abbreviated(1 << 18, 2000);
}

/// Abbreviations of abbreviations: each is small, and together they would be sums of sums without end.
fn abbreviated(limit: usize, depth: u32) {
    for source in
        ["mass + y*x", "mass*(y + x)", "mass - sin(mass + x)", "mass^2 + mass", "sqrt(mass*x + 1)", "(mass + x)^2*mass"]
    {
        let syntax = crate::common::read(source);
        let mut graph = Graph::with_limit(limit);
        let mut meanings = crate::common::variables(&mut graph);
        let mut built = Ok(meanings[3]);
        for k in 0..depth {
            built = graph.build(&syntax, &meanings);
            let Ok(e) = built else { break };
            meanings[3] = e;
            meanings[0] = graph.variable(4 + k);
        }
        if let Ok(e) = built {
            let outputs = graph.gradient(e, &[1, 4, depth / 2]);
            let _ = Tape::new(&graph, &outputs);
            let _ = graph.text(e, &names());
        }
    }
}
