//! The page in a headless Chromium, where one is installed; `NOSLIP_CHROMIUM` names another than that of the path.

use crate::common::{circle, put, report, scene};
use report::SceneReport;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("NOSLIP_CHROMIUM") {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = names.iter().flat_map(|name| std::env::split_paths(&path).map(move |folder| folder.join(name)));
    found.into_iter().find(|file| file.is_file())
}

/// The elements of a page after its scripts have run for two seconds.
fn dom(browser: &Path, page: &Path, fragment: &str, options: &[&str]) -> String {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(browser)
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=2000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(options)
        .arg(format!("file://{}{fragment}", page.display()))
        .stderr(Stdio::null())
        .output()
        .unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// The value of an attribute of the first element that has it after the text.
fn attribute<'a>(dom: &'a str, after: &str, name: &str) -> Option<&'a str> {
    let rest = dom.split_once(after)?.1;
    rest.split_once(&format!(" {name}=\""))?.1.split('"').next()
}

const ROOT: &str = "<html";
const FIGURE: &str = "<figure class=\"animation\"";
const SLEIGH: &str = "<g class=\"sleigh\"";

/// Time in steps of 16 ms, so that frames come in a browser without a screen; and a reader, who plays a second, pauses half
/// of one, moves the slider to the middle, and presses the button of the theme.
const FRAMES: &str =
    "<script>window.requestAnimationFrame = (step) => setTimeout(() => step(performance.now()), 16);</script>";
const READER: &str = "<script>(() => {
  const find = (what) => document.querySelector(what);
  const figure = find('.animation'), [play, slider] = ['button', 'input'].map((what) => figure.querySelector(what));
  const sight = () => [figure.dataset.frame, find('.sleigh').getAttribute('transform'), play.textContent,
    find('.trail').points.numberOfItems, find('output').textContent, getComputedStyle(document.body).color].join('|');
  const sights = [sight()];
  const see = () => sights.push(sight());
  play.focus(); play.click();
  setTimeout(() => { see(); play.click(); see(); }, 1000);
  setTimeout(() => {
    see();
    slider.value = (Number(slider.min) + Number(slider.max)) / 2;
    slider.dispatchEvent(new Event('input'));
    see();
    find('#theme').click();
    see();
    find('html').dataset.sights = sights.join(';');
  }, 1500);
})();</script>";

fn page(folder: &Path) -> PathBuf {
    let scenes = ["coast", "brake"]
        .map(|name| SceneReport { exact_path: None, ..scene(name, vec![circle("dla", 601), circle("rk4", 601)]) });
    put(&report(scenes.to_vec()), &folder.join("out")).remove(0)
}

fn skipped() {
    eprintln!("skipped: no chromium, chromium-browser or google-chrome in the path, and NOSLIP_CHROMIUM is not set");
}

#[test]
#[ignore = "slow"]
fn the_page_works_in_a_browser() {
    let Some(browser) = browser() else { return skipped() };
    let folder = tempfile::tempdir().unwrap();
    let page = page(folder.path());
    let loaded = dom(&browser, &page, "", &[]);
    // It loads without errors, its controls are there, and nothing moves of itself.
    assert_eq!(
        (attribute(&loaded, ROOT, "data-error"), attribute(&loaded, ROOT, "data-ready")),
        (None, Some("2")),
        "{loaded}"
    );
    assert!(loaded.contains("<div class=\"controls\">") && !loaded.contains("id=\"theme\" hidden"));
    assert_eq!(attribute(&loaded, FIGURE, "data-frame"), Some("0"));
    let start = attribute(&loaded, SLEIGH, "transform").unwrap();
    // The plots have data: in each picture of each scene a line of each method, all of its points numbers.
    for colour in ["#005B96", "#B04400"] {
        let lines = loaded.split("<polyline").skip(1).filter(|line| line.split('>').next().unwrap().contains(colour));
        let long = lines.filter(|line| {
            let points: Vec<f64> = attribute(line, "", "points")
                .unwrap()
                .split([' ', ','])
                .filter(|number| !number.is_empty())
                .map(|number| number.parse().unwrap())
                .collect();
            assert!(points.iter().all(|number| number.is_finite()));
            points.len() > 20
        });
        assert!(long.count() >= 6, "{colour}");
    }

    // Asked to, it moves; not for who wants less motion.
    let played = dom(&browser, &page, "#play", &[]);
    assert_eq!(attribute(&played, ROOT, "data-error"), None);
    assert!(attribute(&played, FIGURE, "data-frame").unwrap().parse::<u32>().unwrap() > 0, "{played}");
    let calm = dom(&browser, &page, "#play", &["--force-prefers-reduced-motion"]);
    assert_eq!(attribute(&calm, SLEIGH, "transform"), Some(start));
}

