//! `noslip precision`.

use crate::program::{Folder, SCENE, keys, names};
use approx::assert_abs_diff_eq;
use lagrangian::Shown;
use serde_json::Value;

/// The runs of these tests last at most so long.
const SHORT: &str = "--duration 4 --longest 0.0005";

/// Those with steps of their own, whose ladders are of tolerances.
const ADAPTIVE: [&str; 3] = ["gauss-adaptive", "taylor", "dop853"];

/// Label, step or tolerance, error, elapsed and processor time of a point: to the last bit, or nothing where there is none.
type Numbers = (String, Option<u64>, Option<u64>, Option<u64>, Option<u64>);

fn bits(text: &str) -> Option<u64> {
    text.parse::<f64>().ok().map(f64::to_bits)
}

fn of_json(result: &Value) -> Vec<Numbers> {
    let point = |point: &Value| {
        let number = |key: &str| point.get(key).and_then(Value::as_f64).map(f64::to_bits);
        let method = point["method"].as_str().unwrap();
        let label =
            point.get("source").map_or_else(|| method.to_owned(), |s| format!("{method} ({})", s.as_str().unwrap()));
        (label, number("step").or(number("tolerance")), number("error"), number("wall_seconds"), number("cpu_seconds"))
    };
    result["points"].as_array().unwrap().iter().map(point).collect()
}

fn of_csv(text: &str) -> Vec<Numbers> {
    let point = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let source = cells[cells.len() - 1];
        let label = if source.is_empty() { cells[0].to_owned() } else { format!("{} ({source})", cells[0]) };
        (label, bits(cells[1]).or(bits(cells[2])), bits(cells[4]), bits(cells[5]), bits(cells[6]))
    };
    text.lines().skip(1).map(point).collect()
}

/// The table of points: from its heading to the empty line after it.
fn of_table(text: &str) -> Vec<Numbers> {
    let table = text.lines().skip_while(|line| !line.contains("CPU [s]")).skip(1).take_while(|line| !line.is_empty());
    let point = |line: &str| {
        let cells: Vec<&str> = line.split_whitespace().collect();
        // A label with its source is two words.
        let words = if cells[1].starts_with('(') { 2 } else { 1 };
        let at = |k: usize| bits(cells[words + k]);
        (cells[..words].join(" "), at(0).or(at(1)), at(3), at(4), at(5))
    };
    table.map(point).collect()
}

/// The points of the page's last table.
fn of_page(page: &str) -> Vec<Numbers> {
    let table = &page[page.rfind("<tbody>").unwrap()..];
    let point = |row: &str| {
        let cell = |cell: &str| {
            let text = cell.split("</td>").next().unwrap();
            text.rsplit('>').next().unwrap().to_owned()
        };
        let cells: Vec<String> = row.split("<td").skip(1).map(cell).collect();
        let at = |k: usize| bits(&cells[k]);
        (cells[0].clone(), at(1).or(at(2)), at(4), at(5), at(6))
    };
    table.split("<tr>").skip(1).map(point).collect()
}

/// The points of a diagram, by what a pointer is told over them, with where they are.
fn of_plot(svg: &str) -> Vec<(Numbers, [f64; 2])> {
    let point = |circle: &str| {
        let attribute = |name: &str| {
            let value = circle.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap();
            value.parse::<f64>().unwrap()
        };
        let told = circle.split("<title>").nth(1).unwrap().split("</title>").next().unwrap();
        let parts: Vec<&str> = told.split(", ").collect();
        let after = |name: &str| {
            let part = parts.iter().find_map(|part| part.strip_prefix(name));
            part.and_then(|part| bits(part.trim_end_matches(" s")))
        };
        let setting = after("step ").or(after("tolerance "));
        let numbers = (parts[0].to_owned(), setting, after("error "), after("wall "), after("CPU "));
        (numbers, [attribute("cx"), attribute("cy")])
    };
    svg.split("<circle").skip(1).filter(|circle| circle.contains("<title>")).map(point).collect()
}

/// The same numbers with the digits of the screen.
fn shown(points: &[Numbers]) -> Vec<Numbers> {
    let number = |bits: u64| Shown(f64::from_bits(bits)).to_string().parse::<f64>().unwrap().to_bits();
    let point = |(method, setting, error, wall, cpu): &Numbers| {
        let [setting, error, wall, cpu] = [setting, error, wall, cpu].map(|value| value.map(number));
        (method.clone(), setting, error, wall, cpu)
    };
    points.iter().map(point).collect()
}

