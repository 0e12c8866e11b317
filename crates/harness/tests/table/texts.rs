//! The rows of the table as texts: what a person would write into a scene, with the basis that the system in Rust has.

use text::{Unit, Words};

/// Coordinates, of which those that end in `!` are angles; parameters; Lagrangian; constraints; basis.
struct Text {
    coordinates: &'static [&'static str],
    parameters: &'static [(&'static str, f64)],
    lagrangian: &'static str,
    constraints: &'static [&'static str],
    basis: &'static [&'static [&'static str]],
}

impl Text {
    fn words(&self) -> Words {
        let unit = |name: &&str| match name.strip_suffix('!') {
            Some(name) => (name.to_owned(), Unit::Angle),
            None => ((*name).to_owned(), Unit::other("m")),
        };
        Words {
            coordinates: self.coordinates.iter().map(unit).collect(),
            parameters: self.parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            lagrangian: self.lagrangian.to_owned(),
            constraints: self.constraints.iter().map(|&row| row.to_owned()).collect(),
            basis: self.basis.iter().map(|w| w.iter().map(|&part| part.to_owned()).collect()).collect(),
            ..Words::default()
        }
    }
}

const BLADE: &[&str] = &["y'*cos(theta) - x'*sin(theta)"];
const DRIVE_AND_PIVOT: &[&[&str]] = &[&["cos(theta)", "sin(theta)", "0"], &["0", "0", "1"]];

/// A sleigh at its blade.
const fn sleigh(parameters: &'static [(&'static str, f64)]) -> Text {
    Text {
        coordinates: &["x", "y", "theta!"],
        parameters,
        lagrangian: "m/2*(x'^2 + y'^2) + m*a*theta'*(y'*cos(theta) - x'*sin(theta)) + (I + m*a^2)/2*theta'^2",
        constraints: BLADE,
        basis: DRIVE_AND_PIVOT,
    }
}

const SLEIGH: Text = sleigh(&[("m", 1.3), ("I", 0.8), ("a", 0.4)]);

/// A sleigh at its centre of mass, in a potential.
pub fn in_field(coordinates: &'static [&'static str], potential: &str) -> Words {
    let mut words = Text {
        coordinates,
        parameters: SLEIGH.parameters,
        lagrangian: "m/2*(x'^2 + y'^2) + I/2*theta'^2",
        constraints: &["y'*cos(theta) - x'*sin(theta) - a*theta'"],
        basis: &[&["cos(theta)", "sin(theta)", "0"], &["-a*sin(theta)", "a*cos(theta)", "1"]],
    }
    .words();
    words.lagrangian = format!("{} - ({potential})", words.lagrangian);
    words
}

fn with_forces(text: &Text, forces: &[(&str, &str)]) -> Words {
    let forces = forces.iter().map(|&(name, force)| (name.to_owned(), force.to_owned())).collect();
    Words { forces, ..text.words() }
}

/// A particle with `z' = y x'`.
const fn particle(lagrangian: &'static str) -> Text {
    Text {
        coordinates: &["x", "y", "z"],
        parameters: &[("m", 1.4), ("k", 0.6)],
        lagrangian,
        constraints: &["z' - y*x'"],
        basis: &[&["1", "0", "y"], &["0", "1", "0"]],
    }
}

const fn contact(lagrangian: &'static str) -> Text {
    Text {
        coordinates: &["x", "y", "z"],
        parameters: &[("eps", 0.3)],
        lagrangian,
        constraints: &["x' + y*z'"],
        basis: &[&["0", "1", "0"], &["-y", "0", "1"]],
    }
}

const MOVING: Text = Text {
    coordinates: &["x", "y", "z"],
    parameters: &[],
    lagrangian: "((1 + 0.2*x^2 + 0.3*sin(1.5*t))*x'^2 + y'^2 + (1.5 + 0.3*cos(y))*z'^2)/2 + 0.4*y*x' + 0.1*t^2*z'*x \
                 - 0.6*cos(x + 0.5*t) - z^2/2",
    constraints: &["z' - y*x' + 0.5*sin(t + z)*y' + 0.3*cos(t) + 0.2*x"],
    basis: &[&["1", "0", "y"], &["0", "1", "-0.5*sin(t + z)"]],
};

const MAGNETIC: Text = Text {
    coordinates: &["x", "y", "z"],
    parameters: &[("m", 1.3), ("c", 0.2)],
    lagrangian: "m/2*((1 + 0.4*y^2)*x'^2 + y'^2 + 0.7*z'^2) + c*(x'^2 + y'^2)^2 + 0.3*z*x' - (x^2 + 2*y^2 + z^2)/2 \
                 - z*cos(x)",
    constraints: &["z' - y*x'"],
    basis: &[&["1", "0", "y"], &["0.2*x", "1", "0.2*x*y"]],
};

