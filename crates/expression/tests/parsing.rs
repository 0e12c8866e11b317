//! What is wrong with a text is said with its place and what would be right there; limits hold.

use crate::common::{built, names};
use expression::{Error, Graph, Limits, Names, nearest, parse, parse_within};

/// The message for a text, with the meanings of the names as variables.
fn message(text: &str) -> (Option<usize>, String) {
    let error = parse(text, &names()).and_then(|syntax| {
        let mut graph = Graph::new();
        let variables = crate::common::variables(&mut graph);
        graph.build(&syntax, &variables)
    });
    let error = error.map(|_| text.to_owned()).unwrap_err();
    (error.column(), error.to_string())
}

#[test]
fn errors_name_column_and_what_would_be_right() {
    const OPERAND: &str = "stands where a number, a name, a function or `(` is expected";
    let known = "the known names are `x`, `y`, `x'`, `mass`";
    for (text, column, expected) in [
        ("", 1, format!("the end of the text {OPERAND} (column 1)")),
        ("x + ", 5, format!("the end of the text {OPERAND} (column 5)")),
        ("x + * y", 5, format!("`*` {OPERAND} (column 5)")),
        ("(x + )", 6, format!("`)` {OPERAND} (column 6)")),
        ("sin()", 5, format!("`)` {OPERAND} (column 5)")),
        ("x + $y", 5, "`$` has no meaning here (column 5)".to_owned()),
        ("ξ·x", 1, format!("no name `ξ` is known here (column 1); {known}")),
        ("x·y", 2, "`·` has no meaning here (column 2)".to_owned()),
        ("m/2", 1, format!("no name `m` is known here (column 1); {known}")),
        ("x + masss^2", 5, "no name `masss` is known here (column 5); did you mean `mass`?".to_owned()),
        ("x + y'", 5, "no name `y'` is known here (column 5); did you mean `x'`?".to_owned()),
        ("si(x)", 1, "`si` is not a function (column 1); did you mean `sin`?".to_owned()),
        ("2*x(y + 1)", 3, "`x` is not a function (column 3)".to_owned()),
        ("sin x", 1, "`sin` is a function, and its argument follows in parentheses: `sin(..)` (column 1)".to_owned()),
        ("atan2(x)", 1, "`atan2` takes 2 arguments, not 1 (column 1)".to_owned()),
        ("1 + cos(x, y)", 5, "`cos` takes 1 argument, not 2 (column 5)".to_owned()),
        ("2x", 2, "the name `x` stands where an operator or the end of the text is expected (column 2)".to_owned()),
        ("(x y)", 4, "the name `y` stands where an operator or `)` is expected (column 4)".to_owned()),
        ("min(x y)", 7, "the name `y` stands where an operator or `,` or `)` is expected (column 7)".to_owned()),
        ("x, y", 2, "`,` stands where an operator or the end of the text is expected (column 2)".to_owned()),
        ("3*(x + (y)", 3, "the `(` in column 3 is never closed".to_owned()),
        ("sin(x", 4, "the `(` in column 4 is never closed".to_owned()),
        ("x + y)", 6, "this `)` closes nothing (column 6)".to_owned()),
        (
            "1.2.3",
            4,
            "the number `0.3` stands where an operator or the end of the text is expected (column 4)".to_owned(),
        ),
        ("x < y", 3, "a comparison is the condition of `if`, as in `if(x < 1, a, b)` (column 3)".to_owned()),
        ("if(x < y < 1, x, y)", 10, "a comparison is the condition of `if`".to_owned()),
        ("if(x, x > y, y)", 5, "the condition of `if` is a comparison".to_owned()),
        ("if(sin(x > 1), x, y)", 10, "a comparison is the condition of `if`".to_owned()),
        ("if(x > 1, x)", 1, "`if` takes 3 arguments, not 2 (column 1)".to_owned()),
        ("step(x, y)", 1, "`step` takes 1 argument, not 2 (column 1)".to_owned()),
        ("hypot(x)", 1, "`hypot` takes 2 arguments, not 1 (column 1)".to_owned()),
        ("x = y", 3, "`=` has no place here (column 3)".to_owned()),
        ("2e*x", 1, "`2e` is not a number (column 1)".to_owned()),
        (".", 1, "`.` is not a number (column 1)".to_owned()),
        ("x + 1e999", 5, "`1e999` is not a number (column 5)".to_owned()),
        ("x + y/(1 - 1)", 6, "this expression is inf for all values of the variables (column 6)".to_owned()),
        ("-(1e308*2*2)", 10, "this expression is inf for all values of the variables (column 10)".to_owned()),
        ("sin(1e308 + 1e308)", 11, "this expression is inf for all values of the variables (column 11)".to_owned()),
        ("x*log(-1)", 3, "this expression is NaN for all values of the variables (column 3)".to_owned()),
    ] {
        let (at, said) = message(text);
        assert_eq!(at, Some(column), "{text}: {said}");
        assert!(said.starts_with(&expected), "{text}: {said}");
    }
}

