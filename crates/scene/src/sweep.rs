use crate::bundled::bundled;
use crate::draw::Draw;
use crate::{Scene, SceneError, file, suggest};
use sleigh::Sleigh;
use thiserror::Error;
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

const UNKNOWN: &str = "is no number that the scene has; accepted are keys of its start, its sleigh and its effects, like \
                       start.speed, sleigh.offset, effects.0.stiffness.1";

/// The most members of a sweep.
const MOST: u64 = 1_000_000_000_000;

/// Many variants of a scene: a grid of values, and random samples at each of its points.
///
/// Members are numbered; each is made from its number alone, so that any of them can be made at any time. Keys are in
/// the order of the alphabet; on the grid the last one varies fastest.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The scene that is varied, with the method, the step and the duration of the sweep.
    pub scene: Scene,
    /// Extremes are looked for at every so many steps.
    pub every: u64,
    /// Whether the largest Lyapunov exponent of every member is wanted.
    pub exponent: bool,
    text: Table,
    origin: String,
    grid: Vec<(String, Vec<f64>)>,
    random: Vec<(String, Draw)>,
    samples: u64,
    seed: u64,
}

/// What is wrong with the file of a sweep.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The scene, or the file itself.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The file is not TOML.
    #[error("{origin}: {problem}")]
    Syntax {
        /// The file.
        origin: String,
        /// What and where.
        problem: String,
    },
    /// A key has no possible value.
    #[error("{origin}: `{key}` {problem}")]
    Key {
        /// The file.
        origin: String,
        /// The key.
        key: String,
        /// What is wrong, and what is accepted.
        problem: String,
    },
}

impl Sweep {
    /// Reads the sweep in that file; `methods` are the names that a method may have.
    ///
    /// # Errors
    /// [`SweepError`] with the first thing that is wrong with it, or with its scene.
    pub fn load(path: &str, methods: &[&str]) -> Result<Self, SweepError> {
        Self::parse(&file::read(path)?, path, methods)
    }

    /// Reads a sweep from text; `origin` is the file's name.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn parse(text: &str, origin: &str, methods: &[&str]) -> Result<Self, SweepError> {
        let file: Table = text.parse().map_err(|error: toml::de::Error| SweepError::Syntax {
            origin: origin.to_owned(),
            problem: error.to_string(),
        })?;
        let reader = Reader { origin };
        reader.known("", &file, &["scene", "method", "step", "duration", "grid", "random", "output"])?;
        let name = reader
            .text(&file, "scene")?
            .ok_or_else(|| reader.fail("scene", "is missing: a file, or the name of a bundled scene"))?;
        let bundled_text =
            bundled().iter().find(|scene| scene.name == name.replace('_', "-")).map(|scene| scene.text.to_owned());
        let scene_text = bundled_text.map_or_else(|| file::read(name), Ok)?;
        let method = reader.text(&file, "method")?;
        let (step, duration) = (reader.number(&file, "step")?, reader.number(&file, "duration")?);
        let mut table: Table =
            Scene::parse(&scene_text, name, methods).and(Ok(scene_text.parse().unwrap_or_default()))?;
        if let Some(Value::Table(run)) = table.get_mut("run") {
            let numbers = [("step", step), ("duration", duration)];
            let set = numbers.into_iter().filter_map(|(key, value)| Some((key, Value::Float(value?))));
            let method = method.map(|method| ("method", Value::String(method.to_owned())));
            for (key, value) in set.chain(method) {
                run.insert(key.to_owned(), value);
            }
        }
        let scene = Scene::parse(&table.to_string(), name, methods)?;

        let (mut grid, mut random) = (Vec::new(), Vec::new());
        for (key, value) in reader.leaves(&file, "grid", &[])? {
            let values = reader.values(&key, value)?;
            grid.push((key, values));
        }
        for (key, value) in reader.leaves(&file, "random", &["count", "seed"])? {
            let draw = Draw::read(value).map_err(|problem| reader.fail(&key, &problem))?;
            random.push((key, draw));
        }
        let section = |name: &str| file.get(name).and_then(Value::as_table).cloned().unwrap_or_default();
        let (choice, output) = (section("random"), section("output"));
        reader.known("output", &output, &["every", "exponent"])?;
        let samples = reader.whole(&choice, "count")?.unwrap_or(1);
        let sweep = Self {
            every: reader.whole(&output, "every")?.unwrap_or_else(|| scene.run.steps().div_ceil(100)).max(1),
            exponent: match output.get("exponent") {
                None => false,
                Some(Value::Boolean(exponent)) => *exponent,
                Some(_) => return Err(reader.fail("output.exponent", "is neither true nor false")),
            },
            seed: reader.whole(&choice, "seed")?.unwrap_or(0),
            scene,
            text: table,
            origin: name.to_owned(),
            grid,
            random,
            samples,
        };
        let count = sweep.grid.iter().try_fold(samples, |count, (_, values)| count.checked_mul(values.len() as u64));
        if count.is_none_or(|count| count == 0 || count > MOST) {
            return Err(reader.fail("random.count", "makes no members, or more than 1e12 of them"));
        }
        // What no member could have is said before the first one.
        let unknown = sweep.keys().find(|key| set(&mut sweep.text.clone(), key, 0.0).is_none()).map(str::to_owned);
        match unknown {
            Some(key) => Err(reader.fail(&key, UNKNOWN)),
            None => Ok(sweep),
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
        let found = self.random.iter().enumerate().find(|(_, (name, _))| name == key);
        found.map_or(f64::NAN, |(i, (_, draw))| draw.sample(self.seed, member, i as u64))
    }

