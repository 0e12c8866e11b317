//! `noslip check`, `list`, `new`, `cost`, `equilibria` and `phase`.

use crate::program::{Folder, SCENE, SCENES, TEXTS, keys, methods};
use serde_json::Value;

#[test]
fn check_says_what_a_scene_is() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    for scene in SCENES {
        assert!(folder.done(&format!("check {scene}")).starts_with(&format!("{scene}: valid")));
    }
    let text = folder.done("check scene.toml");
    for fact in ["A test", "1 kg", "0.5 m", "0.50625 J", "2 s in 40 steps of 0.05 s", "dla"] {
        assert!(text.contains(fact), "{fact}: {text}");
    }
    // A path is a file even where a bundled scene has that name.
    folder.write("turnaround", SCENE);
    assert!(folder.done("check turnaround").contains("turns around"));
    assert!(folder.done("check ./turnaround").contains("A test"));
}

#[test]
fn check_says_the_effects_in_words_and_the_velocity_that_is_imposed() {
    let folder = Folder::new();
    let effects = "[[effects]]\nkind = \"servo\"\nturn_rate = 0.3\n[[effects]]\nkind = \"moving_mass\"\nmass = 2\n\
        y = { amplitude = 0.1, frequency = 2.0, phase = 1.0 }\n";
    folder.write("scene.toml", format!("{SCENE}{effects}"));
    let text = folder.done("check scene.toml");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for fact in [
        "servo imposes: turn rate 0.3 rad/s",
        "moving mass of 2 kg: 0 m ahead of the blade, 0.1 sin(2 t + 1) m to the left",
        "-1 m/s along the blade, 0.3 rad/s, as the servo imposes it",
    ] {
        assert!(words.contains(fact) && text.lines().all(|line| line.chars().count() <= 80), "{fact}: {text}");
    }
    // The energy is that of all that moves and of where it stands.
    let energy = folder.json("run bowl --duration 1 --json")["energy"]["initial"].as_f64().unwrap();
    assert!(folder.done("check bowl").contains(&format!(" {energy} J")), "{energy}");
    // Every kind of effect has its line.
    for scene in SCENES {
        let text = folder.done(&format!("check {scene}"));
        let effects = text.lines().filter(|line| line.starts_with("effect ")).count();
        let entries = scene_text(scene).lines().filter(|line| *line == "[[effects]]").count();
        assert_eq!(effects, entries, "{text}");
    }
}

