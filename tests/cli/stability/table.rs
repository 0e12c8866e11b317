//! The table of what comes of every case and method.

use std::fmt;

#[derive(Debug)]
struct Row {
    case: String,
    method: String,
    passes: bool,
    why: String,
}

/// In the order in which the program prints it; as text a line for the case, one of methods that pass and one of those that refuse.
#[derive(Debug, Default)]
pub(crate) struct Table(Vec<Row>);

fn named(passes: bool) -> &'static str {
    if passes { "pass" } else { "refused" }
}

impl Table {
    pub(crate) fn add(&mut self, case: &str, method: &str, passes: bool, why: &str) {
        self.0.push(Row { case: case.to_owned(), method: method.to_owned(), passes, why: why.to_owned() });
    }

    pub(crate) fn parse(text: &str) -> Self {
        let (mut table, mut case) = (Self::default(), "");
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            match line.strip_prefix("  ").map(|line| line.split_once(':').unwrap()) {
                None => case = line,
                Some((outcome, methods)) => {
                    let passes = outcome == named(true);
                    assert!(passes || outcome == named(false), "{line}");
                    methods.split_whitespace().for_each(|method| table.add(case, method, passes, ""));
                }
            }
        }
        table
    }

    /// The cases, in their order.
    pub(crate) fn cases(&self) -> Vec<&str> {
        let mut cases: Vec<_> = self.0.iter().map(|row| row.case.as_str()).collect();
        cases.dedup();
        cases
    }

    /// Every method of a case, and whether it passes.
    pub(crate) fn of(&self, case: &str) -> Vec<(&str, bool)> {
        self.0.iter().filter(|row| row.case == case).map(|row| (row.method.as_str(), row.passes)).collect()
    }

    /// The rows of a case, with these methods or with all.
    pub(crate) fn part(&self, case: &str, methods: Option<&[&str]>) -> Self {
        let mut part = Self::default();
        for (method, passes) in self.of(case) {
            if methods.is_none_or(|methods| methods.contains(&method)) {
                part.add(case, method, passes, "");
            }
        }
        part
    }

    fn row(&self, case: &str, method: &str) -> Option<&Row> {
        self.0.iter().find(|row| row.case == case && row.method == method)
    }

    /// A line for each pair that is another one in the other table, or in one of the two alone.
    pub(crate) fn differences(&self, expected: &Self) -> Vec<String> {
        let told = self.0.iter().filter_map(|Row { case, method, passes, why }| {
            let before = expected.row(case, method).map_or("nothing", |row| named(row.passes));
            let now = named(*passes);
            (now != before).then(|| format!("{case}, {method}: {now}, where {before} is expected: {why}"))
        });
        let missing = expected.0.iter().filter(|row| self.row(&row.case, &row.method).is_none());
        let missing = missing.map(|Row { case, method, passes, .. }| {
            format!("{case}, {method}: nothing, where {} is expected", named(*passes))
        });
        told.chain(missing).collect()
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# What comes of every hard case and method; written by tests/cli/stability.rs, which says how.")?;
        for case in self.cases() {
            writeln!(f, "{case}")?;
            for outcome in [true, false] {
                let of_it = self.of(case);
                let methods = of_it.iter().filter(|(_, passes)| *passes == outcome).map(|(method, _)| *method);
                let methods: Vec<_> = methods.collect();
                if !methods.is_empty() {
                    writeln!(f, "  {}: {}", named(outcome), methods.join(" "))?;
                }
            }
        }
        Ok(())
    }
}