    /// The scene of a member.
    ///
    /// # Errors
    /// [`SweepError`] where its values make no scene.
    pub fn member(&self, member: u64, methods: &[&str]) -> Result<Scene, SweepError> {
        let values: Vec<_> = self.keys().map(|key| (key.to_owned(), self.value(member, key))).collect();
        self.with(&values, methods)
    }

    /// The scene with other values.
    fn with(&self, values: &[(String, f64)], methods: &[&str]) -> Result<Scene, SweepError> {
        let mut scene = self.scene.clone();
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
            .map_err(|error| self.fail("sleigh", format!("makes no sleigh: {error}")))?;
        Ok(scene)
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
        Value::Table(table) => *table.get_mut(last).filter(|old| number(old).is_some())? = Value::Float(value),
        Value::Array(list) => *list.get_mut(last.parse::<usize>().ok()?)? = Value::Float(value),
        _ => return None,
    }
    Some(())
}

struct Reader<'a> {
    origin: &'a str,
}

impl Reader<'_> {
    fn fail(&self, key: &str, problem: &str) -> SweepError {
        SweepError::Key { origin: self.origin.to_owned(), key: key.to_owned(), problem: problem.to_owned() }
    }

    fn known(&self, path: &str, table: &Table, keys: &[&str]) -> Result<(), SweepError> {
        match table.keys().find(|key| !keys.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) => Err(self.fail(
                &format!("{path}{}{key}", if path.is_empty() { "" } else { "." }),
                &format!("is no key of a sweep; accepted are {}", suggest::list(keys)),
            )),
        }
    }

    fn text<'t>(&self, table: &'t Table, key: &str) -> Result<Option<&'t str>, SweepError> {
        match table.get(key) {
            None => Ok(None),
            Some(Value::String(text)) => Ok(Some(text)),
            Some(_) => Err(self.fail(key, "is no text in quotes")),
        }
    }

    fn number(&self, table: &Table, key: &str) -> Result<Option<f64>, SweepError> {
        let Some(value) = table.get(key) else { return Ok(None) };
        number(value).map(Some).ok_or_else(|| self.fail(key, "is no finite number"))
    }

    fn whole(&self, table: &Table, key: &str) -> Result<Option<u64>, SweepError> {
        let Some(value) = table.get(key) else { return Ok(None) };
        let whole = value.as_integer().and_then(|whole| u64::try_from(whole).ok());
        whole.map(Some).ok_or_else(|| self.fail(key, "is no whole number from 0 on"))
    }

    /// The keys below a table, dotted, with their values: a table that says how a number varies has no table in it.
    fn leaves<'t>(&self, file: &'t Table, section: &str, own: &[&str]) -> Result<Vec<(String, &'t Value)>, SweepError> {
        let table = match file.get(section) {
            None => return Ok(Vec::new()),
            Some(Value::Table(table)) => table,
            Some(_) => return Err(self.fail(section, "is no table")),
        };
        let mut found = Vec::new();
        let mut open: Vec<(String, &Value)> = table
            .iter()
            .rev()
            .filter(|(key, _)| !own.contains(&key.as_str()))
            .map(|(key, value)| (key.clone(), value))
            .collect();
        while let Some((path, value)) = open.pop() {
            match value {
                Value::Table(inner)
                    if !["from", "uniform", "normal", "log_uniform"].iter().any(|key| inner.contains_key(*key)) =>
                {
                    open.extend(inner.iter().rev().map(|(key, value)| (format!("{path}.{key}"), value)));
                }
                value => found.push((path, value)),
            }
        }
        Ok(found)
    }

    /// The values of a key of the grid.
    fn values(&self, key: &str, value: &Value) -> Result<Vec<f64>, SweepError> {
        let accepted = "is neither a list of numbers nor { from, to, count }";
        let values: Option<Vec<f64>> = match value {
            Value::Array(list) => list.iter().map(number).collect(),
            Value::Table(range) => {
                self.known(key, range, &["from", "to", "count"])?;
                let ends = range.get("from").and_then(number).zip(range.get("to").and_then(number));
                let count = range.get("count").and_then(Value::as_integer).and_then(|n| u32::try_from(n).ok());
                ends.zip(count).map(|((from, to), count)| {
                    let part = |i: u32| f64::from(i) / f64::from(count.max(2) - 1);
                    (0..count).map(|i| (1.0 - part(i)) * from + part(i) * to).collect()
                })
            }
            _ => None,
        };
        values.filter(|values| !values.is_empty()).ok_or_else(|| self.fail(key, accepted))
    }
}

/// A finite number.
pub(crate) fn number(value: &Value) -> Option<f64> {
    let number = value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64));
    number.filter(|number| number.is_finite())
}