/// Runs of `duration` s, at least `least` points, and which of the two commands has a page and a diagram, too.
fn the_same_everywhere(limits: &str, least: usize, pages: &[&str]) {
    let folder = Folder::new();
    // Of another program, one point without a step and one that failed.
    folder.write(
        "peer.json",
        r#"{"program": "peer", "points": [
            {"method": "taylor", "tolerance": 1e-9, "steps": 7, "error": 3.25e-9, "wall_seconds": 1.5e-5},
            {"method": "taylor", "steps": 9, "error": 1.0625e-12, "wall_seconds": 2.5e-5},
            {"method": "bdf", "error": null, "wall_seconds": null, "failure": "gave up"}]}"#,
    );
    let line = format!("precision turnaround --methods dla,gauss8,dop853 {limits} --with peer.json");
    let files = |name: &str| {
        let report = if pages.contains(&name) { format!("--report {name}") } else { String::new() };
        format!("--csv {name}.csv {report}")
    };
    let result = folder.json(&format!("{line} --json {}", files("a")));
    let text = folder.done(&format!("{line} --wide {}", files("b")));
    assert!(text.contains("points: b.csv\n"), "{text}");
    assert_eq!(text.ends_with("report: b/index.html\n"), pages.contains(&"b"), "{text}");
    for (name, said) in [("a", of_json(&result)), ("b", of_table(&text))] {
        assert!(said.len() >= least, "{said:?}");
        // Files have all digits, the screen and the page six.
        let in_csv = of_csv(&folder.read(&format!("{name}.csv")));
        assert_eq!(said, if name == "a" { in_csv.clone() } else { shown(&in_csv) });
        if !pages.contains(&name) {
            continue;
        }
        let said = shown(&in_csv);
        assert_eq!(said, of_page(&folder.read(&format!("{name}/index.html"))));
        let plot = of_plot(&folder.read(&format!("{name}/turnaround-time.svg")));
        let drawn: Vec<Numbers> = said.iter().filter(|point| point.2.is_some()).cloned().collect();
        assert_eq!(drawn, plot.iter().map(|(numbers, _)| numbers.clone()).collect::<Vec<_>>());
        // Where a point is says the same: both axes are logarithmic, and places are rounded to a unit of the picture.
        let logs = |(_, _, error, wall, cpu): &Numbers| {
            [cpu.or(*wall).unwrap(), error.unwrap()].map(|bits| f64::from_bits(bits).log10())
        };
        for axis in [0, 1] {
            let at = |k: usize| (logs(&plot[k].0)[axis], plot[k].1[axis]);
            let order = |a: &usize, b: &usize| at(*a).0.total_cmp(&at(*b).0);
            let (low, high) = ((0..plot.len()).min_by(order).unwrap(), (0..plot.len()).max_by(order).unwrap());
            for k in 0..plot.len() {
                let share = (at(k).0 - at(low).0) / (at(high).0 - at(low).0);
                assert_abs_diff_eq!(at(k).1, at(low).1 + share * (at(high).1 - at(low).1), epsilon = 2.0);
            }
        }
    }
    let pictures = ["step.png", "step.svg", "time.png", "time.svg"].map(|what| format!("turnaround-{what}"));
    let mut files: Vec<String> =
        ["index.html", "turnaround.csv", "turnaround.csv-metadata.json", "turnaround.json"].map(str::to_owned).to_vec();
    files.extend(pictures);
    files.sort();
    assert_eq!(names(&folder.join("a")), files);
    assert_eq!(folder.read("a/turnaround.csv"), folder.read("a.csv"));
    assert_eq!(serde_json::from_str::<Value>(&folder.read("a/turnaround.json")).unwrap(), result);
}

#[test]
fn table_csv_json_page_and_plot_say_the_same() {
    // One of each method, and the three of the other program.
    the_same_everywhere("--duration 0.5 --longest 0.00001", 6, &["a"]);
}

#[test]
#[ignore = "slow"]
fn table_csv_json_page_and_plot_say_the_same_at_length() {
    the_same_everywhere(SHORT, 21, &["a", "b"]);
}

/// What is measured, and how far.
struct Measured<'a> {
    methods: &'a str,
    longest: &'a str,
    /// Methods with `least` points at least, over which the error shrinks to `part`.
    ladders: &'a [&'a str],
    least: usize,
    part: f64,
    /// So many of the largest errors have a price, and a next method.
    priced: usize,
}

