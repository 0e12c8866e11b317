//! The maps of the sleigh by themselves: its explicit step, the planimeter's map of headings, plans that park it.

mod canonical;
mod headings;
mod moebius;
mod parking;
mod sizes;
