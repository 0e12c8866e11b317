//! `noslip plot`.

use crate::program::{FAILING, Folder, SCENE, names};

/// The lines of a picture, in order.
fn lines(picture: &str) -> Vec<&str> {
    picture.split("points=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

#[test]
fn a_scene_and_the_file_of_its_run_make_the_same_curves() {
    let folder = Folder::new();
    assert_eq!(folder.done("plot bowl --duration 20"), "picture: bowl.svg\n");
    let scene = folder.read("bowl.svg");
    for text in
        ["The sleigh in a bowl; dla, step 0.05 s", "speed [m/s]", "turn rate [rad/s]", "heading [rad]", "reaction [N]"]
    {
        assert!(scene.contains(text), "{text}");
    }
    assert!(scene.contains("|constraint| [m/s]") && scene.contains("E − E₀ [J]") && scene.contains("x [m]"));
    folder.done("run bowl --duration 20 --out run.csv");
    folder.done("run bowl --duration 20 --out run.npz");
    folder.done("plot run.csv --out csv.svg");
    folder.done("plot run.npz --out npz.svg");
    assert_eq!(lines(&folder.read("csv.svg")), lines(&scene));
    // Another motion is another picture.
    folder.done("plot bowl --duration 20 --set start.speed=-0.5 --out other.svg");
    assert_ne!(lines(&folder.read("other.svg")), lines(&scene));
    assert_eq!(lines(&folder.read("npz.svg")).len(), lines(&scene).len());
}

#[test]
fn methods_columns_size_and_resolution_are_chosen() {
    let folder = Folder::new();
    folder.done("plot turnaround --methods dla,rk4 --columns path,energy --size 160x90mm --dpi 150 --out a.png");
    let png = std::fs::read(folder.join("a.png")).unwrap();
    let sides = [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().unwrap()));
    assert_eq!(sides, [945, 531]);
    folder.done("plot turnaround --methods dla,rk4 --columns path,energy --size 6.3x3.5in --out a.svg");
    let svg = folder.read("a.svg");
    assert!(svg.contains("width=\"605\" height=\"336\"") && svg.contains("rk4") && !svg.contains("heading"), "{svg}");
    folder.done("plot turnaround --columns center_x --out a.pdf");
    assert!(std::fs::read(folder.join("a.pdf")).unwrap().starts_with(b"%PDF-"));
}

#[test]
fn what_makes_no_picture_is_refused_before_the_run() {
    let folder = Folder::new();
    folder.write("mine.svg", "mine");
    folder.refused("plot turnaround --out mine.svg", &["mine.svg exists already", "--force"]);
    folder.refused("plot turnaround --out a.gif", &["a.gif", ".svg, .png or .pdf"]);
    folder.refused("plot turnaround --columns height", &["no column `height`", "turn_rate", "path"]);
    for size in ["16x9", "16cm", "0x9cm", "16x1000cm", "axbcm", "-16x9cm"] {
        folder.refused(&format!("plot turnaround --size={size}"), &["--size", "16x9cm"]);
    }
    folder.refused("plot turnaround --dpi 5", &["--dpi", "30 to 1200"]);
    folder.refused("plot turnaround --methods euler", &["euler"]);
    folder.refused("plot none.csv", &["none.csv"]);
    folder.write("other.csv", "a,b\n1,2\n");
    folder.refused("plot other.csv", &["against `t`", "a, b"]);
    assert_eq!(
        (folder.read("mine.svg"), folder.names()),
        ("mine".to_owned(), vec!["mine.svg".to_owned(), "other.csv".to_owned()])
    );
}

/// A file with other columns is drawn as it is.
#[test]
fn columns_of_any_file_are_drawn_against_time() {
    let folder = Folder::new();
    folder.write("pendulum.csv", "t [s],angle [rad],tension [N]\n0,0,1\n1,1,2\n2,0,1\n");
    folder.done("plot pendulum.csv");
    let picture = folder.read("pendulum.svg");
    assert!(picture.contains("angle [rad]") && picture.contains("tension [N]") && picture.contains("pendulum.csv"));
}

#[test]
fn a_run_that_fails_is_drawn_as_far_as_it_comes() {
    let folder = Folder::new();
    folder.write("large.toml", FAILING);
    let outcome = folder.line("plot large.toml");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (1, "picture: large.svg\n"), "{outcome:?}");
    outcome.assert_told("plot", &["dla failed at step"]);
    assert!(folder.read("large.svg").contains("speed [m/s]"));
}