fn json_result(measured: &Measured<'_>) {
    let folder = Folder::new();
    let Measured { methods, longest, ladders, least, part, priced } = measured;
    let line = format!("precision turnaround --methods {methods} --duration 4 --longest {longest} --json");
    let result = folder.json(&line);
    let expected = ["scene", "duration", "reference", "clock", "points", "methods", "cheapest"];
    assert_eq!(keys(&result), expected);
    assert_eq!((result["scene"].as_str(), result["duration"].as_f64()), (Some("turnaround"), Some(4.0)));
    let reference = &result["reference"];
    assert_eq!(reference["kind"].as_str(), Some("closed form"));
    // The end is at 4 m: some ten roundings of it, and what the growth of the turn makes of them.
    assert!((0.0..1e-13).contains(&reference["error"].as_f64().unwrap()), "{reference}");
    for point in result["points"].as_array().unwrap() {
        let first = ["method", "step", "steps", "error", "wall_seconds", "cpu_seconds", "spread", "pareto"];
        let adaptive = ADAPTIVE.iter().any(|name| point["method"] == *name);
        for key in first {
            assert_eq!(point.get(key).is_some(), !(adaptive && key == "step"), "{key} of {point}");
        }
        assert!(point.get("tolerance").is_some() == adaptive);
    }
    let whole = |method: &&Value| ladders.iter().any(|name| method["method"] == *name);
    for method in result["methods"].as_array().unwrap().iter().filter(whole) {
        let points = result["points"].as_array().unwrap().iter().filter(|point| point["method"] == method["method"]);
        let errors: Vec<f64> =
            points.filter(|point| point.get("mark").is_none()).map(|point| point["error"].as_f64().unwrap()).collect();
        // Near its rounding a tolerance may be met better than the next one is.
        let most = if ADAPTIVE.iter().any(|name| method["method"] == *name) { 2.0 } else { 1.0 };
        assert!(
            errors.len() >= *least && errors.windows(2).all(|pair| pair[1] < most * pair[0]),
            "{method} {errors:?}"
        );
        assert!(errors[errors.len() - 1] < part * errors[0], "{method} {errors:?}");
    }
    // The next power of the step is two orders away: at the steps of the fit, all below 0.3 s, less than a tenth of
    // this one, which tilts a line over the two decades of error by less than ln(1.1) / ln(100) of the slope.
    let dla = &result["methods"][0];
    assert_abs_diff_eq!(dla["slope"].as_f64().unwrap(), 2.0, epsilon = 0.04);
    let cheapest = result["cheapest"].as_array().unwrap();
    let levels: Vec<f64> = cheapest.iter().map(|level| level["error"].as_f64().unwrap()).collect();
    assert_eq!(levels, [1e-3, 1e-6, 1e-9, 1e-12]);
    for level in cheapest.iter().take(*priced) {
        assert!(level["method"].is_string() && level["factor"].as_f64().unwrap() >= 1.0, "{level}");
    }
}

#[test]
fn json_has_the_reference_the_points_and_the_cheapest() {
    json_result(&Measured {
        methods: "dla,gauss8,dop853",
        longest: "0.001",
        ladders: &["dla", "gauss8"],
        // Two halvings of the step at least, however slow the machine, by each of which the errors of the second order are a quarter.
        least: 3,
        part: 0.07,
        priced: 1,
    });
}

#[test]
#[ignore = "slow"]
fn json_has_the_reference_the_points_and_the_cheapest_at_length() {
    json_result(&Measured {
        methods: "dla,rk4,gauss8,gauss-adaptive,taylor,dop853",
        longest: "0.0005",
        ladders: &["dla", "rk4", "gauss8", "gauss-adaptive", "taylor", "dop853"],
        least: 6,
        part: 1e-3,
        priced: 4,
    });
}

