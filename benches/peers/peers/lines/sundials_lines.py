"""SUNDIALS by scikit-sundae: IDA on the constrained equations in index 1, IDA and CVODE on the reduced ones."""

import numpy as np
from numba import njit
from sksundae.cvode import CVODE
from sksundae.ida import IDA

from ..compiled import Compiled
from ..measure import TOLERANCES, Line


def lines(problem):
    f = Compiled(problem)
    span = np.array([0.0, problem.duration])
    slope_into, jacobian = f.slope_into, f.jacobian

    @njit
    def reduced_residual(t, y, d, out):
        slope_into(t, y, out)
        for i in range(5):
            out[i] = d[i] - out[i]

    @njit
    def reduced_jacobian(t, y, _d, _res, cj, out):
        out[:, :] = -jacobian(t, y)
        for i in range(5):
            out[i, i] += cj

    def outcome(found):
        if not found.success:
            raise ArithmeticError(found.message)
        return found.y[-1, :3], found.nfev

    def ida(residual, jac, y0, d0):
        def prepare(tolerance):
            solver = IDA(residual, jacfn=jac, rtol=tolerance, atol=tolerance, max_num_steps=10_000_000)
            return lambda: outcome(solver.solve(span, y0, d0))
        return prepare

    def adams(tolerance):
        solver = CVODE(f.slope_into, method="Adams", rtol=tolerance, atol=tolerance, max_num_steps=10_000_000)
        return lambda: outcome(solver.solve(span, f.start))

    constrained = ida(f.residual_into, f.sundials_jacobian, f.dae_start, f.dae_slope)
    reduced = ida(reduced_residual, reduced_jacobian, f.start, f.slope(0.0, f.start))
    return [
        Line("sundials ida", "scikit-sundae", "index 1", constrained, TOLERANCES),
        Line("sundials ida reduced", "scikit-sundae", "reduced", reduced, TOLERANCES),
        Line("sundials cvode adams", "scikit-sundae", "reduced", adams, TOLERANCES),
    ]