fn scene_text(name: &str) -> String {
    std::fs::read_to_string(format!("{}/docs/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

#[test]
fn every_scene_has_its_page_and_its_picture() {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let index = std::fs::read_to_string(docs.join("gallery/README.md")).unwrap();
    for scene in SCENES.into_iter().chain(TEXTS) {
        assert!(index.contains(&format!("({scene}.md)")), "{scene}");
        let page = std::fs::read_to_string(docs.join(format!("gallery/{scene}.md"))).unwrap();
        assert!(page.contains(&format!("noslip compare {scene} ")), "{scene}");
        assert!(page.contains(&format!("(../pictures/{scene}-path.svg)")), "{scene}");
        assert!(page.contains(&format!("(../scenes/{scene}.toml)")), "{scene}");
        let picture = std::fs::metadata(docs.join(format!("pictures/{scene}-path.svg"))).unwrap();
        assert!(picture.len() < 80_000, "{scene}");
    }
}

#[test]
fn lists_are_the_same_as_text_and_as_json() {
    let folder = Folder::new();
    let listed = folder.json("list methods --json");
    let text = folder.done("list methods");
    assert_eq!(text.lines().count(), listed.as_array().unwrap().len());
    for (line, method) in text.lines().zip(listed.as_array().unwrap()) {
        let columns = ["name", "order", "keeps", "summary", "reference", "adaptive", "assemblies", "lanes", "tangent"];
        assert_eq!(keys(method), columns);
        assert!(line.starts_with(method["name"].as_str().unwrap()), "{line}");
        assert!(line.contains(&format!("order {}", method["order"])), "{line}");
        for key in ["keeps", "summary", "reference"] {
            assert!(!method[key].as_str().unwrap().is_empty(), "{method}");
        }
    }
    let baselines = ["rk4", "rk4-projected", "rk4-reduced", "implicit-midpoint", "dop853"];
    for baseline in ["dla", "dla-trapezoid", "dla-alpha"].into_iter().chain(baselines) {
        assert!(methods().iter().any(|name| name == baseline), "{baseline}");
    }

    // What the pages say of trains is what the table says.
    let of_trains = listed.as_array().unwrap().iter().filter(|method| method["assemblies"] == true);
    let names: Vec<String> = of_trains.map(|method| format!("`{}`", method["name"].as_str().unwrap())).collect();
    let (last, others) = names.split_last().unwrap();
    let said = format!("{} and {last}", others.join(", "));
    for page in [include_str!("../../docs/scenes.md"), include_str!("../../docs/guide/many-bodies.md")] {
        assert!(page.split_whitespace().collect::<Vec<_>>().join(" ").contains(&said), "{said}");
    }

    let scenes = folder.json("list scenes --json");
    let text = folder.done("list scenes");
    for ((scene, line), name) in
        scenes.as_array().unwrap().iter().zip(text.lines()).zip(SCENES.into_iter().chain(TEXTS))
    {
        assert_eq!(scene["name"].as_str(), Some(name));
        assert!(line.starts_with(name) && line.ends_with(scene["title"].as_str().unwrap()), "{line}");
    }
    assert_eq!(
        (scenes.as_array().unwrap().len(), text.lines().count()),
        (SCENES.len() + TEXTS.len(), SCENES.len() + TEXTS.len())
    );

    assert!(folder.json("list effects --json").is_array());
    assert!(!folder.done("list effects").is_empty());
}

#[test]
fn a_new_scene_is_valid_runs_and_is_never_overwritten_unasked() {
    let folder = Folder::new();
    assert!(folder.done("new my.toml").contains("my.toml"));
    assert!(folder.done("check my.toml").starts_with("my: valid"));
    assert_eq!(folder.json("run my.toml --json")["scene"].as_str(), Some("my"));
    let template = folder.read("my.toml");

    folder.write("my.toml", "mine");
    folder.refused("new my.toml", &["my.toml", "exists already", "--force"]);
    assert_eq!(folder.read("my.toml"), "mine");
    folder.done("new my.toml --force");
    assert_eq!(folder.read("my.toml"), template);

    folder.done("new text.toml --system");
    assert!(folder.done("check text.toml").starts_with("text: valid"));
    let run = folder.json("run text.toml --set system.parameters.drag=0.0 --until lambda_edge=0.2 --json");
    assert!((run["final"]["grip"].as_f64().unwrap() - 0.2).abs() < 1e-9, "{run}");
    std::fs::remove_file(folder.join("text.toml")).unwrap();

    let outcome = folder.line("new none/my.toml");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""));
    outcome.assert_told("new", &["none/my.toml"]);
    assert_eq!(folder.names(), ["my.toml"]);
}

#[cfg(unix)]
#[test]
fn a_new_scene_has_the_rights_of_a_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.done("new my.toml");
    folder.write("other.toml", "");
    let rights = |name: &str| std::fs::metadata(folder.join(name)).unwrap().permissions().mode();
    assert_eq!(rights("my.toml"), rights("other.toml"));
}

#[test]
fn help_and_version_are_results() {
    let folder = Folder::new();
    assert_eq!(folder.done("--version"), format!("noslip {}\n", env!("CARGO_PKG_VERSION")));
    for command in ["run", "compare", "check", "list", "new"] {
        assert!(folder.done("--help").contains(command));
        assert!(folder.done(&format!("{command} --help")).contains("Usage: noslip"));
    }
}

/// A row for none of the effects, for each alone and for all; counts do not depend on the machine.
#[test]
fn cost_has_a_row_for_none_each_and_all() {
    let folder = Folder::new();
    let drag = "[[effects]]\nkind = \"drag\"\nalong = 0.1\n";
    let bowl = "[[effects]]\nkind = \"bowl\"\nstiffness = [0.5, 0.2]\n";
    folder.write("bare.toml", SCENE);
    folder.write("laden.toml", format!("{SCENE}{bowl}{drag}"));
    let [bare, laden] = ["bare", "laden"].map(|name| folder.json(&format!("cost {name}.toml --json")));
    let effects = |cost: &Value| -> Vec<String> {
        cost["rows"].as_array().unwrap().iter().map(|row| row["effects"].to_string()).collect()
    };
    assert_eq!(effects(&bare), ["[]"]);
    assert_eq!(effects(&laden), ["[]", "[\"bowl\"]", "[\"drag\"]", "[\"bowl\",\"drag\"]"]);
    let number = |cost: &Value, row: usize, key: &str| cost["rows"][row][key].as_f64().unwrap();
    assert!((0..4).all(|row| number(&laden, row, "ns_per_step") > 0.0));
    // What is left out leaves nothing behind.
    let evaluations = |cost: &Value, row: usize| number(cost, row, "evaluations_per_step");
    assert_eq!(evaluations(&bare, 0).to_bits(), evaluations(&laden, 0).to_bits());
    // Only the drag has forces to evaluate, once in every correction and once at the end of a step.
    assert!(evaluations(&laden, 2) > evaluations(&laden, 0) + 1.0);
    let text = folder.done("cost laden.toml");
    assert_eq!(text.lines().count(), 6, "a heading, the columns and four rows: {text}");
    folder.refused("cost none.toml", &["none.toml"]);
}

