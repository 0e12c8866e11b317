//! `noslip list`, `new`, `completions` and `man`.

use crate::args::{Arguments, ListArguments, Listed, NewArguments};
use crate::error::CliError;
use crate::files::write_whole;
use crate::inspect::method_names;
use crate::{effect_keys, stability, table, terminal};
use clap::CommandFactory;
use clap_complete::Shell;
use harness::METHODS;
use scene::{AnyScene, Scene, TextScene};
use serde_json::json;
use std::io::Write;
use std::path::Path;

/// `noslip list`: what there is.
pub(crate) fn list(arguments: &ListArguments) -> Result<(), CliError> {
    if arguments.json {
        let all: Vec<_> = match arguments.what {
            Listed::Methods => METHODS
                .iter()
                .map(|m| {
                    // No method steps the members of a sweep together; the key stays for those who read it.
                    json!({"name": m.name, "order": m.order, "keeps": m.keeps, "summary": m.summary,
                           "reference": m.reference, "adaptive": m.kind.is_adaptive(), "assemblies": m.assemblies,
                           "lanes": false, "tangent": m.tangent.is_ok()})
                })
                .collect(),
            Listed::Effects => scene::EFFECTS
                .iter()
                .map(|effect| {
                    let scene::EffectInfo { name, keys, summary, .. } = effect;
                    json!({"name": name, "keys": keys, "summary": summary, "properties": effect_keys::json(name)})
                })
                .collect(),
            Listed::Cases => stability::cases()?
                .iter()
                .map(|case| {
                    json!({"name": case.name, "hard": case.hard, "shows": case.shows, "bar": case.bar,
                           "refusable": case.refusable})
                })
                .collect(),
            Listed::Scenes => scenes()?.iter().map(|(name, title)| json!({"name": name, "title": title})).collect(),
        };
        return terminal::print_json(&json!(all));
    }
    let text = match arguments.what {
        Listed::Methods => {
            let line = |m: &harness::MethodInfo| (m.name, format!("order {}, {}", m.order, m.summary));
            table::listed(&METHODS.iter().map(line).collect::<Vec<_>>())
        }
        Listed::Effects => effect_keys::text(),
        Listed::Cases => {
            table::listed(&stability::cases()?.iter().map(|case| (case.name, case.hard)).collect::<Vec<_>>())
        }
        Listed::Scenes => table::listed(&scenes()?),
    };
    terminal::print(&text)
}

fn scenes() -> Result<Vec<(&'static str, String)>, CliError> {
    let names = method_names();
    let title = |bundled: &scene::Bundled| Ok((bundled.name, AnyScene::load(bundled.name, &names)?.title().to_owned()));
    scene::bundled().iter().chain(scene::bundled_texts()).map(title).collect()
}

/// `noslip new`: a scene to start from; `-` is standard output.
pub(crate) fn new(arguments: &NewArguments) -> Result<(), CliError> {
    let template = if arguments.system { TextScene::template() } else { Scene::template() };
    if arguments.file == Path::new("-") {
        return terminal::print(template);
    }
    write_whole(&arguments.file, arguments.force, |file| file.write_all(template.as_bytes()))?;
    terminal::print(&format!("written: {}\n", arguments.file.display()))
}

/// Prints the completions of a shell.
pub(crate) fn completions(shell: Shell) -> Result<(), CliError> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "noslip", &mut text);
    terminal::print(&String::from_utf8_lossy(&text))
}

/// Prints a page for `man`, of the program or of one of its commands.
pub(crate) fn man(command: Option<&str>) -> Result<(), CliError> {
    let mut all = Arguments::command();
    // The names of the commands are then whole: `noslip run`.
    all.build();
    let page = match command {
        None => Some(&all),
        Some(name) => all.find_subcommand(name).filter(|command| !command.is_hide_set()),
    };
    let Some(page) = page else {
        let names: Vec<&str> =
            all.get_subcommands().filter(|command| !command.is_hide_set()).map(clap::Command::get_name).collect();
        let problem =
            format!("unknown command `{}`; the commands are {}", command.unwrap_or_default(), names.join(", "));
        return Err(CliError::Request(problem));
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page.clone()).render(&mut text).map_err(CliError::Output)?;
    terminal::print(&String::from_utf8_lossy(&text))
}
