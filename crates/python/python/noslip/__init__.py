"""Structure-preserving integrators for mechanical systems with velocity constraints.

>>> import noslip
>>> run = noslip.scene("turnaround").run(method="gauss16", step=0.05)
>>> run["x"].shape
(801,)

`scene` reads a scene, `Sleigh` and `System` make one; a `Scene` has the commands of the program as methods.
"""

from ._noslip import BusyError, ComputationError, NoslipError, RequestError, __version__
from .ensembles import Ensemble, ensemble
from .errors import ArgumentError, Interrupted, RunError, TooLargeError
from .results import Run
from .scenes import Scene, methods, scene, scenes
from .sensitivities import Prediction, Sensitivities
from .sleigh import Sleigh
from .system import System

__all__ = [
    "ArgumentError",
    "BusyError",
    "ComputationError",
    "Ensemble",
    "Interrupted",
    "NoslipError",
    "Prediction",
    "RequestError",
    "Run",
    "RunError",
    "Scene",
    "Sensitivities",
    "Sleigh",
    "System",
    "TooLargeError",
    "__version__",
    "ensemble",
    "methods",
    "scene",
    "scenes",
]
