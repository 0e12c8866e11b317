//! The hard cases as they stand in `cases/*.toml`: a scene, its runs, and checks by name with their bars.

use crate::error::CliError;
use harness::Method;
use harness::stability::{Case, Claim};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The scene of every case without a scene of its own.
pub(super) const SLEIGH: &str = include_str!("cases/sleigh.toml");

const FILES: [&str; 7] = [
    include_str!("cases/lists.toml"),
    include_str!("cases/free.toml"),
    include_str!("cases/numbers.toml"),
    include_str!("cases/fields.toml"),
    include_str!("cases/rest.toml"),
    include_str!("cases/driven.toml"),
    include_str!("cases/texts.toml"),
];

static CASES: LazyLock<Result<Cases, toml::de::Error>> = LazyLock::new(|| {
    FILES.iter().try_fold(Cases::default(), |mut all, text| {
        let Cases { lists, mut cases } = toml::from_str(text)?;
        // A case without runs of its own has one.
        cases.iter_mut().filter(|case| case.runs.is_empty()).for_each(|case| case.runs.push(Run::default()));
        all.lists.extend(lists);
        all.cases.extend(cases);
        Ok(all)
    })
});

/// The cases, and lists of checks that several of them share.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Cases {
    pub(super) lists: BTreeMap<String, Vec<Check>>,
    pub(super) cases: Vec<HardCase>,
}

/// All of them.
pub(super) fn all() -> Result<&'static Cases, CliError> {
    CASES.as_ref().map_err(|error| CliError::Computation(vec![format!("the hard cases: {error}")]))
}

/// A case, and what its runs have in common.
#[derive(Debug, Deserialize)]
pub(super) struct HardCase {
    name: String,
    hard: String,
    shows: String,
    bar: String,
    #[serde(with = "Claimed")]
    claim: Claim,
    #[serde(default)]
    refusable: bool,
    /// The settings that all runs share; its `methods` say which methods have a row.
    #[serde(flatten)]
    pub(super) shared: Run,
    #[serde(default)]
    pub(super) runs: Vec<Run>,
}

/// [`Claim`] by its name.
#[derive(Deserialize)]
#[serde(remote = "Claim", rename_all = "kebab-case")]
enum Claimed {
    Order,
    Constraint,
    SmallSpin,
    StableLine,
    Symmetry,
    Energy,
    Continuation,
    LightInertia,
    Stiffness,
}

/// A run. A field that is not given takes the value of its case.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Run {
    pub(super) label: String,
    /// Methods that make the run; empty for all.
    pub(super) methods: Vec<String>,
    /// A system of text, or an addition to the scene of the sleigh.
    pub(super) scene: String,
    /// Settings as on the command line, applied after the settings of the case.
    pub(super) set: Vec<String>,
    /// Speed (m/s) and spin (rad/s) at the start, for values that a scene does not accept.
    pub(super) beyond: Option<[f64; 2]>,
    /// Additional settings of a second run, with which this one is compared.
    pub(super) other: Option<Vec<String>>,
    /// Number of steps that count as already made.
    pub(super) from: u64,
    /// Stride of the recorded nodes.
    pub(super) every: u64,
    /// Whether the run turns round at its end and goes back.
    pub(super) back: bool,
    /// Formula whose largest size over the nodes is `largest` in bars.
    pub(super) largest: Option<String>,
    /// Abbreviations, `NAME = FORMULA`.
    #[serde(rename = "let")]
    pub(super) abbreviations: Vec<String>,
    /// Names of shared lists of checks.
    pub(super) like: Vec<String>,
    pub(super) checks: Vec<Check>,
}

/// A check. Formulas use the node, the first node (`x_0`), the other run (`other_x`) and the closed form (`exact_x`).
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Check {
    pub(super) kind: Kind,
    #[serde(default)]
    pub(super) of: Vec<String>,
    pub(super) what: Option<String>,
    #[serde(default)]
    pub(super) methods: Vec<String>,
    #[serde(default)]
    pub(super) except: Vec<String>,
    /// Time (s) at which the check begins.
    pub(super) from: Option<String>,
    /// The check ends at the first node whose value is no larger than this.
    pub(super) above: Option<String>,
    /// `own` in the bar is the error of a method with steps of this part of a time constant ..
    pub(super) part: Option<String>,
    /// .. over this number of time constants.
    pub(super) length: Option<String>,
    pub(super) bar: Option<String>,
}

/// The quantity that a check examines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
    Follows,
    Agrees,
    Size,
    Energy,
    Constraint,
    Ends,
    Constant,
    Nearest,
    Sign,
    /// The run must end with an error of dependent rows where this is zero.
    Dependent,
}

impl HardCase {
    /// The case, in words.
    pub(super) fn case(&'static self) -> Case {
        let Self { name, hard, shows, bar, claim, refusable, .. } = self;
        Case { name, hard, shows, bar, claim: *claim, refusable: *refusable }
    }

    /// Whether the case has a row for the method: systems of text are made by a few.
    pub(super) fn takes(&self, method: &Method) -> bool {
        makes(&self.shared.methods, method)
    }
}

/// Whether the list has the method. `gauss*` stands for all names that begin so, a leading `not` inverts the list, and an empty list has
/// all methods.
pub(super) fn makes(names: &[String], method: &Method) -> bool {
    let own = method.info().name;
    let named = |name: &String| name.strip_suffix('*').map_or(name == own, |begin| own.starts_with(begin));
    match names {
        [not, others @ ..] if not == "not" => !others.iter().any(named),
        names => names.is_empty() || names.iter().any(named),
    }
}
