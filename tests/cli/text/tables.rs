//! Functions of time by points in systems of text, and choices: steps end where they turn.

use crate::program::Folder;
use approx::assert_relative_eq;
use std::f64::consts::PI;

fn scene(tables: &str, force: &str) -> String {
    format!(
        "[system]\ncoordinates = {{ x = \"m\" }}\n{tables}\nlagrangian = \"x'^2/2\"\nforces = {{ x = \"{force}\" }}\n\
         outputs = {{ push = \"{force}\" }}\n[run]\nstep = 0.7\nduration = 4.9\n"
    )
}

/// The momentum is the area under the force, to round-off with steps that know nothing of its corners.
#[test]
fn a_force_by_points_has_their_area() {
    let folder = Folder::new();
    let points = "times = [0.5, 1.0, 1.05, 3.2], values = [1.0, -2.0, 6.0, 0.5]";
    folder.write("push.csv", "t,push\n0.5,1.0\n1.0,-2.0\n1.05,6.0\n3.2,0.5\n");
    let ramp = 0.5 + 0.5 * (1.0 - 2.0) * 0.5 + 0.5 * (-2.0 + 6.0) * 0.05 + 0.5 * (6.0 + 0.5) * 2.15 + 0.5 * 1.7;
    let steps = 1.0 - 2.0 * 0.05 + 6.0 * 2.15 + 0.5 * 1.7;
    let from_file = "file = \"push.csv\", columns = [\"t\", \"push\"]";
    for points in [points, from_file] {
        for (interpolation, area) in [("linear", ramp), ("steps", steps)] {
            let tables = format!("tables = {{ push = {{ {points}, interpolation = \"{interpolation}\" }} }}");
            folder.write("push.toml", scene(&tables, "push"));
            // The last two have a tolerance of 1e-12.
            for (method, within) in [("gauss8", 2e-14), ("dla", 2e-14), ("dop853", 1e-12), ("taylor", 1e-12)] {
                let run = folder.json(&format!("run push.toml --method {method} --json"));
                assert_relative_eq!(run["final"]["x'"].as_f64().unwrap(), area, max_relative = within);
            }
        }
    }
}

#[test]
fn a_choice_by_time_is_cut_and_one_by_place_is_a_force() {
    let folder = Folder::new();
    folder.write("push.toml", scene("", "if(t < 1.3, sqrt(1.3 - t), 2*step(t - 4))"));
    let area = 2.0 / 3.0 * 1.3_f64.powf(1.5) + 2.0 * 0.9;
    for (method, within) in [("taylor", 1e-12), ("dop853", 1e-9)] {
        let run = folder.json(&format!("run push.toml --method {method} --json"));
        assert_relative_eq!(run["final"]["x'"].as_f64().unwrap(), area, max_relative = within);
    }
    folder.write("push.toml", scene("", "mod(t, 1.5)*floor(t)"));
    // The integral of (t - 1.5 i) j over the pieces between multiples of 1.5 and of 1.
    let piece = |from: f64, to: f64, i: f64, j: f64| j * ((to * to - from * from) / 2.0 - 1.5 * i * (to - from));
    let pieces =
        [(1.0, 1.5, 0.0, 1.0), (1.5, 2.0, 1.0, 1.0), (2.0, 3.0, 1.0, 2.0), (3.0, 4.0, 2.0, 3.0), (4.0, 4.5, 2.0, 4.0)];
    let area: f64 =
        pieces.iter().map(|(from, to, i, j)| piece(*from, *to, *i, *j)).sum::<f64>() + piece(4.5, 4.9, 3.0, 4.0);
    for (method, within) in [("gauss8", 1e-13), ("dla", 1e-13), ("taylor", 1e-12), ("dop853", 1e-9)] {
        let run = folder.json(&format!("run push.toml --method {method} --json"));
        assert_relative_eq!(run["final"]["x'"].as_f64().unwrap(), area, max_relative = within);
    }
    // A ball between two springs: through half of the gap, half a swing of one spring, through the gap, and into the other spring.
    let gap = scene("", "if(abs(x) <= 1, 0, -4*(x - if(x > 0, 1, -1)))");
    folder.write("gap.toml", gap.replace("duration = 4.9", "duration = 3.0") + "[start]\n\"x'\" = 3.0\n");
    let run = folder.json("run gap.toml --method dop853 --tolerance 1e-12 --json");
    let expected = -1.0 - 1.5 * (2.0 * (3.0 - 1.0 / 3.0 - PI / 2.0 - 2.0 / 3.0)).sin();
    assert_relative_eq!(run["final"]["x"].as_f64().unwrap(), expected, max_relative = 1e-8);
}

#[test]
fn what_jumps_has_no_place_in_a_lagrangian() {
    let folder = Folder::new();
    let tables = "tables = { push = { times = [0.0, 1.0], values = [1.0, 2.0] } }";
    folder.write("push.toml", scene(tables, "0").replace("x'^2/2", "x'^2/2 - push*x"));
    folder.refused("check push.toml", &["no name `push` is known here"]);
    let linear = tables.replace("2.0] }", "2.0], interpolation = \"linear\" }");
    folder.write("push.toml", scene(&linear, "0").replace("x'^2/2", "x'^2/2 - push*x"));
    folder.done("check push.toml");
    folder.write("push.toml", scene("", "if(x, 1, 2)"));
    folder.refused("check push.toml", &["the condition of `if` is a comparison"]);
    folder.write("push.toml", scene("tables = { push = { times = [1.0, 0.0], values = [1.0, 2.0] } }", "push"));
    folder.refused("check push.toml", &["system.tables.push.times"]);
}
