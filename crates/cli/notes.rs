use crate::table::number;
use crate::terminal;
use harness::Record;
use scene::AnyScene;

/// Warns of steps of a run that change the energy though no force does that work.
pub(crate) fn warn_of_jumps(record: &Record) {
    if let Some(jump) = record.energy.jump {
        terminal::say("warning", &format!("{}: {jump}", record.method.name));
    }
}

/// Says which numbers of the start the constraints of a scene do not admit.
pub(crate) fn moves(scene: &AnyScene) {
    let AnyScene::Text(scene) = scene else { return };
    for (first, moved) in scene.start.moved.iter().enumerate().map(|(k, moved)| (k == 0, moved)) {
        let (from, to) = (number(moved.from), number(moved.to));
        let note = format!(
            "the constraints do not admit {} = {from} at the start; the run starts with {to}{}",
            moved.name,
            // Numbers that `start` omits are moved before numbers that it gives.
            if first { ": leave out of `start` what is to follow from the rest" } else { "" }
        );
        terminal::say("note", &note);
    }
}
