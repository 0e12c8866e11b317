use crate::Scene;
use lagrangian::{System, With};
use sleigh::{Exact, Sleigh, SleighError, SleighState};

/// A system that came from a scene, and answers in the words of a scene.
pub trait SceneSystem<const N: usize, const M: usize>: System<N, M> {
    /// Place, heading and admissible velocities of the sleigh.
    fn sleigh_state(&self, q: &[f64; N], v: &[f64; N]) -> SleighState;
}

impl<E> SceneSystem<3, 1> for With<Sleigh, E>
where
    Self: System<3, 1>,
{
    fn sleigh_state(&self, q: &[f64; 3], v: &[f64; 3]) -> SleighState {
        SleighState::from_coordinates(q, v)
    }
}

/// What is to be done with the system of a scene, whatever its type.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Receives the system and its start.
    fn visit<Sys, const N: usize, const M: usize>(self, system: &Sys, q: [f64; N], v: [f64; N]) -> Self::Output
    where
        Sys: SceneSystem<N, M>;
}

impl Scene {
    /// Builds the system of the scene and hands it to the visitor: the one place where a scene becomes a type.
    ///
    /// A scene without effects becomes the bare body, `With<Sleigh, ()>`.
    pub fn visit<V: Visitor>(&self, visitor: V) -> V::Output {
        let (q, v) = self.start.to_coordinates();
        visitor.visit(&With { body: self.sleigh, effects: () }, q, v)
    }

    /// The motion of the scene in closed form.
    ///
    /// # Errors
    /// [`SleighError`] where a quantity of it overflows.
    pub fn exact(&self) -> Result<Exact, SleighError> {
        Exact::new(&self.sleigh, &self.start)
    }
}
