use crate::table::number;
use crate::terminal;
use scene::AnyScene;

/// Says which numbers of the start the constraints of a scene do not admit.
pub(crate) fn moves(scene: &AnyScene) {
    let AnyScene::Text(scene) = scene else { return };
    for moved in &scene.start.moved {
        let (from, to) = (number(moved.from), number(moved.to));
        let note = format!(
            "the constraints do not admit {} = {from} at the start; the run starts with \
            {to}",
            moved.name
        );
        terminal::say("note", &note);
    }
}
