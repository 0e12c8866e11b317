"""Other people's integrators on the scenes of noslip."""
