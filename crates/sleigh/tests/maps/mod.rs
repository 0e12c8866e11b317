//! The maps of the sleigh by themselves: the planimeter's map of headings, plans that park it.

mod headings;
mod moebius;
mod parking;
mod sizes;