const DISK: Text = Text {
    coordinates: &["x", "y", "phi!", "theta!"],
    parameters: &[("m", 1.3), ("R", 0.7), ("I", 0.5), ("J", 0.9)],
    lagrangian: "m/2*(x'^2 + y'^2) + I/2*phi'^2 + J/2*theta'^2",
    constraints: &["x' - R*phi'*cos(theta)", "y' - R*phi'*sin(theta)"],
    basis: &[&["R*cos(theta)", "R*sin(theta)", "1", "0"], &["0", "0", "0", "1"]],
};

const RACER: Text = Text {
    coordinates: &["x", "y", "theta!", "phi!"],
    parameters: &[("m", 1.3), ("I1", 0.8), ("I2", 0.3), ("d1", 0.7), ("d2", 0.4)],
    lagrangian: "m/2*(x'^2 + y'^2) + I1/2*theta'^2 + I2/2*(theta' + phi')^2",
    constraints: &[
        "y'*cos(theta) - x'*sin(theta)",
        "y'*cos(theta + phi) - x'*sin(theta + phi) + (d1*cos(phi) + d2)*theta' + d2*phi'",
    ],
    basis: &[&["cos(theta)", "sin(theta)", "0", "sin(phi)/d2"], &["0", "0", "1", "-d1/d2*cos(phi) - 1"]],
};

const BOARD: Text = Text {
    coordinates: &["x", "y", "theta!", "psi!", "phi!"],
    parameters: &[("m", 1.3), ("l", 0.7), ("J", 0.3), ("Jr", 0.2), ("Jw", 0.1)],
    lagrangian: "m/2*(x'^2 + y'^2) + J/2*theta'^2 + Jr/2*(theta' + psi')^2 + Jw/2*((theta' + phi')^2 + (theta' - phi')^2)",
    constraints: &["y'*cos(theta) - x'*sin(theta)", "sin(phi)*(x'*cos(theta) + y'*sin(theta)) + l*cos(phi)*theta'"],
    basis: &[
        &["l*cos(phi)*cos(theta)", "l*cos(phi)*sin(theta)", "-sin(phi)", "0", "0"],
        &["0", "0", "0", "1", "0"],
        &["0", "0", "0", "0", "1"],
    ],
};

const QUARTIC: Text = Text {
    coordinates: &["x", "y1", "y2", "y3", "z1", "z2", "z3"],
    parameters: &[],
    lagrangian: "(x'^2 + y1'^2 + y2'^2 + y3'^2 + z1'^2 + z2'^2 + z3'^2)/2 - (x^2 + y1^2 + y2^2 + y3^2 + z1^2 + z2^2 + z3^2)/2 \
                 - (y1^2*z1^2 + y2^2*z2^2 + y3^2*z3^2 + z1^2*z2^2)/2",
    constraints: &["x' + y1*z1' + y2*z2' + y3*z3'"],
    basis: &[
        &["0", "1", "0", "0", "0", "0", "0"],
        &["0", "0", "1", "0", "0", "0", "0"],
        &["0", "0", "0", "1", "0", "0", "0"],
        &["-y1", "0", "0", "0", "1", "0", "0"],
        &["-y2", "0", "0", "0", "0", "1", "0"],
        &["-y3", "0", "0", "0", "0", "0", "1"],
    ],
};

const SUSLOV: Text = Text {
    coordinates: &["e0", "e1", "e2", "e3"],
    parameters: &[("I1", 1.0), ("I2", 2.0), ("I3", 1.5), ("I13", 0.3), ("I23", 0.5)],
    lagrangian: "2*mean*(e0'^2 + e1'^2 + e2'^2 + e3'^2) + ((I1 - mean)*b1^2 + (I2 - mean)*b2^2 + (I3 - mean)*b3^2)/2 \
                 + (I13*b1 + I23*b2)*b3",
    constraints: &["e0*e3' - e3*e0' - e1*e2' + e2*e1'"],
    basis: &[&["-e1/2", "e0/2", "e3/2", "-e2/2"], &["-e2/2", "-e3/2", "e0/2", "e1/2"]],
};

