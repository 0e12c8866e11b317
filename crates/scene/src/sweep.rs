use crate::bundled;
use crate::document::Document;
use crate::draw::{Draw, Stream};
use crate::fault::Fault;
use crate::keys::{DURATION, STEP};
use crate::settings::parse_with;
use crate::table::TomlTable;
use crate::text::varied;
use crate::variation::UNKNOWN;
use crate::{AnyScene, Overrides, Scene, SceneError, Setting, file, suggest, variation, with_settings};
use sleigh::Sleigh;
use thiserror::Error;
use toml::de::DeTable;
use toml::{Table, Value};

/// Numbers that every scene has, though its text may not have all of them.
const COMMON: [&str; 8] = [
    "start.x",
    "start.y",
    "start.heading",
    "start.speed",
    "start.turn_rate",
    "sleigh.mass",
    "sleigh.inertia",
    "sleigh.offset",
];

/// How a member is run.
const RUN: [&str; 5] = ["run.alpha", "run.duration", "run.method", "run.step", "run.tolerance"];

const NUMBERS: &str = "keys of the scene's start, sleigh and effects that have a number, like start.speed, sleigh.offset, \
                       effects.0.stiffness.1, or run.step, run.duration, run.tolerance, run.alpha, run.method";

/// The most members of a sweep.
const MOST: u64 = 1_000_000_000_000;

/// Many variants of a scene: a grid of values, and random samples at each of its points.
///
/// Members are numbered; each is made from its number alone, so that any of them can be made at any time. Keys are in
/// the order of the alphabet; on the grid the last one varies fastest. A random number belongs to the seed, the key, the number of the
/// sample, and to the places of the member's values in the lists of the grid, unless the points of the grid have
/// their samples in common: more samples, and longer lists, leave the others as they were.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The scene that is varied, with the method, the step and the duration of the sweep.
    pub scene: AnyScene,
    /// Number of steps between two looks for extremes.
    pub every: u64,
    /// Whether the sweep computes the largest Lyapunov exponent of every member.
    pub exponent: bool,
    /// The text of the sweep's file.
    pub file: String,
    text: Table,
    origin: String,
    grid: Vec<(String, Vec<f64>)>,
    random: Vec<(String, Draw)>,
    /// The names of the methods, if the sweep varies them.
    methods: Vec<String>,
    samples: u64,
    seed: u64,
    /// Whether the points of the grid have the same samples.
    common: bool,
}

/// What is wrong with a sweep.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The sweep's file, with its line, or the scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A member's value for a key makes no scene.
    #[error("{origin}: `{key}` {problem}")]
    Key {
        /// The scene.
        origin: String,
        /// The key.
        key: String,
        /// The problem, and the accepted values.
        problem: String,
    },
}

impl Sweep {
    /// Reads the sweep in that file; `methods` are the names that a method may have.
    ///
    /// # Errors
    /// [`SweepError`] with the first fault of the sweep or of its scene.
    pub fn load(path: &str, methods: &[&str]) -> Result<Self, SweepError> {
        Self::load_with(path, &[], methods)
    }

    /// Reads the sweep in that file, with other values in its scene.
    ///
    /// # Errors
    /// As [`load`](Self::load), also where a setting has no place in the scene.
    pub fn load_with(path: &str, settings: &[Setting], methods: &[&str]) -> Result<Self, SweepError> {
        Self::read(&file::read(path)?, path, settings, methods)
    }