#[test]
fn own_output_is_read_back() {
    let folder = Folder::new();
    // An effect is spelled with an underscore, and so may be the scene.
    let line = format!("precision egg_crate --methods gauss4 {SHORT}");
    let first = folder.done(&format!("{line} --json"));
    folder.write("before.json", &first);
    let both = folder.json(&format!("{line} --json --with before.json --with before.json"));
    assert_eq!(both["scene"].as_str(), Some("egg-crate"));
    let before = of_json(&serde_json::from_str(&first).unwrap());
    let read: Vec<Numbers> = of_json(&both).into_iter().filter(|point| point.0.contains("before")).collect();
    assert_eq!(read.len(), 2 * before.len());
    for (label, setting, error, wall, cpu) in before {
        let again = (format!("{label} (before)"), setting, error, wall, cpu);
        assert_eq!(read.iter().filter(|point| **point == again).count(), 2);
    }
    let other = folder.line(&format!("precision turnaround --methods dla {SHORT} --with before.json"));
    assert!(
        other.code == 0 && other.stderr.contains("the points belong to the scene \"egg-crate\", not to \"turnaround\""),
        "{other:?}"
    );
}

#[test]
fn points_that_are_none_are_refused_before_the_runs() {
    let folder = Folder::new();
    for (content, told) in [
        ("", "EOF"),
        ("{}", "the file has no points"),
        (r#"{"points": [{"error": 1.0}]}"#, "points[0]: `method` is not a name"),
        (
            r#"{"points": [{"method": "m", "error": "small"}]}"#,
            "points[0]: `error` must be a number of 0 or more, and is \"small\"",
        ),
        (
            r#"{"points": [{"method": "m", "wall_seconds": -1}]}"#,
            "`wall_seconds` must be a number of 0 or more, and is -1",
        ),
    ] {
        folder.write("bad.json", content);
        let line = "precision turnaround --with bad.json --csv out.csv --report pages";
        folder.refused(line, &["bad.json", told, "accepted is JSON"]);
    }
    folder.refused("precision turnaround --with none.json", &["none.json"]);
    for (flags, told) in [
        ("--longest 0", "greater than 0"),
        ("--longest nan", "greater than 0"),
        ("--methods nope", "nope"),
        ("--duration -1", "--duration"),
        ("--step 0.1", "--step"),
    ] {
        folder.refused(&format!("precision turnaround {flags}"), &[told]);
    }
    folder.write("there.csv", "mine");
    folder.refused("precision turnaround --csv there.csv", &["there.csv", "exists already", "--force"]);
    assert_eq!(folder.names(), ["bad.json", "there.csv"]);
}

#[test]
fn a_refusal_is_a_row_and_fails_only_who_asked_for_it() {
    let folder = Folder::new();
    let shaken = "[[effects]]\nkind = \"moving_mass\"\nmass = 0.5\ny = { amplitude = 0.4, frequency = 2.0 }\n";
    folder.write("shaken.toml", format!("{SCENE}{shaken}"));
    let outcome = folder.line("precision shaken.toml --longest 0.001 --methods energy2,rk4");
    assert_eq!(outcome.code, 1, "{outcome:?}");
    let reason = "refused: the energy-preserving methods need systems that do not depend on time explicitly";
    outcome.assert_told("precision", &["energy2", reason]);
    let words = outcome.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(&format!("energy2: {reason}")), "{words}");
    assert!(outcome.stdout.lines().all(|line| line.chars().count() <= 80), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("reference: gauss16 with "), "{}", outcome.stdout);
}

#[test]
#[ignore = "a timing: `NOSLIP_MEASURE=1 cargo test --release --test tests two_identical -- --ignored --nocapture`"]
fn two_identical_methods_take_the_same_time() {
    if std::env::var("NOSLIP_MEASURE").as_deref() != Ok("1") {
        return;
    }
    let line = "precision turnaround --methods dla,dla,gauss8,gauss8,rk4,rk4 --longest 0.02 --json";
    let result = Folder::new().json(line);
    let points = result["points"].as_array().unwrap();
    let mut ratios = Vec::new();
    for (k, a) in points.iter().enumerate() {
        // Which run a ladder ends with is a matter of time, too: the other may lack it.
        let same = |b: &&Value| b["method"] == a["method"] && b["steps"] == a["steps"];
        if let (Some(b), Some(time)) = (points[k + 1..].iter().find(same), a["cpu_seconds"].as_f64()) {
            ratios.push(time / b["cpu_seconds"].as_f64().unwrap());
        }
    }
    assert!(ratios.len() > 20);
    ratios.sort_by(f64::total_cmp);
    println!("ratios from {:.4} over {:.4} to {:.4}", ratios[0], ratios[ratios.len() / 2], ratios[ratios.len() - 1]);
    assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.03), "{ratios:?}");
}
