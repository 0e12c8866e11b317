//! Motions that are small or come to rest beside forces that are large: no method gives one up because of that.

mod balance;
mod bicycle;
pub(crate) mod disk;
mod settling;
mod small;
pub(crate) mod systems;
mod vectors;