    /// Reads a sweep from text; `origin` is the file's name.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn parse(text: &str, origin: &str, methods: &[&str]) -> Result<Self, SweepError> {
        Self::read(text, origin, &[], methods)
    }

    fn read(text: &str, origin: &str, settings: &[Setting], methods: &[&str]) -> Result<Self, SweepError> {
        // A byte-order mark is no part of the first line.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let document = Document { origin, text };
        let entries = DeTable::parse(text).map_err(|error| document.syntax(&error))?.into_inner();
        let known = ["scene", "method", "step", "duration", "grid", "random", "output"];
        let root = TomlTable::whole(document, &entries).with_keys_of("a sweep", &known)?;
        let accepted = "a scene file, or the name of a bundled scene, in quotes";
        let name = root.text("scene", accepted)?.ok_or_else(|| root.missing("scene", accepted.to_owned()))?;
        let method = root.text("method", &format!("a string, one of {}", suggest::list(methods)))?;
        let (step, duration) = (root.number(&STEP)?, root.number(&DURATION)?);
        let name = &file::scene_of_sweep(origin, name);
        let bundled_text = bundled::named(name).map(|scene| scene.text.to_owned());
        let scene_text = bundled_text.map_or_else(|| file::read(name), Ok)?;
        let scene = parse_with(&scene_text, name, settings, |text, origin| AnyScene::parse(text, origin, methods))?;
        let scene_text = with_settings(&scene_text, name, settings)?;
        let overrides = Overrides { method, step, duration, alpha: None };
        let scene = scene.with_overrides(&overrides, methods).map_err(|error| in_sweep(&root, error))?;
        let mut table: Table = scene_text.parse().unwrap_or_default();
        if let Some(Value::Table(run)) = table.get_mut("run") {
            let numbers = [("step", step), ("duration", duration)];
            let set = numbers.into_iter().filter_map(|(key, value)| Some((key, Value::Float(value?))));
            let method = method.map(|method| ("method", Value::String(method.to_owned())));
            for (key, value) in set.chain(method) {
                run.insert(key.to_owned(), value);
            }
        }

        let (grid, random) = variation::read(&root)?;
        // What no member could have is said before the first one.
        let (unknown, accepted): (&dyn Fn(&str) -> bool, _) = match &scene {
            AnyScene::Sleigh(_) => (&|key| set(&mut table.clone(), key, 0.0).is_none(), NUMBERS),
            AnyScene::Text(scene) => (&|key| !scene.varies(key), varied::NUMBERS),
        };
        let unknown = |key: &str| !RUN.contains(&key) && unknown(key);
        if let Some(leaf) = grid.iter().find(|leaf| unknown(&leaf.key)) {
            return Err(leaf.fail(&root, UNKNOWN, accepted).into());
        }
        let drawn = |key: &str| unknown(key) || key == variation::METHOD;
        if let Some(leaf) = random.iter().find(|leaf| drawn(&leaf.key)) {
            return Err(leaf.fail(&root, UNKNOWN, accepted).into());
        }
        let names = grid.iter().find(|leaf| leaf.key == variation::METHOD);
        let names = names.map(|leaf| variation::method_names(&root, leaf, methods)).transpose()?.unwrap_or_default();
        let section = |name| root.section(name);
        let (choice, output) = (section("random")?, section("output")?);
        let output = output.map(|output| output.with_keys_of("a sweep", &["every", "exponent"])).transpose()?;
        let whole =
            |table: &Option<TomlTable<'_>>, key| table.as_ref().map_or(Ok(None), |table| table.whole_number(key));
        let truth = |table: &Option<TomlTable<'_>>, key| table.as_ref().map_or(Ok(false), |table| table.truth(key));
        let samples = whole(&choice, "count")?.unwrap_or(1);
        let sweep = Self {
            every: whole(&output, "every")?.unwrap_or_else(|| scene.run().steps().div_ceil(100)).max(1),
            exponent: truth(&output, "exponent")?,
            seed: whole(&choice, "seed")?.unwrap_or(0),
            common: truth(&choice, "common")?,
            scene,
            file: text.to_owned(),
            text: table,
            origin: name.to_owned(),
            grid: grid.into_iter().map(|leaf| (leaf.key, leaf.values)).collect(),
            random: random.into_iter().map(|leaf| (leaf.key, leaf.values)).collect(),
            methods: names,
            samples,
        };
        let mut grid = sweep.grid.iter().map(|(_, values)| values.len() as u64);
        match grid.try_fold(samples, |count: u64, values| count.checked_mul(values)) {
            Some(1..=MOST) => Ok(sweep),
            _ => {
                let table = choice.unwrap_or(root);
                let problem = "gives no members, or more than 1e12 members";
                let accepted = "a count that, times the number of values of each key of the grid, is from 1 to 1e12";
                Err(table.wrong("count", problem, accepted.to_owned()).into())
            }
        }
    }

    /// How many members there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.grid.iter().fold(self.samples, |count, (_, values)| count * values.len() as u64)
    }

    /// The keys that vary, grid before samples.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.grid.iter().map(|(key, _)| key.as_str()).chain(self.random.iter().map(|(key, _)| key.as_str()))
    }

    /// The values of the keys for a member.
    #[must_use]
    pub fn values(&self, member: u64) -> Vec<f64> {
        self.keys().map(|key| self.value(member, key)).collect()
    }

    fn value(&self, member: u64, key: &str) -> f64 {
        let mut point = member / self.samples;
        for (name, values) in self.grid.iter().rev() {
            let count = values.len() as u64;
            if name == key {
                return values[(point % count) as usize];
            }
            point /= count;
        }
        let found = self.random.iter().find(|(name, _)| name == key);
        found.map_or(f64::NAN, |(_, draw)| draw.sample(self.stream(member).named(key)))
    }

    /// What a member's random numbers belong to: the seed, its values' places in the lists of the grid, and its sample.
    fn stream(&self, member: u64) -> Stream {
        let mut stream = Stream::of(self.seed);
        if !self.common {
            let mut point = member / self.samples;
            for (name, values) in self.grid.iter().rev() {
                let count = values.len() as u64;
                stream = stream.named(name).and(point % count);
                point /= count;
            }
        }
        stream.and(member % self.samples)
    }

    /// The scene of a member.
    ///
    /// # Errors
    /// [`SweepError`] where its values make no scene.
    pub fn member(&self, member: u64, methods: &[&str]) -> Result<AnyScene, SweepError> {
        let values: Vec<_> = self.keys().map(|key| (key.to_owned(), self.value(member, key))).collect();
        self.with(&values, methods)
    }

    /// Whether members are run in different ways: with other steps, durations or methods.
    #[must_use]
    pub fn varies_run(&self) -> bool {
        self.keys().any(|key| RUN.contains(&key))
    }

    /// The scene with other values.
    fn with(&self, values: &[(String, f64)], methods: &[&str]) -> Result<AnyScene, SweepError> {
        let (run, values): (Vec<_>, Vec<_>) = values.iter().cloned().partition(|(key, _)| RUN.contains(&key.as_str()));
        let scene = match &self.scene {
            AnyScene::Sleigh(scene) => {
                self.sleigh((**scene).clone(), &values, methods).map(Box::new).map(AnyScene::Sleigh)?
            }
            AnyScene::Text(scene) => {
                let varied = scene.with_values(&values).map_err(|(key, problem)| self.fail(&key, problem))?;
                AnyScene::Text(Box::new(varied))
            }
        };
        if run.is_empty() { Ok(scene) } else { self.run_with(scene, &run, methods) }
    }

    /// A scene that is run in another way.
    fn run_with(&self, scene: AnyScene, run: &[(String, f64)], methods: &[&str]) -> Result<AnyScene, SweepError> {
        let of = |key: &str| run.iter().find(|(known, _)| known == key).map(|(_, value)| *value);
        let method = of(variation::METHOD).and_then(|place| self.methods.get(place as usize));
        let overrides = Overrides {
            method: method.map(String::as_str),
            step: of("run.step"),
            duration: of("run.duration"),
            alpha: of("run.alpha"),
        };
        let outcome = scene.with_overrides(&overrides, methods);
        let mut scene = outcome.map_err(|error| {
            let finding = error.finding();
            let field = finding.and_then(|finding| finding.field.as_deref()).unwrap_or_default().replace("--", "run.");
            let problem = finding.map_or_else(|| error.to_string(), |finding| finding.problem.clone());
            self.fail(&field, problem)
        })?;
        if let Some(tolerance) = of("run.tolerance") {
            if !(tolerance.is_finite() && tolerance > 0.0) {
                return Err(self.fail("run.tolerance", format!("is {tolerance:?}, and not a positive number")));
            }
            scene.run_mut().tolerance = Some(tolerance);
        }
        Ok(scene)
    }

    /// A sleigh with other values.
    fn sleigh(&self, mut scene: Scene, values: &[(String, f64)], methods: &[&str]) -> Result<Scene, SweepError> {
        let mut body = [scene.sleigh.mass(), scene.sleigh.inertia(), scene.sleigh.offset()];
        let mut deep = None;
        for (key, value) in values {
            let place = match key.as_str() {
                "start.x" => &mut scene.start.x,
                "start.y" => &mut scene.start.y,
                "start.heading" => &mut scene.start.heading,
                "start.speed" => &mut scene.start.speed,
                "start.turn_rate" => &mut scene.start.turn_rate,
                "sleigh.mass" => &mut body[0],
                "sleigh.inertia" => &mut body[1],
                "sleigh.offset" => &mut body[2],
                _ => {
                    let table = deep.get_or_insert_with(|| self.text.clone());
                    set(table, key, *value).ok_or_else(|| self.fail(key, UNKNOWN.to_owned()))?;
                    continue;
                }
            };
            *place = *value;
        }
        if let Some(mut table) = deep {
            // A scene is checked as a whole: its text says all of it.
            for (key, value) in values {
                set(&mut table, key, *value).ok_or_else(|| self.fail(key, UNKNOWN.to_owned()))?;
            }
            return Ok(Scene::parse(&table.to_string(), &self.origin, methods)?);
        }
        if let Some((key, value)) = values.iter().find(|(_, value)| !value.is_finite()) {
            return Err(self.fail(key, format!("is {value}, and not finite")));
        }
        let [mass, inertia, offset] = body;
        scene.sleigh = Sleigh::new(mass, inertia, offset)
            .map_err(|error| self.fail("sleigh", format!("does not give a sleigh: {error}")))?;
        Ok(scene)
    }

    /// All that its rows depend on: not the text of its file, since comments change no row, and not where its scene lies.
    #[must_use]
    pub fn contents(&self) -> String {
        format!("{:?}", Self { file: String::new(), origin: String::new(), ..self.clone() })
    }

    fn fail(&self, key: &str, problem: String) -> SweepError {
        SweepError::Key { origin: self.origin.clone(), key: key.to_owned(), problem }
    }
}

