//! The scene in motion: what `page.js` moves, and where it moves it.

use super::canvas::Point;
use super::frame::Frame;
use super::look::Ink;
use super::path::{path, view};
use super::svg::{escape, units};
use super::{Body, SceneReport, Series, sleigh};

/// How many nodes may be left out in a row.
const GAP: usize = 40;
/// Digits of the time, relative to the whole.
const TICKS: f64 = 2e5;

/// A node as the picture has it.
struct DrawnNode {
    /// The time (s).
    t: f64,
    /// The angle of the rotor (degrees).
    rotor: f64,
    /// The place (units of the picture) and the heading (degrees) of the sleigh and of each blade behind it, one after the other.
    blades: Vec<f64>,
}

/// The figure; `None` if no run has two nodes to move between.
pub(crate) fn figure(scene: &SceneReport) -> Option<String> {
    let (method, series) = scene.leading()?;
    let mut ground = view(scene, &[]);
    let frame = ground.frame;
    let nodes = thinned(nodes(series, &frame));
    let [first, last] = [nodes.first()?, nodes.last()?];
    if last.t <= first.t {
        return None;
    }
    path(&mut ground, &series.path, (Ink::Text, 0.3, 1.2));
    let body = if scene.body == Body::Sleigh { "sleigh" } else { "system" };
    let picture = ground.named(String::new(), format!("{}: the {body} in motion", scene.title), String::new());
    let rotor = !series.rotor.is_empty();
    let drawing = picture.inline(&stage((method, scene.body), &frame, first, rotor));
    let (from, to, step) = (first.t, last.t, (last.t - first.t) / 500.0);
    let digits = (-((to - from) / TICKS).log10().floor()).clamp(0.0, 17.0) as usize;
    let mut lists = list("t", nodes.iter().map(|node| node.t), digits);
    lists += &format!(",{}", moved(&nodes, 0));
    if rotor {
        lists += &format!(",{}", list("rotor", nodes.iter().map(|node| node.rotor), 1));
    }
    if first.blades.len() > 3 {
        let behind: Vec<String> = (1..first.blades.len() / 3).map(|k| format!("{{{}}}", moved(&nodes, k))).collect();
        lists += &format!(",\"followers\":[{}]", behind.join(","));
    }
    let turning = if rotor { " The wheel on the sleigh is the rotor, and turns with the rotor." } else { "" };
    Some(format!(
        "<figure class=\"animation\" data-frame=\"0\">\n{drawing}\n\
         <div class=\"controls\" hidden><button type=\"button\">Play</button><input type=\"range\" aria-label=\"Time\" \
         min=\"{from}\" max=\"{to}\" step=\"{step}\" value=\"{from}\"><output></output>\
         <label>Speed <select></select></label></div>\n\
         <script type=\"application/json\">{{{lists}}}</script>\n\
         <figcaption>The motion of the {body} by {}, with the path so far, and in grey the whole path.{turning}\
         </figcaption>\n</figure>\n",
        escape(&series.label)
    ))
}

/// A named list of numbers.
fn list(name: &str, values: impl Iterator<Item = f64>, decimals: usize) -> String {
    let numbers: Vec<String> = values.map(|value| format!("{value:.decimals$}")).collect();
    format!("\"{name}\":[{}]", numbers.join(","))
}

/// The places and headings of a blade.
fn moved(nodes: &[DrawnNode], blade: usize) -> String {
    let whole = f64::from(units(1.0));
    let axes = [("x", whole, 0), ("y", whole, 0), ("heading", 1.0, 1)].into_iter().enumerate();
    let lists = axes.map(|(axis, (name, scale, decimals))| {
        list(name, nodes.iter().map(|node| scale * node.blades[3 * blade + axis]), decimals)
    });
    lists.collect::<Vec<_>>().join(",")
}