#[test]
fn equilibria_tells_steady_motions_and_their_eigenvalues() {
    let folder = Folder::new();
    let found = folder.json("equilibria turnaround --json");
    assert_eq!(keys(&found), ["scene", "method", "step", "equilibria", "searched"]);
    let straight = |sign: f64| {
        let all = found["equilibria"].as_array().unwrap().iter();
        all.clone().find(|e| e["speed"].as_f64().unwrap() * sign > 0.5).unwrap().clone()
    };
    // m = I = 1, a = 1/2: c = 0.4, and the energy is 0.50625 J.
    let speed = (2.0 * 0.506_25_f64).sqrt();
    let forward = straight(1.0);
    assert_eq!((forward["stable"].as_bool(), forward["family"].as_u64()), (Some(true), Some(1)));
    assert!((forward["flow"][1]["re"].as_f64().unwrap() + 0.4 * speed).abs() < 1e-12);
    let half = 0.05 * 0.4 * speed / 2.0;
    assert!((forward["map"][1]["re"].as_f64().unwrap() - (1.0 - half) / (1.0 + half)).abs() < 1e-12);
    assert!(forward["step_limit"].is_null() && forward["step_limit_reason"] == "none");
    let back = straight(-1.0);
    assert!(back["stable"] == false && back["step_limit_reason"].is_null());
}

#[test]
fn equilibria_draws_a_portrait_and_refuses_what_has_none() {
    let folder = Folder::new();
    assert!(folder.done("equilibria turnaround --picture portrait.svg").contains("longest step"));
    assert!(folder.read("portrait.svg").contains("phase portrait"));
    folder.refused("equilibria turnaround --method dop853", &["dop853", "dla", "accepted"]);
    folder.refused("equilibria flywheel", &["depend on time"]);
    folder.refused("equilibria parking", &["depend on time"]);
    folder.refused("equilibria turnaround --picture portrait.svg", &["portrait.svg", "--force"]);
    // A search that finds none is no wrong request.
    folder.write("pushed.toml", format!("{SCENE}[[effects]]\nkind = \"thrust\"\nforce = 0.2\n"));
    assert_eq!(folder.line("equilibria pushed.toml").code, 1);
}

#[test]
#[ignore = "slow"]
fn equilibria_of_other_methods_and_of_a_slope() {
    let folder = Folder::new();
    let rk4 = folder.json("equilibria turnaround --method rk4 --json");
    assert_eq!(rk4["equilibria"][0]["step_limit_reason"], "unstable");
    folder.write("slope.toml", format!("{SCENE}[[effects]]\nkind = \"slope\"\ngravity = [0.3, 0.0]\n"));
    assert_eq!(folder.line("equilibria slope.toml").code, 1);
}

#[test]
fn phase_tells_what_loops_leave() {
    let folder = Folder::new();
    let found = folder.json("phase planimeter --method gauss8 --json");
    let number = |key: &str| found[key].as_f64().unwrap();
    assert!((number("turn") - found["exact"]["turn"].as_f64().unwrap()).abs() < 1e-10);
    let mean = std::f64::consts::TAU * (1.0 - (1.0_f64 - 0.04).sqrt());
    assert!((found["exact"]["mean_turn"].as_f64().unwrap() - mean).abs() < 1e-12);
    // Six halvings extrapolated: the next term is below 2^-21.
    assert!((number("curvature") + 1.0).abs() < 1e-6, "{}", number("curvature"));
    assert_eq!(found["class"], "elliptic");
    assert!(folder.done("phase planimeter --loops 3 --picture map.svg").contains("elliptic"));
    assert!(folder.read("map.svg").contains("turn of a loop"));
    folder.refused("phase turnaround", &["turnaround", "tracer"]);
    folder.refused("phase planimeter --loops 0", &["accepted"]);
}
