#![allow(clippy::unwrap_used)]

use crate::{expand, read};

/// The error of the macro for a text, and the piece of text at whose place it is.
fn wrong(text: &str) -> (String, String) {
    let text = format!("::lagrangian; {text}");
    let error = syn::parse_str::<read::Described>(&text).and_then(|described| expand::system(&described)).unwrap_err();
    let (from, to) = (error.span().start(), error.span().end());
    let line = text.lines().nth(from.line - 1).unwrap();
    let to = if to.line == from.line { to.column } else { from.column + 1 };
    (error.to_string(), line.chars().take(to).skip(from.column).collect())
}

/// A system with one thing in it replaced.
fn changed(from: &str, to: &str) -> (String, String) {
    let text = r#"struct Skate;
        coordinates = { x = "m", y = "m", theta = "angle" }
        parameters = { m = 1.0, J = 0.5 }
        let = { c = "cos(theta)", s = "sin(theta)" }
        lagrangian = "m/2*(x'^2 + y'^2) + J/2*theta'^2"
        constraints = ["y'*c - x'*s"]
        forces = { theta = "-0.1*theta'" }
        basis = [["c", "s", "0"], ["0", "0", "1"]]
        outputs = { speed = "x'*c + y'*s" }"#;
    assert!(text.contains(from));
    wrong(&text.replace(from, to))
}

/// Each mistake is told at the text that is wrong.
#[test]
fn errors_stand_at_their_places() {
    let cases = [
        ("J/2*theta'^2", "J/2*thetta'^2", "did you mean `theta'`", "\"m/2*(x'^2 + y'^2) + J/2*thetta'^2\""),
        ("y'*c - x'*s", "y'*x' - x'*s", "not affine", "\"y'*x' - x'*s\""),
        ("-0.1*theta'", "-0.1*theta", "the angle `theta` grows by a whole turn", "\"-0.1*theta\""),
        ("-0.1*theta'", "-0.1*theta' +", "column 14", "\"-0.1*theta' +\""),
        ("theta = \"-0.1", "phi = \"-0.1", "the coordinates are", "\"-0.1*theta'\""),
        ("cos(theta)", "cos(thet)", "no name `thet`", "\"cos(thet)\""),
        ("[\"c\", \"s\", \"0\"]", "[\"c\", \"s\"]", "a component for each", "["),
        ("\"s\", \"0\"]", "\"s\", \"x'\"]", "no name `x'`", "\"x'\""),
        ("outputs = { speed", "outputs = { energy", "names another column", "\"x'*c + y'*s\""),
        ("m = 1.0", "m = \"1\"", "is a number", "\"1\""),
        ("m = 1.0", "x = 1.0", "defined already", "x"),
        ("constraints", "constraint", "did you mean `constraints`?", "constraint"),
        ("forces", "let", "is given twice", "let"),
        ("coordinates", "outputs", "is given twice", "outputs"),
        ("struct Skate", "enum Skate", "expected `struct`", "enum"),
    ];
    for (from, to, message, place) in cases {
        let (told, at) = changed(from, to);
        assert!(told.contains(message), "{to}: {told}");
        assert_eq!(at, place, "{to}: {told}");
    }
    assert!(wrong("struct Nothing;").0.contains("needs `coordinates`"));
}

/// Where no basis is seen that holds everywhere, there are no reduced equations; the system is one for all that.
#[test]
fn a_basis_is_not_invented() {
    let system = |constraint: &str| {
        let text = format!(
            "::lagrangian; struct Point; coordinates = {{ x = \"m\", y = \"m\" }}
            lagrangian = \"x'^2 + y'^2\" constraints = [\"{constraint}\"]"
        );
        let described = syn::parse_str::<read::Described>(&text).unwrap();
        expand::system(&described).unwrap().to_string()
    };
    assert!(system("x' - y*y'").contains("reduced_motion"));
    assert!(!system("x*x' - y*y'").contains("reduced_motion"));
}
