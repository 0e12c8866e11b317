"""heyoka: Taylor series of adaptive order, compiled for the problem. The cost of a call from Python is in the times."""

import heyoka as hy
import numpy as np

from .. import equations
from ..measure import TOLERANCES, Line

# One rung more: nothing but rounding limits this method.
RUNGS = [*TOLERANCES, 1e-15]
LANES = 8


def system(problem, form, constant=float):
    """The equations as heyoka's expressions."""
    found = equations.namespace(problem, constant, hy.cos, hy.sin, hy.exp)
    names = ("x", "y", "th", "vx", "vy", "w") if form == "full" else ("x", "y", "th", "u", "w")
    unknowns = hy.make_vars(*names)
    return [(v, hy.expression(s) if isinstance(s, float) else s) for v, s in zip(unknowns, found[form](*unknowns))]


def lines(problem):
    end = problem.duration

    def on_plane(form, place):
        return equations.from_own_axes(problem, *place) if form == "own axes" else place.copy()

    def single(form, start):
        def prepare(tolerance):
            solver = hy.taylor_adaptive(system(problem, form), start, tol=tolerance)
            start_array = np.array(start)

            def run():
                solver.time = 0.0
                solver.state[:] = start_array
                outcome = solver.propagate_until(end)
                if outcome[0] != hy.taylor_outcome.time_limit:
                    raise ArithmeticError(str(outcome[0]))
                return on_plane(form, solver.state[:3]), outcome[3]
            return run
        return prepare

    def batch(form, one):
        def prepare(tolerance):
            # Eight sleighs that differ: equal ones would take equal steps. The error is that of the first.
            start = np.repeat(np.array(one)[:, None], LANES, axis=1)
            start[4] += 1e-3 * np.arange(LANES)
            solver = hy.taylor_adaptive_batch(system(problem, form), start, tol=tolerance)
            times = np.full(LANES, end)

            def run():
                solver.set_time(np.zeros(LANES))
                solver.state[:] = start
                solver.propagate_until(times)
                outcomes = solver.propagate_res
                if any(o[0] != hy.taylor_outcome.time_limit for o in outcomes):
                    raise ArithmeticError(str(outcomes[0][0]))
                return on_plane(form, solver.state[:3, 0]), outcomes[0][3]
            return run
        return prepare

    # In a round well, or free, the heading can be left out of the equations, and all sines with it.
    own = []
    if equations.round_well(problem):
        start = list(equations.into_own_axes(problem))
        own = [
            Line("heyoka taylor own axes", "heyoka", "own axes", single("own axes", start), RUNGS),
            Line("heyoka taylor batch own axes", "heyoka", "own axes, one of eight", batch("own axes", start), RUNGS, lanes=LANES),
        ]
    start = list(problem.start)
    return own + [
        Line("heyoka taylor", "heyoka", "reduced", single("reduced", start), RUNGS),
        Line("heyoka taylor full", "heyoka", "full", single("full", list(equations.full_start(problem))), RUNGS),
        Line("heyoka taylor batch", "heyoka", "reduced, one of eight", batch("reduced", start), RUNGS, lanes=LANES),
    ]
