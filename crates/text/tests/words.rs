//! What texts mean, and what is wrong with them.

use proptest::prelude::*;
use text::{Entry, Problem, StartError, TextModel, Unit, Words};

/// A skate on a slope.
fn skate() -> Words {
    let named = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    };
    Words {
        coordinates: vec![
            ("x".to_owned(), Unit::other("m")),
            ("y".to_owned(), Unit::other("m")),
            ("theta".to_owned(), Unit::Angle),
        ],
        parameters: vec![("m".to_owned(), 2.0), ("J".to_owned(), 0.5)],
        abbreviations: named(&[
            ("c", "cos(theta)"),
            ("s", "sin(theta)"),
            ("speed", "x'*c + y'*s"),
            ("way", "sign(speed)"),
        ]),
        lagrangian: "m/2*(x'^2 + y'^2) + J/2*theta'^2 - m*x".to_owned(),
        constraints: vec!["y'*c - x'*s".to_owned()],
        forces: named(&[("theta", "-0.1*way*theta_dot")]),
        outputs: named(&[("v", "speed"), ("where", "sign(x)")]),
        ..Words::default()
    }
}

/// The entry, the column and the words of the error once the system was changed.
fn wrong(change: impl FnOnce(&mut Words)) -> (Entry, Option<usize>, String) {
    let mut words = skate();
    change(&mut words);
    let error = TextModel::new(&words).expect_err("the text is wrong");
    (error.entry, error.column(), error.to_string())
}

#[test]
fn a_system_is_what_its_texts_say() {
    let model = TextModel::new(&skate()).unwrap();
    let (q, v) = ([0.5, 0.0, 0.0], [3.0, 0.0, 2.0]);
    assert_eq!(model.energy(0.0, &q, &v), 9.0 + 1.0 + 1.0);
    assert_eq!(model.told(0.0, &q, &v), [3.0, 1.0]);
    assert!(model.has_forces() && !model.gives_basis() && !model.depends_on_time());
    assert_eq!(TextModel::new(&skate()).unwrap(), model);
}

