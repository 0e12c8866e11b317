//! The page as a reader sees it.

use crate::common::{circle, report, scene, texts, written};

#[test]
fn the_page_holds_every_row_every_fact_and_every_picture() {
    let mut coast = scene("coast", vec![circle("dla", 50), circle("rk4", 50)]);
    coast.rows = (0..7).map(|k| vec![format!("method {k}"), format!("{k}.25e-7"), format!("note {k}")]).collect();
    let report = report(vec![coast, scene("brake", vec![circle("dla", 50)])]);
    let (page, pictures) = written(&report);
    for scene in &report.scenes {
        assert!(page.contains(&format!("<h2>{}</h2>", scene.title)));
        for cell in scene.rows.iter().flatten() {
            assert!(page.contains(&format!(">{cell}</td>")), "{cell}");
        }
        for (fact, value) in &scene.facts {
            assert!(page.contains(&format!("<dt>{fact}</dt><dd>{value}</dd>")));
        }
    }
    for (_, picture) in &pictures {
        let shapes = picture.split_once("fill=\"#ffffff\"/>").unwrap().1.strip_suffix("</svg>\n").unwrap();
        assert!(page.contains(shapes));
    }
    assert!(page.contains("<p>What was done.</p>") && page.contains("<p>And how.</p>"));
    assert!(page.contains("light-dark(") && page.contains("name=\"viewport\""));
    // Numbers and what says that they are missing stand to the right, words to the left.
    assert!(
        page.contains("<td class=\"n\" data-column=\"error\">0.25e-7</td>")
            && page.contains("<td data-column=\"note\">note 0</td>")
    );
}

#[test]
fn a_method_without_a_run_stands_in_the_table_alone() {
    let drawn = scene("drawn", vec![circle("first", 50), circle("refuses", 50), circle("last", 50)]);
    let mut left_out = drawn.clone();
    left_out.series[1] = circle("refuses", 0);
    left_out.rows[1] = vec!["refuses".to_owned(), "refused: it cannot".to_owned()];
    let (full, with) = written(&report(vec![drawn]));
    let (page, without) = written(&report(vec![left_out]));
    // The last cell takes the columns that are left, and does not make a column of words of one of numbers.
    assert!(page.contains("<td data-column=\"method\">refuses</td><td colspan=\"2\">refused: it cannot</td>"));
    assert!(page.contains("<td class=\"n\" data-column=\"error\">1.5e-16</td>") && !full.contains("colspan"));
    for ((_, with), (_, without)) in with.iter().zip(&without) {
        let named = |picture: &str, name: &str| texts(picture).iter().any(|text| text == name);
        assert!(named(with, "refuses") && !named(without, "refuses"));
        assert!(named(without, "first") && named(without, "last"));
    }
    // The third method keeps its look, whoever else is drawn.
    let key = |page: &str| page.split_once("</svg>last</td>").unwrap().0.rsplit_once("<svg").unwrap().1.to_owned();
    assert_eq!(key(&full), key(&page));
}

#[test]
fn the_page_needs_nothing_from_elsewhere() {
    let (page, _) = written(&report(vec![scene("coast", vec![circle("dla", 50)])]));
    let page = page.replace("http://www.w3.org/2000/svg", "");
    for foreign in ["http:", "https:", "<link", "@import", "import(", "fetch(", "XMLHttp", "url(", "src="] {
        assert!(!page.contains(foreign), "{foreign}");
    }
}

#[test]
fn text_is_escaped_wherever_it_appears() {
    let hostile = "<b a=\"1\" c='2'>&\u{1}</b>";
    let mut scene = scene("coast", vec![circle(hostile, 20)]);
    scene.title = hostile.to_owned();
    scene.facts = vec![(hostile.to_owned(), hostile.to_owned())];
    scene.columns = vec![hostile.to_owned()];
    let mut report = report(vec![scene.clone(), scene]);
    report.title = hostile.to_owned();
    report.intro = hostile.to_owned();
    let (page, pictures) = written(&report);
    let escaped = "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;\u{fffd}&lt;/b&gt;";
    assert!(page.contains(&format!("<h1>{escaped}</h1>")) && page.contains(&format!("<dd>{escaped}</dd>")));
    let own = ["<body", "<button"].map(|element| page.matches(element).count());
    assert_eq!(page.matches("<b").count(), own.iter().sum::<usize>());
    assert!(!page.contains('\u{1}'));
    assert!(texts(&pictures[0].1).contains(&hostile.replace('\u{1}', "\u{fffd}")));
}
