use crate::table::{counted, number};
use scene::{Quantity, TextModel, TextScene};

/// The description of a scene for a person: names and values.
pub(crate) fn listed(scene: &TextScene) -> Vec<(String, String)> {
    let (model, start, run, schedule) = (&scene.model, &scene.start, &scene.run, scene.schedule());
    let geometry = model.geometry(start);
    let mut facts: Vec<(&str, String)> = Vec::new();
    let units = model.coordinates().iter().map(|of| match of.unit.name() {
        "" => of.name.clone(),
        unit => format!("{} [{unit}]", of.name),
    });
    facts.push(("coordinates", units.collect::<Vec<_>>().join(", ")));
    let parameters = scene.words.parameters.iter().map(|(name, value)| format!("{name} = {}", number(*value)));
    let parameters: Vec<String> = parameters.collect();
    if !parameters.is_empty() {
        facts.push(("parameters", parameters.join(", ")));
    }
    let positions = match model.positions() {
        0 => String::new(),
        k => format!(", {k} of them on positions"),
    };
    facts.push(("constraints", format!("{}{positions}, rank {} at the start", model.constraints(), geometry.rank)));
    if model.constraints() > 0 {
        facts.push(("integrable", geometry.integrability()));
        facts.push(("growth vector", geometry.growth_told()));
        facts
            .push(("basis of admissible velocities", if model.gives_basis() { "given" } else { "derived" }.to_owned()));
    }
    if model.has_forces() {
        facts.push(("forces", scene.words.forces.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ")));
    }
    if model.depends_on_time() {
        facts.push(("depends on time", "yes".to_owned()));
    }
    let [lagrangian, constraint, force] = model.operations();
    facts.push((
        "operations",
        format!("{lagrangian} for the Lagrangian, {constraint} for the constraints, {force} for the forces"),
    ));
    let numbers = |what: &[(String, String)]| {
        what.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
    };
    let state = state(model, &start.q, &start.v);
    let n = model.coordinates().len();
    facts.push(("start", numbers(&state[..n])));
    facts.push(("start velocity", numbers(&state[n..2 * n])));
    if state.len() > 2 * n {
        facts.push(("outputs", numbers(&state[2 * n..])));
    }
    facts.push(("energy", format!("{} J", number(model.energy(0.0, &start.q, &start.v)))));
    facts.push((
        "run",
        format!("{} s in {} of {} s", number(run.duration), counted(schedule.steps, "step"), number(schedule.step)),
    ));
    facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Coordinates, rates and outputs, with their units.
fn state(model: &TextModel, q: &[f64], v: &[f64]) -> Vec<(String, String)> {
    let line = |of: &Quantity, x: f64| (of.name.clone(), format!("{} {}", number(x), of.unit).trim_end().to_owned());
    let outputs = model.told(0.0, q, v);
    let values = q.iter().chain(v).chain(&outputs);
    scene::text_quantities(model).iter().zip(values).map(|(of, x)| line(of, *x)).collect()
}