#[test]
fn errors_name_the_text_and_the_column() {
    type Case = (fn(&mut Words), Entry, Option<usize>, &'static str);
    let cases: [Case; 22] = [
        (|w| w.coordinates.clear(), Entry::System, None, "at least one coordinate"),
        (|w| w.coordinates[1].0 = "x_dot".to_owned(), Entry::Coordinate(1), None, "is the rate of `x`"),
        (|w| w.coordinates[1].0 = "t".to_owned(), Entry::Coordinate(1), None, "`t` is time"),
        (|w| w.coordinates[1].0 = "sin".to_owned(), Entry::Coordinate(1), None, "has a meaning in every expression"),
        (|w| w.coordinates[1].0 = "energy".to_owned(), Entry::Coordinate(1), None, "names another column"),
        (|w| w.parameters[1].1 = f64::NAN, Entry::Parameter(1), None, "finite"),
        (|w| w.parameters[1].0 = "x".to_owned(), Entry::Parameter(1), None, "defined already"),
        (|w| w.abbreviations[1].1 = "sin(thet)".to_owned(), Entry::Abbreviation(1), Some(5), "did you mean `theta`"),
        (|w| w.abbreviations[0].1 = "s".to_owned(), Entry::Abbreviation(0), Some(1), "no name `s` is known"),
        (
            |w| w.lagrangian = "m/2*x'^2 + sign(x)".to_owned(),
            Entry::Lagrangian,
            Some(12),
            "jump, and are accepted only in forces",
        ),
        (|w| w.lagrangian += " + way", Entry::Lagrangian, Some(42), "no name `way` is known"),
        (
            |w| w.lagrangian = "x'^2 + y'^2".to_owned(),
            Entry::Lagrangian,
            None,
            "the Lagrangian does not contain the rate `theta'`",
        ),
        (|w| w.constraints[0] = "x'*y'".to_owned(), Entry::Constraint(0), None, "the factor of `x'` contains `y'`"),
        (|w| w.constraints[0] = "x - 1".to_owned(), Entry::Constraint(0), None, "belongs in `positions`"),
        (|w| w.positions = vec!["x - y'".to_owned()], Entry::Position(0), Some(5), "no name `y'` is known"),
        (
            |w| w.constraints[0] = "x' = y' = 0".to_owned(),
            Entry::Constraint(0),
            Some(9),
            "one equation, `left = right`",
        ),
        (|w| w.constraints[0] = "x'*(s = c)".to_owned(), Entry::Constraint(0), Some(7), "one equation, `left = right`"),
        (|w| w.lagrangian += " = 0", Entry::Lagrangian, Some(40), "`left - (right)`"),
        (|w| w.outputs[0].1 = "speed'".to_owned(), Entry::Output(0), Some(1), "its rate would contain accelerations"),
        (|w| w.outputs[0].1 = "2*way_dot".to_owned(), Entry::Output(0), Some(3), "the abbreviation `way` jumps"),
        (|w| w.forces[0].0 = "phi".to_owned(), Entry::Force(0), None, "the coordinates are `x`, `y`, `theta`"),
        (|w| w.outputs[0].0 = "x'".to_owned(), Entry::Output(0), None, "names another column"),
    ];
    for (change, entry, column, words) in cases {
        let (found, at, told) = wrong(change);
        assert_eq!((found, at), (entry, column), "{told}");
        assert!(told.contains(words), "{told}");
    }
}

#[test]
fn an_equation_is_its_left_side_less_its_right_one() {
    let mut words = skate();
    words.constraints[0] = "y'*c = x'*s + 2*t".to_owned();
    words.positions = vec!["x = y - 1 - (t - 2)".to_owned()];
    let mut formulas = skate();
    formulas.constraints[0] = "y'*c - (x'*s + 2*t)".to_owned();
    formulas.positions = vec!["x - (y - 1 - (t - 2))".to_owned()];
    assert_eq!(TextModel::new(&words).unwrap(), TextModel::new(&formulas).unwrap());
    formulas.positions = vec!["x - y - 1 - (t - 2)".to_owned()];
    assert_ne!(TextModel::new(&words).unwrap(), TextModel::new(&formulas).unwrap());
}

/// A bob on a skate, by the rates of its place and by what these are.
#[test]
fn an_abbreviation_has_a_rate() {
    let mut words = skate();
    let place = [("bob_x", "x + 2*c*sin(t)"), ("bob_y", "y + 2*s*sin(t)"), ("lift", "bob_x'*bob_y_dot")];
    words.abbreviations.extend(place.map(|(name, text)| (name.to_owned(), text.to_owned())));
    words.lagrangian += " + (bob_x'^2 + bob_y'^2)/2";
    words.forces.push(("x".to_owned(), "-lift".to_owned()));
    let mut by_hand = words.clone();
    by_hand.abbreviations.truncate(4);
    let rates = [
        ("bx", "x' - 2*s*theta'*sin(t) + 2*c*cos(t)"),
        ("by", "y' + 2*c*theta'*sin(t) + 2*s*cos(t)"),
        ("lift", "bx*by"),
    ];
    by_hand.abbreviations.extend(rates.map(|(name, text)| (name.to_owned(), text.to_owned())));
    by_hand.lagrangian = by_hand.lagrangian.replace("bob_x'", "bx").replace("bob_y'", "by");
    for words in [&mut words, &mut by_hand] {
        words.outputs.push(("lift".to_owned(), "lift".to_owned()));
    }
    let [one, other] = [words, by_hand.clone()].map(|words| TextModel::new(&words).unwrap());
    let (t, q, v) = (0.4, [0.3, -0.2, 0.7], [1.1, 0.5, -0.9]);
    let pairs = [(one.energy(t, &q, &v), other.energy(t, &q, &v)), (one.told(t, &q, &v)[2], other.told(t, &q, &v)[2])];
    for (x, y) in pairs {
        assert!((x - y).abs() < 1e-14 * y.abs(), "{x}, {y}");
    }
    // A name that is given keeps its meaning.
    by_hand.abbreviations.push(("c'".to_owned(), "7*x'".to_owned()));
    by_hand.outputs.push(("given".to_owned(), "c'".to_owned()));
    assert_eq!(TextModel::new(&by_hand).unwrap().told(t, &q, &v).last(), Some(&(7.0 * v[0])));
}

#[test]
fn bases_have_their_shape() {
    let vector = |text: &str| vec![text.to_owned(); 3];
    assert_eq!(wrong(|w| w.basis = vec![vector("0")]).0, Entry::Basis);
    assert_eq!(wrong(|w| w.basis = vec![vector("0"), vec!["1".to_owned()]]).0, Entry::Vector(1));
    assert_eq!(wrong(|w| w.basis = vec![vector("0"), vector("x'")]).0, Entry::Component(1, 0));
    // That vectors are admissible is seen at the start.
    let mut words = skate();
    words.basis = vec![vector("1"), vector("0")];
    let error = TextModel::new(&words).unwrap().start(&[None; 3], &[None; 3]).unwrap_err();
    assert!(matches!(error, StartError::Basis { vector: 0, constraint: 0, .. }), "{error}");
}

/// An angle is the same after a turn, and so are all results but the ones told.
#[test]
fn formulas_have_the_period_of_their_angles() {
    type Case = (fn(&mut Words), Option<Entry>);
    let cases: [Case; 22] = [
        (|w| w.lagrangian += " - theta^2/2", Some(Entry::Lagrangian)),
        (|w| w.lagrangian += " - max(0, abs(theta) - 40)^2", Some(Entry::Lagrangian)),
        (|w| w.lagrangian += " - sin(theta/2)", Some(Entry::Lagrangian)),
        (|w| w.lagrangian += " - 1e-9*cos(0.9999*theta)^2", Some(Entry::Lagrangian)),
        (|w| w.abbreviations[0].1 = "cos(1.5*theta)".to_owned(), Some(Entry::Constraint(0))),
        (|w| w.constraints[0] = "y'*c - x'*s + 1e-6*theta*x'".to_owned(), Some(Entry::Constraint(0))),
        (|w| w.positions.push("theta - 2*t".to_owned()), Some(Entry::Position(0))),
        (|w| w.positions.push("x - 0.3*theta".to_owned()), Some(Entry::Position(0))),
        (|w| w.forces[0].1 = "-200*theta".to_owned(), Some(Entry::Force(0))),
        (|w| w.forces[0].1 = "-way*sign(theta)".to_owned(), Some(Entry::Force(0))),
        (|w| w.forces[0].1 = "sin(theta)*theta".to_owned(), Some(Entry::Force(0))),
        (|w| w.forces[0].1 = "exp(-x^2 - theta^2)".to_owned(), Some(Entry::Force(0))),
        (
            |w| w.basis = [["c", "s", "0"], ["0", "0", "1 + theta^2"]].map(|v| v.map(str::to_owned).to_vec()).to_vec(),
            Some(Entry::Component(1, 2)),
        ),
        // The same after a turn.
        (|w| w.lagrangian += " - sin(theta/2)^2 + abs(sin(theta/2)) + sqrt(1 - cos(theta))", None),
        (|w| w.lagrangian += " - sin(theta/2)*cos(theta/2) - m*cos(2*theta - x)", None),
        (|w| w.lagrangian += " + (theta - x - theta)^2 + cos(3*(m/3)*theta)", None),
        (|w| w.lagrangian += " + atan2(s, c)^2 + 0.1*theta'^4", None),
        (|w| w.lagrangian += " + x*cos(theta + 100*x)*tan(theta/2)^2/(1 + tan(theta/2)^2)", None),
        (|w| w.constraints[0] = "x' - 0.3*theta'".to_owned(), None),
        (|w| w.forces[0].1 = "-sin(theta - 0.3*sin(theta)) + log(x + theta - theta)".to_owned(), None),
        // What is told counts turns, as the column of the angle.
        (|w| w.outputs[0].1 = "theta/(2*pi)".to_owned(), None),
        (|w| (w.coordinates[2].1, w.lagrangian) = (Unit::other("rad"), format!("{} - theta^2/2", w.lagrangian)), None),
    ];
    for (k, (change, entry)) in cases.into_iter().enumerate() {
        let mut words = skate();
        change(&mut words);
        let found = TextModel::new(&words).map(|_| ());
        let named = found.as_ref().err().map(|error| error.entry);
        assert_eq!(named, entry, "{k}: {found:?}");
        if let Err(error) = found {
            assert_eq!(error.problem, Problem::NoPeriod { angle: "theta".to_owned() });
        }
    }
    let mut words = skate();
    words.forces[0].1 = "-theta".to_owned();
    let error = TextModel::new(&words).unwrap_err().to_string();
    assert!(error.contains("`theta`") && error.contains("`rad`") && error.contains("force 1"), "{error}");
}

/// Names and units stand in the first line of files.
#[test]
fn names_and_units_fit_the_head_of_a_file() {
    for name in ["=1+1", "+x", "-x", "@x", "a,b", "a\"b", "a\nb", "\u{1b}[31m", "\u{202e}x", ""] {
        let (entry, _, told) = wrong(|w| w.outputs[1].0 = name.to_owned());
        assert_eq!(entry, Entry::Output(1), "{told}");
    }
    for unit in ["m\ns", "m\u{7}", "\u{2028}"] {
        let (entry, _, told) = wrong(|w| w.coordinates[1].1 = Unit::other(unit));
        assert_eq!(entry, Entry::Coordinate(1), "{told}");
    }
    let mut words = skate();
    words.outputs[0].0 = "speed of the blade (m/s)".to_owned();
    words.coordinates[0].1 = Unit::other("m, to the east");
    assert!(TextModel::new(&words).is_ok());
}

/// A coordinate without inertia needs a row of its own that says how it moves.
#[test]
fn constraints_may_determine_what_has_no_inertia() {
    let cases: [(&str, &[&str], bool); 5] = [
        ("(x'^2 + y'^2)/2", &["theta' - x"], true),
        ("(x'^2 + y'^2)/2", &["y' - x'"], false),
        ("x'^2/2", &["theta' - y'", "y' - 2*x'"], true),
        ("x'^2/2", &["theta' - y'"], false),
        ("x'^2/2", &["theta' - y'", "y' - theta'", "x' - 1"], true),
    ];
    for (lagrangian, constraints, accepted) in cases {
        let mut words = skate();
        words.lagrangian = lagrangian.to_owned();
        words.constraints = constraints.iter().map(|&text| text.to_owned()).collect();
        let found = TextModel::new(&words).map(|_| ());
        assert_eq!(found.is_ok(), accepted, "{constraints:?}: {found:?}");
    }
}

#[test]
fn rates_that_are_left_out_follow_those_that_are_given() {
    let model = TextModel::new(&skate()).unwrap();
    let start = model.start(&[None, None, Some(0.5)], &[Some(1.0), None, Some(2.0)]).unwrap();
    assert!((start.v[1] - 0.5f64.tan()).abs() < 1e-15 && start.v[0] == 1.0 && start.v[2] == 2.0);
    assert!(start.moved.is_empty());
    // Given across the blade, the velocity is what of it lies along the blade.
    let start = model.start(&[None, None, Some(0.0)], &[Some(1.0), Some(0.5), None]).unwrap();
    assert!((start.v[0] - 1.0).abs() < 1e-15 && start.v[1].abs() < 1e-15);
    assert_eq!(start.moved.iter().map(|moved| moved.name.as_str()).collect::<Vec<_>>(), ["y'"]);
}

#[test]
fn coordinates_that_are_left_out_meet_the_constraints_on_positions() {
    let mut words = skate();
    words.positions = vec!["x^2 + y^2 - 1".to_owned()];
    let model = TextModel::new(&words).unwrap();
    let start = model.start(&[Some(0.6), None, Some(0.0)], &[None; 3]);
    // From zero there is no way along `y`, and then all move.
    let start = start.unwrap();
    assert!((start.q[0].hypot(start.q[1]) - 1.0).abs() < 1e-14);
    words.positions = vec!["x^2 + y^2 + 1".to_owned()];
    let model = TextModel::new(&words).unwrap();
    assert!(matches!(model.start(&[Some(0.6), None, None], &[None; 3]), Err(StartError::Positions { .. })));
}

#[test]
fn a_start_where_a_formula_is_no_number_is_refused() {
    let mut words = skate();
    words.lagrangian += " - log(x)";
    let error = TextModel::new(&words).unwrap().start(&[None; 3], &[None; 3]).unwrap_err();
    assert!(matches!(error, StartError::NotFinite { .. }), "{error}");
}

/// Growth vectors of the literature.
#[test]
fn brackets_of_admissible_directions_grow() {
    let growth = |words: &Words, q: &[f64]| {
        let model = TextModel::new(words).unwrap();
        let given: Vec<Option<f64>> = q.iter().map(|x| Some(*x)).collect();
        let geometry = model.geometry(&model.start(&given, &vec![None; q.len()]).unwrap());
        (geometry.rank, geometry.growth)
    };
    assert_eq!(growth(&skate(), &[0.0, 0.0, 0.3]), (1, vec![2, 3]));
    let mut held = skate();
    held.constraints = vec!["x' - y'".to_owned()];
    assert_eq!(growth(&held, &[0.0; 3]), (1, vec![2, 2]));
    held.constraints = vec!["x'*c - y'*c".to_owned(), "2*x' - 2*y'".to_owned()];
    assert_eq!(growth(&held, &[0.0; 3]).0, 1);
}

/// Words of formulas and of other things, in any order.
fn formula() -> impl Strategy<Value = String> {
    let part = prop::sample::select(vec![
        "x",
        "y'",
        "theta",
        "theta_dot",
        "m",
        "c",
        "speed",
        "(",
        ")",
        "+",
        "-",
        "*",
        "/",
        "^",
        "2",
        "1e308",
        "sin(",
        "sqrt(",
        "sign(",
        "atan2(",
        ",",
        "t",
        "é",
        "'",
        "",
        " ",
        "log(",
        "0",
        "**",
        "x''",
    ]);
    prop::collection::vec(part, 0..24).prop_map(|parts| parts.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever stands there, it is a model, or an error at a place within its text.
    #[test]
    fn no_text_panics(texts in prop::collection::vec(formula(), 6), names in prop::collection::vec("[a-z'_é0-9]{0,6}", 3)) {
        let mut words = skate();
        words.coordinates[1].0.clone_from(&names[0]);
        words.parameters[0].0.clone_from(&names[1]);
        words.abbreviations[0] = (names[2].clone(), texts[0].clone());
        prop_assert!(TextModel::new(&words).is_ok() || TextModel::new(&words).is_err());
        let mut words = skate();
        words.lagrangian = format!("{} + {}", words.lagrangian, texts[1]);
        words.constraints.push(texts[2].clone());
        words.positions.push(texts[3].clone());
        words.forces[0].1.clone_from(&texts[4]);
        words.outputs[0].1.clone_from(&texts[5]);
        for (entry, text) in [(Entry::Constraint(1), &texts[2]), (Entry::Position(0), &texts[3])] {
            if let Err(error) = TextModel::new(&words)
                && error.entry == entry
                && let Some(column) = error.column()
            {
                prop_assert!(column <= text.chars().count() + 1);
            }
        }
        if let Ok(model) = TextModel::new(&words)
            && let Ok(start) = model.start(&[Some(0.1), Some(0.2), Some(0.3)], &[None; 3])
        {
            let _ = model.geometry(&start);
            prop_assert!(start.q.iter().chain(&start.v).all(|x| x.is_finite()));
        }
    }
}