#[test]
fn names_of_every_kind() {
    let mut names = Names::new();
    for (k, name) in ["θ", "θ'", "_a1", "x_dot", "φ_2''"].into_iter().enumerate() {
        assert_eq!(names.add(name), Ok(k));
    }
    let steps = |text: &str| parse(text, &names).unwrap().names();
    assert_eq!(steps("θ + θ_dot*x' + _a1^2 - φ_2''"), [0, 1, 2, 3, 4]);
    assert_eq!(names.add("x'"), Err(Error::DuplicateName { name: "x'".to_owned() }));
    for name in ["", "1a", "a b", "x'y", "'", "a-b"] {
        assert_eq!(names.add(name), Err(Error::InvalidName { name: name.to_owned() }));
    }
    for name in ["sin", "pi", "ln", "max"] {
        assert_eq!(names.add(name), Err(Error::ReservedName { name: name.to_owned() }));
    }
    assert_eq!(names.all().len(), 5);
    assert_eq!(nearest("inertai", ["mass", "inertia"]), Some("inertia"));
    assert_eq!(nearest("z", ["x", "y"]), None);
    assert_eq!(nearest(&"m".repeat(1_000_000), ["mass"]), None);
}

#[test]
fn limits_hold_and_what_is_within_them_is_read() {
    let limits = Limits { length: 40, depth: 8, nodes: 12 };
    let read = |text: &str| parse_within(text, &names(), &limits).map(|_| ());
    assert_eq!(read(&format!("x{}", " ".repeat(39))), Ok(()));
    assert_eq!(read(&format!("x{}", " ".repeat(40))), Err(Error::TooLong { length: 41, limit: 40 }));
    // Characters are counted, not bytes.
    assert!(matches!(read(&"θ".repeat(40)), Err(Error::UnknownName { .. })));
    assert_eq!(read(&format!("{}x{}", "(".repeat(8), ")".repeat(8))), Ok(()));
    assert_eq!(read(&format!("{}x{}", "(".repeat(9), ")".repeat(9))), Err(Error::TooDeep { column: 9, limit: 8 }));
    assert_eq!(read(&format!("{}x", "-".repeat(9))), Err(Error::TooDeep { column: 9, limit: 8 }));
    assert_eq!(read(&"x^".repeat(9)), Err(Error::TooDeep { column: 18, limit: 8 }));
    assert_eq!(read("x+x+x+x+x+x"), Ok(()));
    assert_eq!(read("x+x+x+x+x+x+x"), Err(Error::TooManyNodes { column: 12, limit: 12 }));
}

/// What a graph has no room for is an error, not a wrong expression.
#[test]
fn a_full_graph_says_so() {
    let mut graph = Graph::with_limit(60);
    let mut e = built(&mut graph, "x*y + sin(x)");
    assert_eq!(graph.check(), Ok(()));
    for _ in 0..10 {
        let next = graph.derivative(e, 0);
        e = graph.product(&[e, next]);
    }
    let full = Err(Error::GraphFull { limit: 60 });
    assert_eq!(graph.check(), full);
    assert_eq!(expression::Tape::new(&graph, &[e]).map(|_| ()), full);
}
