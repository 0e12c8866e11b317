use expression::formulas::{Entry, Unit, Words};
use proc_macro2::Span;
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream};
use syn::{Attribute, Error, Expr, Ident, LitStr, Path, Result, Token, Visibility, braced, bracketed};

/// The input of the macro: the system's texts with their places.
pub(crate) struct Described {
    /// The crate `lagrangian`.
    pub(crate) lagrangian: Path,
    pub(crate) kind: Kind,
    pub(crate) name: Ident,
    pub(crate) words: Words,
    /// The parameters: with a number for a new structure, with an expression for an existing one.
    pub(crate) parameters: Vec<(Ident, Expr)>,
    places: Vec<(Entry, Span)>,
}

/// The structure that becomes the system.
pub(crate) enum Kind {
    /// A structure to be made.
    New(Vec<Attribute>, Visibility),
    /// An existing structure.
    There,
}

impl Described {
    /// The place of an entry in the source; the place of the system's name if the entry has none.
    pub(crate) fn place(&self, entry: Entry) -> Span {
        self.places.iter().find(|(other, _)| *other == entry).map_or_else(|| self.name.span(), |(_, span)| *span)
    }
}

/// The keys of a system.
const KEYS: [&str; 9] =
    ["coordinates", "parameters", "let", "lagrangian", "constraints", "positions", "forces", "basis", "outputs"];

impl Parse for Described {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let lagrangian = input.parse()?;
        input.parse::<Token![;]>()?;
        let attributes = input.call(Attribute::parse_outer)?;
        let kind = if attributes.is_empty() && input.peek(Token![impl]) {
            input.parse::<Token![impl]>()?;
            Kind::There
        } else {
            let visibility = input.parse()?;
            input.parse::<Token![struct]>()?;
            Kind::New(attributes, visibility)
        };
        let name = input.parse()?;
        input.parse::<Token![;]>()?;
        let (words, parameters, places) = (Words::default(), Vec::new(), Vec::new());
        let mut described = Self { lagrangian, kind, name, words, parameters, places };
        let mut seen: Vec<String> = Vec::new();
        while !input.is_empty() {
            let key = input.call(Ident::parse_any)?;
            let name = key.to_string();
            if seen.contains(&name) {
                return Err(Error::new(key.span(), format!("`{name}` is given twice")));
            }
            input.parse::<Token![=]>()?;
            described.entry(&key, &name, input)?;
            seen.push(name);
        }
        for needed in ["coordinates", "lagrangian"] {
            if !seen.iter().any(|key| key == needed) {
                return Err(Error::new(described.name.span(), format!("a system needs `{needed}`")));
            }
        }
        Ok(described)
    }
}

impl Described {
    fn entry(&mut self, key: &Ident, name: &str, input: ParseStream<'_>) -> Result<()> {
        match name {
            "coordinates" => {
                for (k, (name, unit)) in table::<LitStr>(input)?.into_iter().enumerate() {
                    self.places.push((Entry::Coordinate(k), name.span()));
                    let unit = unit.value();
                    let unit = if unit == "angle" { Unit::Angle } else { Unit::Other(unit) };
                    self.words.coordinates.push((plain(&name), unit));
                }
            }
            "parameters" => {
                for (k, (name, value)) in table::<Expr>(input)?.into_iter().enumerate() {
                    self.places.push((Entry::Parameter(k), name.span()));
                    let number = match self.kind {
                        Kind::New(..) => number(&value)?,
                        Kind::There => 1.0,
                    };
                    self.words.parameters.push((plain(&name), number));
                    self.parameters.push((name, value));
                }
            }
            "let" => self.words.abbreviations = self.named(input, Entry::Abbreviation)?,
            "lagrangian" => {
                let text: LitStr = input.parse()?;
                self.places.push((Entry::Lagrangian, text.span()));
                self.words.lagrangian = text.value();
            }
            "constraints" => self.words.constraints = self.list(input, Entry::Constraint)?,
            "positions" => self.words.positions = self.list(input, Entry::Position)?,
            "forces" => self.words.forces = self.named(input, Entry::Force)?,
            "outputs" => self.words.outputs = self.named(input, Entry::Output)?,
            "basis" => {
                self.places.push((Entry::Basis, key.span()));
                let vectors;
                let bracket = bracketed!(vectors in input);
                let _ = bracket;
                while !vectors.is_empty() {
                    let k = self.words.basis.len();
                    self.places.push((Entry::Vector(k), vectors.span()));
                    let vector = self.list(&vectors, |i| Entry::Component(k, i))?;
                    self.words.basis.push(vector);
                    if !vectors.is_empty() {
                        vectors.parse::<Token![,]>()?;
                    }
                }
            }
            _ => {
                let near = expression::nearest(name, KEYS);
                let meant = near.map_or(".".to_owned(), |near| format!("; did you mean `{near}`?"));
                let known = KEYS.join("`, `");
                return Err(Error::new(key.span(), format!("a system has no `{name}`{meant} Its keys are `{known}`.")));
            }
        }
        Ok(())
    }

    /// A list of texts.
    fn list(&mut self, input: ParseStream<'_>, entry: impl Fn(usize) -> Entry) -> Result<Vec<String>> {
        let content;
        bracketed!(content in input);
        let texts = content.parse_terminated(<LitStr as Parse>::parse, Token![,])?;
        Ok(texts
            .into_iter()
            .enumerate()
            .map(|(k, text)| {
                self.places.push((entry(k), text.span()));
                text.value()
            })
            .collect())
    }

    /// A table of texts.
    fn named(&mut self, input: ParseStream<'_>, entry: fn(usize) -> Entry) -> Result<Vec<(String, String)>> {
        let texts = table::<LitStr>(input)?.into_iter().enumerate();
        Ok(texts
            .map(|(k, (name, text))| {
                self.places.push((entry(k), text.span()));
                (plain(&name), text.value())
            })
            .collect())
    }
}

/// `{ name = value, .. }`.
fn table<T: Parse>(input: ParseStream<'_>) -> Result<Vec<(Ident, T)>> {
    let content;
    braced!(content in input);
    let entry = |input: ParseStream<'_>| {
        let name = input.call(Ident::parse_any)?;
        input.parse::<Token![=]>()?;
        Ok((name, input.parse()?))
    };
    Ok(content.parse_terminated(entry, Token![,])?.into_iter().collect())
}

/// A name as written in formulas.
fn plain(name: &Ident) -> String {
    name.unraw().to_string()
}

/// A number, as a literal with its sign.
fn number(value: &Expr) -> Result<f64> {
    let text = value.to_token_stream().to_string().replace([' ', '_'], "");
    text.parse().map_err(|_| Error::new_spanned(value, "the value of a parameter is a number, as `1.0`"))
}