const BALL: Text = Text {
    coordinates: &["x", "y", "e0", "e1", "e2", "e3"],
    parameters: &[("m", 1.2), ("r", 0.6), ("I1", 0.5), ("I2", 0.8), ("I3", 1.1)],
    lagrangian: "m/2*(x'^2 + y'^2) + 2*mean*(e0'^2 + e1'^2 + e2'^2 + e3'^2) \
                 + ((I1 - mean)*b1^2 + (I2 - mean)*b2^2 + (I3 - mean)*b3^2)/2",
    constraints: &["x' - r*2*(e0*e2' - e2*e0' + e3*e1' - e1*e3')", "y' + r*2*(e0*e1' - e1*e0' + e2*e3' - e3*e2')"],
    basis: &[
        &["2*r*(e1*e2 + e0*e3)", "-r*(e0^2 + e1^2 - e2^2 - e3^2)", "-e1/2", "e0/2", "e3/2", "-e2/2"],
        &["r*(e0^2 - e1^2 + e2^2 - e3^2)", "-2*r*(e1*e2 - e0*e3)", "-e2/2", "-e3/2", "e0/2", "e1/2"],
        &["2*r*(e2*e3 - e0*e1)", "-2*r*(e1*e3 + e0*e2)", "-e3/2", "e2/2", "-e1/2", "e0/2"],
    ],
};

/// A body whose attitude is a unit quaternion, held by its length or by the rate of its length.
fn attitude(text: &Text, positions: bool) -> Words {
    let mut words = text.words();
    words.abbreviations = [
        ("mean", "(I1 + I2 + I3)/3"),
        ("b1", "2*(e0*e1' - e1*e0' - e2*e3' + e3*e2')"),
        ("b2", "2*(e0*e2' - e2*e0' - e3*e1' + e1*e3')"),
        ("b3", "2*(e0*e3' - e3*e0' - e1*e2' + e2*e1')"),
    ]
    .map(|(name, text)| (name.to_owned(), text.to_owned()))
    .to_vec();
    if positions {
        words.positions = vec!["(e0^2 + e1^2 + e2^2 + e3^2 - 1)/2".to_owned()];
    } else {
        words.constraints.push("e0*e0' + e1*e1' + e2*e2' + e3*e3'".to_owned());
    }
    words
}

/// The text of the row of that name; none where a row differs from another in the way that Rust tells it only.
pub fn of(row: &str) -> Option<Words> {
    Some(match row {
        "free sleigh" => SLEIGH.words(),
        "balanced sleigh" => sleigh(&[("m", 1.3), ("I", 0.8), ("a", 0.0)]).words(),
        "sleigh in a well" => in_field(&["x", "y", "theta!"], "(x^2 + y^2)/2"),
        "sleigh in the egg-crate" => in_field(&["x!", "y!", "theta!"], "(cos(x) + cos(y))/2"),
        "sleigh in a moving crate" => in_field(&["x!", "y!", "theta!"], "(cos(x - 0.7*t) + cos(y))/2"),
        "sleigh under thrust" => with_forces(&SLEIGH, &[("x", "-0.5*cos(theta)"), ("y", "-0.5*sin(theta)")]),
        "sleigh with friction" => with_forces(
            &SLEIGH,
            &[("x", "cos(theta)*theta' - 0.2*x'"), ("y", "sin(theta) - 0.2*y'"), ("theta", "0.3*x - 0.1*theta'^3")],
        ),
        "sleigh on a turntable" => {
            let constraints = &["y'*cos(theta) - x'*sin(theta) - 0.3*(y*sin(theta) + x*cos(theta))"];
            Text { constraints, ..SLEIGH }.words()
        }
        "moving everything" => {
            with_forces(&MOVING, &[("x", "0.4*cos(2*t) - 0.1*x'"), ("y", "-0.2*x'*y'"), ("z", "-0.3*y*z'")])
        }
        "magnetic particle" => MAGNETIC.words(),
        "nonholonomic particle" => particle("m/2*(x'^2 + y'^2 + z'^2)").words(),
        "nonholonomic particle in a well" => particle("m/2*(x'^2 + y'^2 + z'^2) - k/2*(x^2 + y^2)").words(),
        "knife edge on an incline" => Text {
            coordinates: &["x", "y", "theta!"],
            parameters: &[("m", 1.3), ("I", 0.6), ("g", 1.7)],
            lagrangian: "m/2*(x'^2 + y'^2) + I/2*theta'^2 + m*g*x",
            constraints: BLADE,
            basis: DRIVE_AND_PIVOT,
        }
        .words(),
        "contact oscillator" => contact("(x'^2 + y'^2 + z'^2 - x^2 - y^2 - z^2 - eps*x^2*z^2)/2").words(),
        "gauged contact oscillator" => {
            contact("(x'^2 + y'^2 + z'^2 - x^2 - y^2 - z^2 - eps*x^2*z^2)/2 + z'*sin(z)").words()
        }
        "vertical rolling disk" => DISK.words(),
        "roller racer" => RACER.words(),
        "Suslov problem" => attitude(&SUSLOV, true),
        "Suslov problem, norm by its rate" => attitude(&SUSLOV, false),
        "Chaplygin ball" => attitude(&BALL, true),
        "Chaplygin ball, norm by its rate" => attitude(&BALL, false),
        "snakeboard" => BOARD.words(),
        "chaotic quartic oscillator" => QUARTIC.words(),
        _ => return None,
    })
}