#[test]
#[ignore = "slow"]
fn play_pause_and_scrub_do_what_they_say() {
    let Some(browser) = browser() else { return skipped() };
    let folder = tempfile::tempdir().unwrap();
    let page = page(folder.path());
    let text = fs::read_to_string(&page).unwrap();
    let driven = page.with_file_name("driven.html");
    fs::write(
        &driven,
        text.replacen("<script>", &format!("{FRAMES}<script>"), 1).replace("</body>", &format!("{READER}</body>")),
    )
    .unwrap();
    let dom_of_driven = dom(&browser, &driven, "", &[]);
    let sights: Vec<Vec<&str>> = attribute(&dom_of_driven, ROOT, "data-sights")
        .unwrap_or_else(|| panic!("{dom_of_driven}"))
        .split(';')
        .map(|sight| sight.split('|').collect())
        .collect();
    let [start, playing, paused, later, middle, turned] = &sights[..] else { panic!("{sights:?}") };
    let (frame, place, label, points, clock, colour) = (0, 1, 2, 3, 4, 5);
    // A second at 60 frames a second, of which a busy machine may lose many.
    assert!(playing[frame].parse::<u32>().unwrap() > 10, "{sights:?}");
    assert!(playing[place] != start[place] && playing[points].parse::<u32>().unwrap() > 2, "{sights:?}");
    assert_eq!((start[label], playing[label], paused[label]), ("Play", "Pause", "Play"));
    assert_eq!((paused[frame], paused[place]), (later[frame], later[place]));
    // Half of six seconds along the circle: the heading is the time.
    assert_eq!(middle[clock], "t = 3.00 s", "{sights:?}");
    let turn: f64 = middle[place].split("rotate(").nth(1).unwrap().trim_end_matches(')').parse().unwrap();
    approx::assert_abs_diff_eq!(-turn.to_radians(), 3.0, epsilon = 0.6_f64.to_radians());
    assert_ne!(middle[colour], turned[colour]);

    // What would be seen if a script were broken, in itself or when it runs.
    for (sound, broken) in [("root.dataset.ready =", "root.dataset.ready ="), ("const name = () =>", "const name = =>")]
    {
        let broken = if sound == broken { "absent.call(); root.dataset.ready =" } else { broken };
        assert!(text.contains(sound));
        fs::write(&driven, text.replacen(sound, broken, 1)).unwrap();
        let dom = dom(&browser, &driven, "", &[]);
        assert!(attribute(&dom, ROOT, "data-error").is_some() && attribute(&dom, ROOT, "data-ready").is_none());
    }
}

/// A reader who hides the second method, then all, and shows them again.
const CHOOSER: &str = "<script>(() => {
  const section = document.querySelector('section'), legend = section.querySelector('.legend');
  const seen = (run) => Array.from(section.querySelectorAll(`.pictures [data-run='${run}']`))
    .filter((shape) => getComputedStyle(shape).display !== 'none').length;
  const faint = () => section.querySelectorAll('.faint').length;
  const sights = [];
  const see = () => sights.push([seen(0), seen(1), faint(), legend.hidden].join('|'));
  const press = (what) => { legend.querySelector(`[data-shows='${what}']`).click(); see(); };
  setTimeout(() => { see(); press(1); press('none'); press(0); press('all');
    document.documentElement.dataset.sights = sights.join(';'); }, 500);
})();</script>";

