use super::{Expression, Graph, NodeKind, Number};
use crate::{Error, Names};
use std::collections::HashMap;

/// Names with the texts that they stand for, and texts in which they stand.
pub type Statements = (Vec<(String, String)>, Vec<String>);

/// The names of shared expressions.
type Shared = HashMap<Expression, String>;

/// The loosest operation in a text that stands without parentheses: a sum, a product, a power, or none.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum TextLevel {
    Sum,
    Product,
    Power,
    Word,
}

/// A part of a text that is still to be written.
enum TextPiece {
    Text(&'static str),
    Number(f64),
    Part(Expression, TextLevel),
}

impl Graph {
    /// An expression as a text, in which shared parts are written out wherever they occur. The table names the variables by their numbers.
    ///
    /// [`parse`](crate::parse) and [`build`](Self::build) make the same expression of it.
    ///
    /// ```
    /// use expression::{Graph, Names, parse};
    /// let names = Names::of(["m", "x", "x'"])?;
    /// let mut graph = Graph::new();
    /// let variables = [0, 1, 2].map(|k| graph.variable(k));
    /// let e = graph.build(&parse("-(-m/2*x_dot**2 + 1)*sqrt(x)/x", &names)?, &variables)?;
    /// assert_eq!(graph.text(e, &names)?, "(0.5*m*x'^2 - 1)/sqrt(x)");
    /// # Ok::<(), expression::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::TextTooLong`].
    pub fn text(&self, e: Expression, names: &Names) -> Result<String, Error> {
        self.text_with(e, names, &Shared::new())
    }

    /// Expressions as texts, in which shared parts have names: `word` with a number. Returns the statements, each a name with its text,
    /// in the order of use, and the texts of the expressions.
    ///
    /// ```
    /// use expression::{Graph, Names, parse};
    /// let names = Names::of(["x", "y"])?;
    /// let mut graph = Graph::new();
    /// let variables = [0, 1].map(|k| graph.variable(k));
    /// let e = graph.build(&parse("sin(x*y) + sin(x*y)^2*y", &names)?, &variables)?;
    /// let (statements, texts) = graph.statements(&[e], &names, "s")?;
    /// assert_eq!(statements, [("s1".to_owned(), "sin(x*y)".to_owned())]);
    /// assert_eq!(texts, ["s1 + y*s1^2"]);
    /// # Ok::<(), expression::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::TextTooLong`].
    pub fn statements(&self, all: &[Expression], names: &Names, word: &str) -> Result<Statements, Error> {
        let mut uses: HashMap<Expression, usize> = HashMap::new();
        let reached = self.reached(all, |_| true);
        for &e in &reached {
            self.kind(e).parts().for_each(|part| *uses.entry(part).or_default() += 1);
        }
        all.iter().for_each(|e| *uses.entry(*e).or_default() += 1);
        let (mut shared, mut statements) = (Shared::new(), Vec::new());
        for e in reached {
            let simple = matches!(self.kind(e), NodeKind::Variable(_) | NodeKind::Constant(_));
            if !simple && uses.get(&e).is_some_and(|&uses| uses > 1) {
                let name = format!("{word}{}", statements.len() + 1);
                statements.push((name.clone(), self.text_with(e, names, &shared)?));
                shared.insert(e, name);
            }
        }
        let texts = all.iter().map(|&e| self.text_with(e, names, &shared)).collect::<Result<_, _>>()?;
        Ok((statements, texts))
    }

    fn text_with(&self, e: Expression, names: &Names, shared: &Shared) -> Result<String, Error> {
        let limit = self.limits.length;
        let (mut text, mut waiting) = (String::new(), vec![TextPiece::Part(e, TextLevel::Sum)]);
        while let Some(piece) = waiting.pop() {
            match piece {
                TextPiece::Text(word) => text.push_str(word),
                TextPiece::Number(x) => text.push_str(&number(x)),
                TextPiece::Part(e, least) => {
                    if let Some(name) = shared.get(&e) {
                        text.push_str(name);
                        continue;
                    }
                    if let &NodeKind::Variable(k) = self.kind(e) {
                        let name = names.all().get(k as usize);
                        text.push_str(&name.cloned().unwrap_or_else(|| format!("variable_{k}")));
                        continue;
                    }
                    let (level, mut pieces) = self.pieces(e, shared);
                    if level < least {
                        pieces.insert(0, TextPiece::Text("("));
                        pieces.push(TextPiece::Text(")"));
                    }
                    waiting.extend(pieces.into_iter().rev());
                }
            }
            if text.len() > limit || waiting.len() > limit {
                return Err(Error::TextTooLong { limit });
            }
        }
        Ok(text)
    }

