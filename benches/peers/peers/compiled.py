"""The equations compiled by numba, for packages that call back from compiled or interpreted loops."""

import numpy as np
from numba import njit

from . import equations

# The derivative of an analytic function from one complex value: no difference is taken, so that no digit is lost.
TINY = 1e-30


class Compiled:
    """Slopes, residual and exact Jacobians of a problem.

    `slope(t, y)`, `slope_into(t, y, out)` and `jacobian(t, y)` in the reduced form, `full_slope` in full coordinates,
    `residual(t, y, yp)`, `residual_into(t, y, yp, out)` and `residual_jacobians(t, y, yp)` of the DAE of index 1.
    """

    def __init__(self, problem):
        # math.cos knows no complex numbers.
        found = equations.namespace(problem, float, np.cos, np.sin, np.exp)
        found["K"] = njit(lambda x: x)
        reduced, full, residual = (njit(found[name]) for name in ("reduced", "full", "residual"))

        @njit
        def slope_into(_t, y, out):
            r = reduced(y[0], y[1], y[2], y[3], y[4])
            out[0], out[1], out[2], out[3], out[4] = r[0], r[1], r[2], r[3], r[4]

        @njit
        def slope(t, y):
            out = np.empty(5, y.dtype)
            slope_into(t, y, out)
            return out

        @njit
        def jacobian(t, y):
            jac = np.empty((5, 5))
            for j in range(5):
                z = y.astype(np.complex128)
                z[j] += 1j * TINY
                jac[:, j] = slope(t, z).imag / TINY
            return jac

        @njit
        def full_slope(_t, y):
            r = full(y[0], y[1], y[2], y[3], y[4], y[5])
            return np.array([r[0], r[1], r[2], r[3], r[4], r[5]])

        @njit
        def residual_into(_t, y, d, out):
            r = residual(y[0], y[1], y[2], y[3], y[4], y[5], d[0], d[1], d[2], d[3], d[4], d[5], d[6])
            out[0], out[1], out[2], out[3], out[4], out[5], out[6] = r[0], r[1], r[2], r[3], r[4], r[5], r[6]

        @njit
        def residual_of(t, y, d):
            out = np.empty(7, y.dtype)
            residual_into(t, y, d, out)
            return out

        @njit
        def residual_jacobians(t, y, d):
            by_y, by_d = np.empty((7, 7)), np.empty((7, 7))
            for j in range(7):
                z, dz = y.astype(np.complex128), d.astype(np.complex128)
                z[j] += 1j * TINY
                by_y[:, j] = residual_of(t, z, dz).imag / TINY
                z[j] = y[j]
                dz[j] += 1j * TINY
                by_d[:, j] = residual_of(t, z, dz).imag / TINY
            return by_y, by_d

        @njit
        def sundials_jacobian(t, y, d, _res, cj, out):
            by_y, by_d = residual_jacobians(t, y, d)
            out[:, :] = by_y + cj * by_d

        self.slope, self.slope_into, self.jacobian, self.full_slope = slope, slope_into, jacobian, full_slope
        self.residual, self.residual_into = residual_of, residual_into
        self.residual_jacobians, self.sundials_jacobian = residual_jacobians, sundials_jacobian
        self.start = np.array(problem.start)
        self.full_start = np.array(equations.full_start(problem))
        # The unknown whose derivative is the multiplier begins at 0.
        self.dae_start = np.append(self.full_start, 0.0)
        rates = equations.namespace(problem)["full"](*self.full_start)
        self.dae_slope = np.append(rates, equations.multiplier(problem))
        for call in (slope, jacobian, full_slope):
            call(0.0, self.full_start if call is full_slope else self.start)
        residual_of(0.0, self.dae_start, self.dae_slope)
        residual_jacobians(0.0, self.dae_start, self.dae_slope)
