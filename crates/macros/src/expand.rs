use crate::read::{Described, Kind};
use expression::Expression;
use expression::formulas::{Entry, Formulas, Parameters, ReducedFormulas, TextError, Unit};
use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use std::str::FromStr;
use syn::{Error, Ident, Result};

/// The structure of a system with its implementations.
pub(crate) fn system(described: &Described) -> Result<TokenStream> {
    let fail = |error: TextError| Error::new(described.place(error.entry), error.problem);
    let mut formulas = Formulas::of(&described.words, Parameters::Variables).map_err(fail)?;
    let reduced = formulas.reduced().filter(|reduced| !reduced.basis.is_empty());
    let printer = Printer { described, formulas: &formulas };
    let (structure, inherent) = match &described.kind {
        Kind::New(attributes, visibility) => structure(described, &printer, attributes, visibility)?,
        Kind::There => (TokenStream::new(), TokenStream::new()),
    };
    let (name, lagrangian) = (&described.name, &described.lagrangian);
    let (n, m) = (formulas.n, formulas.m);
    let functions = functions(&printer, reduced.as_ref())?;
    let by_hand = match &reduced {
        Some(reduced) => by_hand(&printer, reduced)?,
        None => TokenStream::new(),
    };
    Ok(quote! {
        #structure
        #[allow(unused_variables, unused_parens, unused_imports, clippy::all, clippy::pedantic, clippy::nursery)]
        const _: () = {
            use #lagrangian::{AdmissibleBasis, Constraint, Piecewise, Reduced, ReducedError, Scalar, StageEvaluation, System};
            impl System<#n, #m> for #name { #functions }
            #by_hand
            #inherent
        };
    })
}