    fn pieces(&self, e: Expression, shared: &Shared) -> (TextLevel, Vec<TextPiece>) {
        match self.kind(e) {
            NodeKind::Constant(x) => constant(x.value()),
            NodeKind::Variable(_) => (TextLevel::Word, Vec::new()),
            NodeKind::Sum { constant, terms } => {
                let mut pieces = Vec::new();
                for &(term, c) in terms {
                    pieces.push(sign(c.value(), pieces.is_empty()));
                    pieces.extend(self.multiple(c.value().abs(), term, shared));
                }
                let single = terms.len() == 1 && *constant == Number::ZERO;
                let positive = terms.first().is_some_and(|(_, c)| c.value() > 0.0);
                if *constant != Number::ZERO {
                    pieces.push(sign(constant.value(), pieces.is_empty()));
                    pieces.push(TextPiece::Number(constant.value().abs()));
                }
                (if single && positive { TextLevel::Product } else { TextLevel::Sum }, pieces)
            }
            NodeKind::Product(factors) => match **factors {
                [(base, halves)] if halves > 0 => {
                    (if halves == 1 { TextLevel::Word } else { TextLevel::Power }, factor(base, halves))
                }
                _ => (TextLevel::Product, self.multiple(1.0, e, shared)),
            },
            NodeKind::Power(base, p) => (TextLevel::Power, raised(*base, p.value())),
            NodeKind::Call(function, [a, b]) => {
                let mut pieces =
                    vec![TextPiece::Text(function.name()), TextPiece::Text("("), TextPiece::Part(*a, TextLevel::Sum)];
                if function.arguments() == 2 {
                    pieces.extend([TextPiece::Text(", "), TextPiece::Part(*b, TextLevel::Sum)]);
                }
                pieces.push(TextPiece::Text(")"));
                (TextLevel::Word, pieces)
            }
        }
    }

    /// `c` times a term, `c` not negative.
    fn multiple(&self, c: f64, term: Expression, shared: &Shared) -> Vec<TextPiece> {
        let single = [(term, 2)];
        let factors = match self.kind(term) {
            NodeKind::Product(factors) if !shared.contains_key(&term) => &**factors,
            _ => &single,
        };
        let mut pieces = Vec::new();
        if c.to_bits() != 1.0_f64.to_bits() || factors.iter().all(|&(_, halves)| halves < 0) {
            pieces.push(TextPiece::Number(c));
        }
        for &(base, halves) in factors.iter().filter(|(_, halves)| *halves > 0) {
            if !pieces.is_empty() {
                pieces.push(TextPiece::Text("*"));
            }
            pieces.extend(factor(base, halves));
        }
        let below: Vec<_> = factors.iter().filter(|(_, halves)| *halves < 0).collect();
        if let [first, rest @ ..] = &below[..] {
            pieces.push(TextPiece::Text(if rest.is_empty() { "/" } else { "/(" }));
            pieces.extend(factor(first.0, -first.1));
            for (base, halves) in rest {
                pieces.push(TextPiece::Text("*"));
                pieces.extend(factor(*base, -halves));
            }
            if !rest.is_empty() {
                pieces.push(TextPiece::Text(")"));
            }
        }
        pieces
    }
}

fn sign(x: f64, first: bool) -> TextPiece {
    TextPiece::Text(match (x < 0.0, first) {
        (true, true) => "-",
        (false, true) => "",
        (true, false) => " - ",
        (false, false) => " + ",
    })
}

/// A constant by itself: negative ones and those that are no number are written as operations.
fn constant(x: f64) -> (TextLevel, Vec<TextPiece>) {
    if x.is_nan() {
        (TextLevel::Product, vec![TextPiece::Text("0/0")])
    } else if x.is_infinite() {
        (TextLevel::Sum, vec![sign(x, true), TextPiece::Text("1/0")])
    } else if x < 0.0 {
        (TextLevel::Sum, vec![sign(x, true), TextPiece::Number(-x)])
    } else {
        (TextLevel::Word, vec![TextPiece::Number(x)])
    }
}

/// `base^(halves/2)` with a positive exponent.
fn factor(base: Expression, halves: i32) -> Vec<TextPiece> {
    match halves {
        1 => vec![TextPiece::Text("sqrt("), TextPiece::Part(base, TextLevel::Sum), TextPiece::Text(")")],
        2 => vec![TextPiece::Part(base, TextLevel::Power)],
        _ => raised(base, 0.5 * f64::from(halves)),
    }
}

fn raised(base: Expression, p: f64) -> Vec<TextPiece> {
    let (open, close) = if p < 0.0 { ("^(-", ")") } else { ("^", "") };
    vec![
        TextPiece::Part(base, TextLevel::Word),
        TextPiece::Text(open),
        TextPiece::Number(p.abs()),
        TextPiece::Text(close),
    ]
}

/// A number that is not negative, with as many digits as it has.
fn number(x: f64) -> String {
    let text = format!("{x:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_owned(),
        None => text,
    }
}