#[test]
#[ignore = "slow"]
fn methods_are_switched_on_and_off_in_the_legend() {
    let Some(browser) = browser() else { return skipped() };
    let folder = tempfile::tempdir().unwrap();
    let page = page(folder.path());
    let text = fs::read_to_string(&page).unwrap();
    let driven = page.with_file_name("driven.html");
    fs::write(&driven, text.replace("</body>", &format!("{CHOOSER}</body>"))).unwrap();
    let dom = dom(&browser, &driven, "", &[]);
    assert_eq!(attribute(&dom, ROOT, "data-error"), None);
    let sights = attribute(&dom, ROOT, "data-sights").unwrap_or_else(|| panic!("{dom}"));
    let sights: Vec<Vec<&str>> = sights.split(';').map(|sight| sight.split('|').collect()).collect();
    let [start, without, none, first, all] = &sights[..] else { panic!("{sights:?}") };
    let count = |text: &str| text.parse::<u32>().unwrap();
    // Each of three pictures has a line, markers and a sample of each method.
    assert!(count(start[0]) > 9 && count(start[1]) > 9 && start[3] == "false", "{sights:?}");
    assert_eq!((without[0], without[1], none[0], none[1]), (start[0], "0", "0", "0"));
    assert_eq!((first[0], first[1], all), (start[0], "0", start));
    // Its name: in three legends, and at the ends of two lines.
    assert_eq!((start[2], without[2], none[2]), ("0", "5", "10"));
}

/// At a width of 390 units, of a telephone, and of 1400, neither the page nor anything in it scrolls sideways.
#[test]
#[ignore = "slow"]
fn nothing_scrolls_sideways() {
    let Some(browser) = browser() else { return skipped() };
    let folder = tempfile::tempdir().unwrap();
    let names = ["dla", "rk4", "implicit-midpoint"];
    let mut wide = scene("coast", names.map(|name| circle(name, 300)).to_vec());
    wide.columns = (0..14).map(|k| format!("column {k} [m/s]")).collect();
    wide.rows = names
        .map(|name| (0..14).map(|k| if k == 0 { name.to_owned() } else { "1.5e-16".to_owned() }).collect())
        .to_vec();
    wide.rows[1] = vec![
        "rk4".to_owned(),
        "refused: a reason of many words, which goes on for longer than a line has room".to_owned(),
    ];
    let page = put(&report(vec![wide]), &folder.path().join("out")).remove(0);
    let text = fs::read_to_string(&page).unwrap().replace('&', "&amp;").replace('"', "&quot;");
    for width in [390, 1400] {
        let around = format!(
            "<!DOCTYPE html><html><body><iframe style=\"width:{width}px;height:900px;border:0\" srcdoc=\"{text}\"></iframe><script>
            setTimeout(() => {{
              const page = document.querySelector('iframe').contentDocument;
              const scrolls = Array.from(page.querySelectorAll('.scroll, table, section')).filter((e) => e.scrollWidth > e.clientWidth + 1);
              const root = document.documentElement.dataset;
              root.width = page.documentElement.scrollWidth;
              root.scrolls = scrolls.map((e) => e.tagName + e.className).join();
            }}, 800);</script></body></html>"
        );
        let outer = page.with_file_name("around.html");
        fs::write(&outer, around).unwrap();
        let dom = dom(&browser, &outer, "", &["--window-size=1500,1000"]);
        let told = ["data-width", "data-scrolls"].map(|name| attribute(&dom, ROOT, name));
        // A bar for scrolling upwards may take some of it.
        assert!(told[0].is_some_and(|told| told.parse::<u32>().unwrap() <= width), "{told:?}");
        assert_eq!(told[1], Some(""), "{width}");
    }
}