/// The structure with the parameters as its fields, their default values, and its outputs.
fn structure(
    described: &Described,
    printer: &Printer<'_>,
    attributes: &[syn::Attribute],
    visibility: &syn::Visibility,
) -> Result<(TokenStream, TokenStream)> {
    let name = &described.name;
    let fields: Vec<&Ident> = described.parameters.iter().map(|(name, _)| name).collect();
    let values = described.words.parameters.iter().map(|(_, value)| *value);
    let told = described.words.parameters.iter().map(|(name, value)| format!("`{name}`, by default {value:?}."));
    let body = if fields.is_empty() { quote!(;) } else { quote!({ #(#[doc = #told] #visibility #fields: f64,)* }) };
    let structure = quote! {
        #(#attributes)*
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[allow(non_snake_case)]
        #visibility struct #name #body
    };
    let formulas = printer.formulas;
    let n = formulas.n;
    let coordinates = described.words.coordinates.iter().map(|(name, _)| name);
    if formulas.multipliers.is_some() {
        let first = described.words.outputs.iter().position(|(_, text)| text.contains("lambda"));
        let place = first.map_or(Entry::System, Entry::Output);
        let problem =
            "a structure has no multipliers `lambda1`, ..: `Motion` has them, and outputs of scenes may contain them";
        return Err(Error::new(described.place(place), problem));
    }
    let mut outputs = TokenStream::new();
    for ((output, text), &formula) in described.words.outputs.iter().zip(&formulas.outputs) {
        let name: Ident = syn::parse_str(output)
            .map_err(|_| Error::new(described.name.span(), format!("an output cannot be called `{output}` in Rust")))?;
        let value = printer.one(formula, "v")?;
        let told = format!("`{output} = {text}`.");
        outputs.extend(quote! {
            #[doc = #told]
            #visibility fn #name<S: Scalar>(&self, t: S, q: &[S; #n], v: &[S; #n]) -> S { #value }
        });
    }
    let inherent = quote! {
        impl Default for #name {
            fn default() -> Self { Self { #(#fields: #values,)* } }
        }
        impl Piecewise for #name {
            fn piece(&self, _t: f64) -> Self { *self }
        }
        #[allow(non_snake_case, dead_code)]
        impl #name {
            /// The names of the coordinates.
            #visibility const COORDINATES: [&'static str; #n] = [#(#coordinates,)*];
            #outputs
        }
    };
    Ok((structure, inherent))
}

/// The functions of `System`.
fn functions(printer: &Printer<'_>, reduced: Option<&ReducedFormulas>) -> Result<TokenStream> {
    let formulas = printer.formulas;
    let (n, m) = (formulas.n, formulas.m);
    let lagrangian = printer.one(formulas.lagrangian, "v")?;
    let all = [&formulas.rows[..], &formulas.level].concat();
    let constraint = printer.all(&all, "v", |results| {
        let (rows, level) = results.split_at(n * m);
        let rows = rows.chunks(n.max(1)).map(|row| quote!([#(#row),*]));
        quote!(([#(#rows),*], [#(#level),*]))
    })?;
    let mut functions = quote! {
        #[inline(always)]
        fn lagrangian<S: Scalar>(&self, t: S, q: &[S; #n], v: &[S; #n]) -> S { #lagrangian }
        #[inline(always)]
        fn constraint<S: Scalar>(&self, t: S, q: &[S; #n]) -> Constraint<S, #n, #m> { #constraint }
    };
    let angles = printer.described.words.coordinates.iter().map(|(_, unit)| *unit == Unit::Angle);
    functions.extend(quote! {
        #[inline(always)]
        fn angles(&self) -> [bool; #n] { [#(#angles),*] }
    });
    if let Some(force) = &formulas.force {
        let force = printer.all(force, "v", |results| quote!(Some([#(#results),*])))?;
        functions.extend(quote! {
            #[inline(always)]
            fn force<S: Scalar>(&self, t: S, q: &[S; #n], v: &[S; #n]) -> Option<[S; #n]> { #force }
        });
    }
    if !formulas.positions.is_empty() {
        let first = m - formulas.positions.len();
        let none = (0..first).map(|_| quote!(None));
        let positions =
            printer.all(&formulas.positions, "v", |results| quote!(Some([#(#none,)* #(Some(#results)),*])))?;
        functions.extend(quote! {
            #[inline(always)]
            fn holonomic<S: Scalar>(&self, t: S, q: &[S; #n]) -> Option<[Option<S>; #m]> { #positions }
        });
    }
    if let Some(reduced) = reduced {
        let basis = printer.all(&reduced.basis.concat(), "v", |results| {
            let vectors = results.chunks(n).map(|vector| quote!([#(#vector),*]));
            quote!(Some(AdmissibleBasis::new([#(#vectors),*])))
        })?;
        functions.extend(quote! {
            #[inline(always)]
            fn admissible_basis<S: Scalar>(&self, t: S, q: &[S; #n]) -> Option<AdmissibleBasis<S, #n, #m>> { #basis }
            #[inline(always)]
            fn reduced(&self) -> impl Reduced<#n, #m> { self }
        });
    }
    Ok(functions)
}

/// The reduced equations.
fn by_hand(printer: &Printer<'_>, reduced: &ReducedFormulas) -> Result<TokenStream> {
    let (n, m, name) = (printer.formulas.n, printer.formulas.m, &printer.described.name);
    let rest = (reduced.acceleration.len()..n).map(|_| quote!(S::zero()));
    let motion = printer.all(&reduced.acceleration, "xi", |results| quote!(Some([#(#results,)* #(#rest),*])))?;
    let velocity = printer.all(&reduced.velocity, "xi", |results| quote!(Ok([#(#results),*])))?;
    let reconstruction = match reduced.reconstruction {
        Some(quadratures) => quote!(Some(#quadratures)),
        None => quote!(None),
    };
    let stands_alone = reduced.stands_alone;
    Ok(quote! {
        impl Reduced<#n, #m> for #name {
            const STAGES: StageEvaluation = StageEvaluation::Simplified;
            #[inline(always)]
            fn reduced_motion<S: Scalar>(&self, t: S, q: &[S; #n], xi: &[S; #n]) -> Option<[S; #n]> { #motion }
            #[inline(always)]
            fn velocity<S: Scalar>(
                &self,
                t: S,
                q: &[S; #n],
                xi: &[S; #n],
                _: impl FnOnce() -> Result<[S; #n], ReducedError>,
            ) -> Result<[S; #n], ReducedError> { #velocity }
            #[inline(always)]
            fn reconstruction(&self) -> Option<u32> { #reconstruction }
            #[inline(always)]
            fn stands_alone(&self) -> bool { #stands_alone }
        }
    })
}

/// Formulas as Rust.
struct Printer<'a> {
    described: &'a Described,
    formulas: &'a Formulas,
}

impl Printer<'_> {
    fn one(&self, formula: Expression, rates: &str) -> Result<TokenStream> {
        self.all(&[formula], rates, |results| quote!(#(#results)*))
    }

    /// A body that computes some formulas and ends with `end` of the results. `rates` is the name of the array of rates.
    fn all(
        &self,
        formulas: &[Expression],
        rates: &str,
        end: impl FnOnce(&[TokenStream]) -> TokenStream,
    ) -> Result<TokenStream> {
        let n = self.formulas.n;
        let mut variables = vec!["t".to_owned()];
        variables.extend((0..n).map(|i| format!("q[{i}]")));
        variables.extend((0..n).map(|i| format!("{rates}[{i}]")));
        variables.extend(self.described.parameters.iter().map(|(name, value)| match self.described.kind {
            Kind::New(..) => format!("self.{name}"),
            Kind::There => format!("({})", value.to_token_stream()),
        }));
        let names: Vec<&str> = variables.iter().map(String::as_str).collect();
        let wrong = |error: String| Error::new(self.described.name.span(), error);
        let pieces = self.formulas.graph.rust_pieces(formulas, &names, 1 + 2 * n);
        let (statements, results) = pieces.map_err(|error| wrong(error.to_string()))?;
        let rust = |text: &str| TokenStream::from_str(text).map_err(|error| wrong(error.to_string()));
        let results = results.iter().map(|result| rust(result)).collect::<Result<Vec<_>>>()?;
        let (statements, end) = (rust(&statements)?, end(&results));
        Ok(quote!(#statements #end))
    }
}
