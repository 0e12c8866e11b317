//! Mechanical systems from text at compile time. The macro is used through the facade, `noslip::system!`, where it is documented.

mod expand;
mod read;
#[cfg(test)]
mod tests;

use proc_macro::TokenStream;

/// The system of some texts. Before them stands the path of the crate `lagrangian`, and a semicolon.
#[proc_macro]
pub fn system(input: TokenStream) -> TokenStream {
    let read = syn::parse::<read::Described>(input);
    read.and_then(|described| expand::system(&described)).unwrap_or_else(|error| error.to_compile_error()).into()
}
