//! What each command computes, prints, writes and refuses.

mod cases;
mod chaos;
mod compare;
mod ensemble;
mod failures;
mod files;
mod first;
mod inspect;
mod metadata;
mod output;
mod parts;
mod places;
mod plot;
mod precision;
mod refusals;
mod rest;
mod rows;
mod run;
mod set;
mod signals;
mod stability;
mod streams;
mod substep;
mod text;
mod times;
mod words;
