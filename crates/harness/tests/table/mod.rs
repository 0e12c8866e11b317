//! One table of systems, every method on each: a row buys every check.

mod adaptive;
mod case;
mod constraint;
mod energy;
mod gauge;
mod hidden_mode;
mod high_order;
mod long_energy;
mod momentum;
mod order;
mod reference;
mod refusal;
mod reversal;
mod rows;
mod series;
mod shapes;
mod systems;
mod text;
mod texts;
mod thrust;
mod tools;
mod units;