/// Sets the number at a path of keys, and of indices of lists; none where there is no number yet, or no scene could have one.
fn set(table: &mut Table, path: &str, value: f64) -> Option<()> {
    // How a scene is run is the same for all members.
    let fixed = !["start.", "sleigh.", "effects."].iter().any(|home| path.starts_with(home));
    if fixed {
        return None;
    }
    let (parents, last) = path.rsplit_once('.')?;
    let mut parents = parents.split('.');
    let mut place = table.get_mut(parents.next()?)?;
    for key in parents {
        place = match place {
            Value::Table(table) => table.get_mut(key)?,
            Value::Array(list) => list.get_mut(key.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    match place {
        Value::Table(table) if COMMON.contains(&path) => drop(table.insert(last.to_owned(), Value::Float(value))),
        Value::Table(table) => {
            *table.get_mut(last).filter(|old| old.is_float() || old.is_integer())? = Value::Float(value);
        }
        Value::Array(list) => *list.get_mut(last.parse::<usize>().ok()?)? = Value::Float(value),
        _ => return None,
    }
    Some(())
}

/// An error of the settings that a sweep gives its scene, at the place in the sweep's file.
fn in_sweep(root: &TomlTable<'_>, error: SceneError) -> SceneError {
    let variant =
        if matches!(error, SceneError::UnknownName(_)) { SceneError::UnknownName } else { SceneError::OutOfRange };
    let given = ["method", "step", "duration"].into_iter().find_map(|key| {
        let finding = error.finding()?;
        (finding.field.as_deref()?.strip_prefix("--") == Some(key)).then_some((key, finding))
    });
    match given {
        Some((key, finding)) => root.fail(
            Fault::new(variant, key, finding.problem.clone(), finding.accepted.clone()).help(finding.help.clone()),
        ),
        None => error,
    }
}