/// With its trailers in motion, and whatever acts on the first blade.
fn trains(counts: &[usize]) {
    let folder = Folder::new();
    let more = "[[effects]]\nkind = \"trailers\"\ncount = 2\nmass = 0.5\ninertia = 0.1\nbar = 0.8\n\
                [[effects]]\nkind = \"flywheel\"\ninertia = 0.5\nrotor_rate = 1.0\n\
                torque = { times = [0.0, 0.7], values = [0.3, -0.3] }\n";
    folder.write("train.toml", format!("{SCENE}{more}"));
    folder.done("plot train.toml --columns path,heading_2,rotor_angle,hinges --out train.svg");
    let picture = folder.read("train.svg");
    assert!(picture.contains("heading 2 [rad]") && picture.contains("rotor angle [rad]"), "{picture}");
    for count in counts {
        folder.write("other.toml", SCENE.to_owned() + &more.replace("count = 2", &format!("count = {count}")));
        folder.done("run other.toml --report pages --force");
        let page = folder.read("pages/index.html");
        assert!(page.contains("class=\"animation\"") && page.contains(">rotor_rate [rad/s]</td>"), "{page}");
        assert_eq!(page.matches("class=\"follower").count(), *count);
    }
}

#[test]
fn a_train_is_drawn_and_has_a_page() {
    trains(&[2]);
}

#[test]
#[ignore = "slow"]
fn a_train_is_drawn_and_has_a_page_in_full() {
    trains(&[2, 1]);
}

/// The page of a run of so long (s), whose numbers another command prints.
fn page_of_a_run(duration: u32, numbers: &str) {
    let folder = Folder::new();
    let text = folder.done(&format!("run bowl --duration {duration} --report pages"));
    assert!(text.starts_with("scene ") && text.ends_with("report: pages/index.html\n"), "{text}");
    let pictures = ["path", "constraint", "energy", "run"].map(|name| format!("bowl-{name}"));
    let mut files: Vec<String> =
        pictures.iter().flat_map(|name| [".png", ".svg"].map(|end| format!("{name}{end}"))).collect();
    files.push("index.html".to_owned());
    files.sort();
    assert_eq!(names(&folder.join("pages")), files);
    let page = folder.read("pages/index.html");
    let shown = ["turn rate [rad/s]", "heading [rad]", "reaction [N]", "class=\"animation\"", ">speed [m/s]</td>"];
    for text in shown {
        assert!(page.contains(text), "{text}");
    }
    // The numbers are those of the run.
    let end = folder.json(&format!("run bowl --duration {duration} --json {numbers}"));
    let end = end["final"]["speed"].as_f64().unwrap();
    assert!(page.contains(&format!("{end:.4}")), "{end}");
    folder.refused("run bowl --report pages", &["pages exists already", "--force"]);
    folder.refused("run bowl --report new --checkpoint a.save", &["--report", "--checkpoint"]);
    folder.refused("run - --report new", &["read only once"]);
    let report = numbers.strip_prefix("--report ").map(str::to_owned);
    assert_eq!(folder.names(), report.into_iter().chain(["pages".to_owned()]).collect::<Vec<_>>());
}

#[test]
fn a_run_has_a_page() {
    page_of_a_run(1, "");
}

#[test]
#[ignore = "slow"]
fn a_run_has_a_page_in_full() {
    page_of_a_run(5, "--report json");
}

#[test]
fn a_system_of_text_is_drawn_in_its_own_coordinates() {
    let folder = Folder::new();
    folder.done("plot knife-edge --duration 2");
    let picture = folder.read("knife-edge.svg");
    for text in ["theta [rad]", " [m/s]", "x [m]", "The knife edge on an incline; dla"] {
        assert!(picture.contains(text), "{text}");
    }
}

#[test]
#[ignore = "slow"]
fn a_system_of_text_has_a_page() {
    let folder = Folder::new();
    folder.done("run knife-edge --duration 2 --report pages");
    assert!(folder.read("pages/index.html").contains("theta [rad]"));
}

#[test]
fn a_run_that_fails_has_a_page_of_what_it_reached() {
    let folder = Folder::new();
    folder.write("large.toml", FAILING);
    let outcome = folder.line("run large.toml --report pages");
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(folder.read("pages/index.html").contains("speed [m/s]"));
}
