//! Plain `noslip`: the first screen.

#[cfg(target_os = "linux")]
use crate::processes::{output, send, started};
use crate::program::{Folder, names};
use std::fs;

#[test]
#[ignore = "slow"]
fn the_first_screen_is_short_and_says_what_the_runs_gave() {
    let folder = Folder::new();
    // Somebody's folder, which stays as it is.
    fs::create_dir(folder.join("noslip-report")).unwrap();
    let text = folder.done("");
    assert!(text.lines().count() <= 40, "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(text.contains("\npage: noslip-report-2/index.html\n"), "{text}");
    assert!(names(&folder.join("noslip-report")).is_empty());

    // The same runs by the other command, whose numbers the cells and the sentences have.
    let numbers = folder.json("compare egg-crate --step 0.1 --duration 300 --methods dla,rk4 --json");
    let [dla, rk4] = [0, 1].map(|k| numbers["rows"][k].clone());
    let row = |method: &str| text.lines().find(|line| line.starts_with(&format!(" {method} "))).unwrap();
    assert!(["dla", "dla4", "gauss16", "energy4"].iter().all(|method| row(method).contains(" no ")), "{text}");
    assert!(["gauss16", "energy4"].iter().all(|method| row(method).contains("no, rounding")), "{text}");
    let slip = format!("{:.1e} m/s", rk4["constraint"]["max"].as_f64().unwrap());
    let slope = rk4["energy"]["slope"].as_f64().unwrap();
    assert!(row("rk4").contains(&format!("yes, {slip}")), "{text}");
    assert!(row("rk4").contains(&format!("drifts, {slope:+.1e} J/s")), "{text}");
    let amplitude = dla["energy"]["amplitude"].as_f64().unwrap();
    assert!(row("dla").contains(&format!("no, swings by {amplitude:.1e} J")), "{text}");
    assert!(row("dla").contains(&format!("{:.1e}", dla["error"].as_f64().unwrap())), "{text}");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for sentence in [
        "dla, dla4, gauss16 and energy4 hold the no-slip constraint to round-off; the blade of rk4 slips sideways, by up to",
        "The energy of gauss16 and energy4 keeps its value to round-off; the energy of dla and dla4 swings",
        &format!("the energy of rk4 drifts, by {:.1e} J/s", slope.abs()),
        "is cheapest at an error of 1e-3 m",
        "1e-9 m",
    ] {
        assert!(words.contains(sentence), "{sentence} in {text}");
    }

    // The page has the table, the sentences and what the columns mean.
    let page = folder.read("noslip-report-2/index.html");
    for column in ["does it slip?", "does its energy drift?", "error at the end"] {
        assert!(
            page.contains(&format!("\">{column}</th>")) && page.contains(&format!("<dt>{column}</dt>")),
            "{column}"
        );
    }
    assert!(page.contains(&slip) && page.contains("hold the no-slip constraint to round-off"));
    assert_eq!(page.matches("<tr>").count(), 1 + 5);
}

/// Whether a process catches Ctrl-C by now.
#[cfg(target_os = "linux")]
fn listens(process: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(caught.trim(), 16).unwrap() & 0b10 != 0
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_keeps_what_the_first_screen_has_by_then() {
    let folder = Folder::new();
    fs::create_dir(folder.join("noslip-report")).unwrap();
    let child = started(&folder, "");
    while !listens(child.id()) {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    send("-INT", &child);
    let (code, text, told) = output(child);
    assert_eq!(code, Some(130), "{told}");
    assert!(told.starts_with("error: interrupted: ") && told.contains(" of 5 methods finished"), "{told}");
    for part in
        ["300 s in steps of 0.1 s", "does it slip?", "\n dla ", "\npage: noslip-report-2/index.html\n", "noslip --all"]
    {
        assert!(text.contains(part), "{part} in {text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let page = folder.read("noslip-report-2/index.html");
    for column in ["does it slip?", "does its energy drift?", "error at the end"] {
        assert!(page.contains(&format!("\">{column}</th>")), "{column}");
    }
    assert!(names(&folder.join("noslip-report")).is_empty());
}

#[test]
fn what_the_columns_mean_is_told_without_a_run() {
    let folder = Folder::new();
    let text = folder.done("--explain");
    for column in ["method", "does it slip?", "does its energy drift?", "error at the end", "time"] {
        assert!(text.lines().any(|line| line == column), "{column} in {text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(folder.names().is_empty());
}

#[test]
fn a_page_that_is_there_is_kept() {
    let folder = Folder::new();
    folder.write("mine", "mine");
    for line in ["--report mine", "--all --report mine"] {
        folder.refused(line, &["mine", "exists already", "--force"]);
    }
    assert_eq!((folder.names(), folder.read("mine")), (vec!["mine".to_owned()], "mine".to_owned()));
}