/// What moves, at the first node, cut off at the frame.
fn stage((method, body): (usize, Body), frame: &Frame, first: &DrawnNode, rotor: bool) -> String {
    let [left, top, width, height] = [frame.left, frame.top, frame.width, frame.height].map(units);
    let at = |blade: &[f64]| format!("{},{}", units(blade[0]), units(blade[1]));
    let moving = |class: &str, blade: &[f64], shape: &str| {
        let turn = -blade[2];
        format!("<g class=\"{class}\" transform=\"translate({}) rotate({turn:.2})\">{shape}</g>", at(blade))
    };
    let (own, behind) = first.blades.split_at(3);
    let sleigh = moving("sleigh", own, &sleigh::shape(body, rotor));
    let mut train = String::new();
    if !behind.is_empty() {
        let places: Vec<String> = first.blades.chunks(3).map(at).collect();
        train = format!(
            "<polyline class=\"bars\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"{}\" points=\"{}\"/>",
            units(1.0),
            places.join(" ")
        );
        train.extend(behind.chunks(3).map(|blade| moving("follower", blade, &sleigh::follower())));
    }
    format!(
        "<svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" viewBox=\"{left} {top} {width} {height}\">\
         <polyline class=\"trail\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" points=\"{}\"/>{train}{sleigh}</svg>",
        Ink::Method(method).colour(),
        units(2.2),
        at(own),
    )
}

/// The nodes that can be drawn, in order of time.
fn nodes(series: &Series, frame: &Frame) -> Vec<DrawnNode> {
    // Places far outside the frame are as good as at its edge, and shorter to write.
    let place = |point: Point| frame.place(point).map(|place| place.map(|length| length.clamp(-1e4, 1e4)));
    let mut nodes: Vec<DrawnNode> = Vec::new();
    for (k, ((&t, &point), &heading)) in series.time.iter().zip(&series.path).zip(&series.heading).enumerate() {
        let rotor = series.rotor.get(k).copied().unwrap_or(0.0);
        let drawn = t.is_finite() && heading.is_finite() && rotor.is_finite();
        let Some([x, y]) = place(point).filter(|_| drawn && nodes.last().is_none_or(|before| before.t < t)) else {
            continue;
        };
        let mut blade = [x, y, heading.to_degrees()];
        let mut blades = blade.to_vec();
        for follower in &series.followers {
            let known = follower.get(k).filter(|place| place.iter().all(|x| x.is_finite()));
            // A place that cannot be drawn is where the blade before it is.
            if let Some([x, y, heading]) = known
                && let Some([x, y]) = place([*x, *y])
            {
                blade = [x, y, heading.to_degrees()];
            }
            blades.extend(blade);
        }
        nodes.push(DrawnNode { t, blades, rotor: rotor.to_degrees() });
    }
    nodes
}

/// Leaves out nodes that a straight line between their neighbours stands for.
fn thinned(nodes: Vec<DrawnNode>) -> Vec<DrawnNode> {
    let straight = |from: usize, to: usize| {
        let [a, b] = [&nodes[from], &nodes[to]];
        nodes[from + 1..to].iter().all(|node| {
            let share = (node.t - a.t) / (b.t - a.t);
            let near = |a: f64, b: f64, at: f64, limit: f64| (a + share * (b - a) - at).abs() <= limit;
            // In units of the picture, and as an angle of a blade and of the rotor (degrees).
            let limits = [0.25, 0.25, 0.5].into_iter().cycle().enumerate().take(node.blades.len());
            let mut blades = limits.map(|(k, limit)| near(a.blades[k], b.blades[k], node.blades[k], limit));
            blades.all(|near| near) && near(a.rotor, b.rotor, node.rotor, 4.0)
        })
    };
    let mut from = 0;
    let kept: Vec<bool> = (0..nodes.len())
        .map(|k| {
            let keep = k == 0 || k + 1 == nodes.len() || k - from >= GAP || !straight(from, k + 1);
            if keep {
                from = k;
            }
            keep
        })
        .collect();
    nodes.into_iter().zip(kept).filter_map(|(node, keep)| keep.then_some(node)).collect()
}
