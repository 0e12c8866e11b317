//! Random expressions as text, and values for them.

use expression::{Expression, Graph, Names, Syntax, parse};
use lagrangian::Rounded;
use proptest::prelude::*;

pub const NAMES: [&str; 4] = ["x", "y", "x'", "mass"];

pub fn names() -> Names {
    Names::of(NAMES).unwrap()
}

pub fn read(text: &str) -> Syntax {
    parse(text, &names()).unwrap_or_else(|error| panic!("{text}: {error}"))
}

pub fn variables(graph: &mut Graph) -> Vec<Expression> {
    (0..NAMES.len() as u32).map(|k| graph.variable(k)).collect()
}

pub fn built(graph: &mut Graph, text: &str) -> Expression {
    let variables = variables(graph);
    graph.build(&read(text), &variables).unwrap_or_else(|error| panic!("{text}: {error}"))
}

pub fn text(graph: &Graph, e: Expression) -> String {
    graph.text(e, &names()).unwrap()
}

/// Ordinary values, and coinciding ones among them; zero too where no text divides by a variable.
pub fn values() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(prop_oneof![4 => 0.3..2.0, 4 => -2.0..-0.3, 1 => Just(1.0), 1 => Just(-0.5), 1 => Just(0.0)])
}

/// Values that have nothing in common: at the corner of `abs(x)^2`, simplified or not, dual numbers know other second derivatives.
pub fn off_corners() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(prop_oneof![0.3..2.0, -2.0..-0.3])
}

fn leaf() -> BoxedStrategy<String> {
    let variable = prop::sample::select(NAMES.to_vec()).prop_map(str::to_owned);
    let number = prop::sample::select(vec!["0", "1", "2", "3", "0.5", "1.5", ".1", "7.25", "1e-3", "pi", "1/3", "-1"]);
    prop_oneof![5 => variable, 2 => number.prop_map(|n| format!("({n})"))].boxed()
}

/// Texts with every operation and every function, each where it is smooth, and where rounding cannot carry it out of its domain:
/// so that a small error in an argument is a small one in the value.
pub fn expression() -> impl Strategy<Value = String> {
    leaf().prop_recursive(6, 48, 3, |inner| {
        let pair = (inner.clone(), inner.clone());
        let exponent = prop::sample::select(vec!["2", "3", "0", "1", "4", "5"]);
        let real = prop::sample::select(vec!["0.5", "-0.5", "1.5", "-1", "-2", "0.3", "-1.7", "(1/3)", "17"]);
        let divisor = prop_oneof![
            prop::sample::select(NAMES.to_vec()).prop_map(str::to_owned),
            inner.clone().prop_map(|a| format!("(({a})^2 + 1)")),
            (inner.clone(), leaf()).prop_map(|(a, b)| format!("({a}*({a}) + ({b})^2 + 0.5)")),
        ];
        let function = prop::sample::select(vec![
            "sin(A)",
            "cos(A)",
            "sin(-A)",
            "tan(0.3*sin(A))",
            "asin(0.9*sin(A))",
            "acos(0.9*cos(A))",
            "atan(A)",
            "sinh(sin(A))",
            "cosh(sin(A))",
            "tanh(A)",
            "exp(cos(A))",
            "log(2 + sin(A))",
            "ln(A^2 + 1)",
            "sqrt(A^2 + 1)",
            "sqrt(x^2 + 3*mass^2)",
            "(sqrt(y^2)^0.5*sqrt(A^2 + 1)^1.5*sqrt(A^2 + 1))",
            "inverse(A^2 + 1)",
            "abs(A)",
            "atan2(A, 1 + A^2)",
            "((A^2 + 1)^(x/2))",
            "(2^sin(A))",
            "(sin(A)^2 + cos(A)^2)",
            "hypot(A, 2)",
            "hypot(x, y, 1, 0.5)",
            "min(x, A, 2)",
            "step(x)*(A)",
            "floor(0.3*x + 7.7)*(A)",
            "mod(0.1*y + 5.5, 3)",
            "if(x < 0, A, y)",
            "if(y >= x - 0.1, sin(A), mass*A)",
            "if(0 <= x', sqrt(x'), A)",
            "if(x > 5, log(-1 - x^2), A)",
        ]);
        prop_oneof![
            3 => pair.clone().prop_map(|(a, b)| format!("({a} + {b})")),
            3 => pair.clone().prop_map(|(a, b)| format!("({a} - {b})")),
            3 => pair.clone().prop_map(|(a, b)| format!("{a}*{b}")),
            1 => (inner.clone(), divisor).prop_map(|(a, b)| format!("{a}/{b}")),
            1 => pair.clone().prop_map(|(a, b)| format!("min({a}, {b})")),
            1 => pair.prop_map(|(a, b)| format!("max({a}, {b})")),
            1 => inner.clone().prop_map(|a| format!("(-{a})")),
            2 => (inner.clone(), exponent).prop_map(|(a, n)| format!("(({a})^{n})")),
            1 => (inner.clone(), real).prop_map(|(a, p)| format!("((({a})^2 + 0.5)**{p})")),
            4 => (inner, function).prop_map(|(a, f)| f.replace('A', &format!("({a})"))),
        ]
    })
}

/// Whether two evaluations of one function agree to rounding, by the bounds that they carry with them; where the first has no value, or
/// one that is nothing but rounding, they do. Values are taken as rounded once, since what is
/// folded into constants counts nowhere in the second: at most as many roundings as the first has, and those of powers.
pub fn agree(a: Rounded, b: Rounded) -> bool {
    let unit = 0.5 * f64::EPSILON;
    let bound = 4.0 * (a.size + b.size) * unit + 1e-280;
    let blurred = a.size * unit > 1e-6 * a.value.abs().max(1.0);
    // Far out parts of it may be out of the range of numbers.
    let far = a.size > 1e60 || (a.size < 1e-60 && a.size > 0.0);
    a.value == b.value
        || !a.value.is_finite()
        || !a.size.is_finite()
        || blurred
        || far
        || (a.value - b.value).abs() <= bound
}
