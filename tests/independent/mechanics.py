"""A system of formulas, as a text for the program and as numbers by SymPy and SciPy: the Lagrange-d'Alembert equations of index 1."""

import json
import math
from copy import copy
from dataclasses import dataclass, field

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

TIME = sp.Symbol("t", real=True)


def coordinate(name):
    """A coordinate and its rate."""
    return sp.Symbol(name, real=True), sp.Symbol(f"{name}_dot", real=True)


@dataclass
class System:
    """Coordinates with units, a Lagrangian, rows `r(q, v, t) = 0` affine in the rates, positions `g(q, t) = 0`, forces by coordinate.

    Parameters are symbols, whose numbers are given with the start.
    """

    units: dict
    lagrangian: sp.Expr
    rows: list = field(default_factory=list)
    positions: list = field(default_factory=list)
    forces: dict = field(default_factory=dict)
    parameters: list = field(default_factory=list)

    def __post_init__(self):
        self.q, self.v = (sp.Matrix(symbols) for symbols in zip(*map(coordinate, self.units)))
        self.size = len(self.units)

    def momenta(self):
        """`L_v`."""
        return sp.Matrix([sp.diff(self.lagrangian, rate) for rate in self.v])

    def equations(self):
        """`[M, A'; A, 0] (a, lambda) = (f, gamma)`: M, f, A, gamma, and the constraints of positions and velocities."""
        q, v = self.q, self.v
        p = self.momenta()
        force = sp.Matrix([sp.sympify(self.forces.get(name, 0)) for name in self.units])
        slope = sp.Matrix([sp.diff(self.lagrangian, place) for place in q])
        f = slope + force - p.jacobian(q) * v - p.diff(TIME)
        g = sp.Matrix(self.positions) if self.positions else sp.zeros(0, 1)
        moved = g.jacobian(q) * v + g.diff(TIME) if self.positions else g
        r = sp.Matrix([*self.rows, *moved]) if self.rows or self.positions else sp.zeros(0, 1)
        if not r.rows:
            return p.jacobian(v), f, sp.zeros(0, self.size), r, g, r
        return p.jacobian(v), f, r.jacobian(v), -(r.jacobian(q) * v + r.diff(TIME)), g, r

    def text(self, q, v, step, duration, values=()):
        """The scene file with that start and these numbers of the parameters."""
        quoted = json.dumps
        lines = ["[system]", "coordinates = { " + ", ".join(f"{n} = {quoted(u)}" for n, u in self.units.items()) + " }"]
        lines.append(f"lagrangian = {quoted(str(self.lagrangian))}")
        if self.parameters:
            lines.append("parameters = { " + ", ".join(f"{s} = {float(x)!r}" for s, x in zip(self.parameters, values)) + " }")
        for key, formulas in (("constraints", self.rows), ("positions", self.positions)):
            if formulas:
                lines.append(f"{key} = {quoted([str(formula) for formula in formulas])}")
        told = [f"lambda{k + 1}" for k in range(len(self.rows) + len(self.positions))]
        if told:
            lines.append("outputs = { " + ", ".join(f"{name} = {quoted(name)}" for name in told) + " }")
        if self.forces:
            lines.append("forces = { " + ", ".join(f"{n} = {quoted(str(f))}" for n, f in self.forces.items()) + " }")
        lines.append("[start]")
        lines += [f"{name} = {float(value)!r}" for name, value in zip(self.units, q)]
        lines += [f"{quoted(name + chr(39))} = {float(value)!r}" for name, value in zip(self.units, v)]
        return "\n".join([*lines, "[run]", f"step = {step!r}", f"duration = {duration!r}", ""])


class Numbers:
    """The equations of a system in numbers, real or complex."""

    def __init__(self, system):
        self.system, self.size = system, system.size
        mass, f, rows, gamma, g, r = system.equations()
        self.shape = (rows.rows, g.rows)
        self.symbols, self.numbers = [*system.q, *system.v, TIME, *system.parameters], ()
        self.formulas = [*mass, *f, *rows, *gamma, *g, *r]
        self.real = sp.lambdify(self.symbols, self.formulas, modules="math", cse=True)
        self.other = None
        energy = system.momenta().dot(system.v) - system.lagrangian
        self.energy_at = sp.lambdify(self.symbols, energy, modules="math", cse=True)

    def energy(self, z, t):
        """`v . L_v - L` (J)."""
        return self.energy_at(*z.tolist(), t, *self.numbers)

    def bound(self, numbers):
        """The same with these numbers of the parameters."""
        other = copy(self)
        other.numbers = tuple(map(float, numbers))
        return other

    def values(self, z, t):
        """M, f, A, gamma, g, r."""
        if np.iscomplexobj(z):
            if self.other is None:
                self.other = sp.lambdify(self.symbols, self.formulas, modules="numpy", cse=True)
            found = np.array(self.other(*z, t, *self.numbers), dtype=complex)
        else:
            found = np.array(self.real(*z.tolist(), t, *self.numbers))
        n, (m, p) = self.size, self.shape
        mass, f, rows, gamma, g, r = np.split(found, np.cumsum([n * n, n, m * n, m, p]))
        return mass.reshape(n, n), f, rows.reshape(m, n), gamma, g, r

    def flow(self, t, z):
        """The derivative of `z = (q, v)`."""
        return np.concatenate([z[self.size :], self.solved(t, z)[0]])

    def multipliers(self, t, z):
        """`lambda` of `M a = f + A' lambda`."""
        return -self.solved(t, z)[1]

    def solved(self, t, z):
        """The solution `(a, lambda)` of `[M, A'; A, 0] (a, lambda) = (f, gamma)`."""
        n, m = self.size, self.shape[0]
        mass, f, rows, gamma, _, _ = self.values(z, t)
        # Light and heavy coordinates in one measure.
        measure = 1 / np.sqrt(np.abs(np.diag(mass)))
        saddle = np.zeros((n + m, n + m), dtype=found_type(z))
        saddle[:n, :n] = mass * measure * measure[:, None]
        saddle[n:, :n] = rows * measure
        size = np.sqrt((np.abs(saddle[n:, :n]) ** 2).sum(axis=1))
        saddle[n:, :n] /= size[:, None]
        saddle[:n, n:] = saddle[n:, :n].T
        solved = np.linalg.solve(saddle, np.concatenate([f * measure, gamma / size]))
        return solved[:n] * measure, solved[n:] / size

    def slope(self, t, z):
        """The Jacobian of the flow by complex steps, exact to round-off."""
        return complex_step(lambda w: self.flow(t, w), z)

    def constraints(self, t, z):
        """Positions and velocity rows: what vanishes."""
        return np.concatenate(self.values(z, t)[4:])

    def admissible(self, q, v, t=0.0):
        """The nearest place and velocity that meet the constraints."""
        z, n = np.concatenate([q, v]).astype(float), self.size
        for kind, part in ((4, slice(0, n)), (5, slice(n, 2 * n))):
            for _ in range(50):
                missed = self.values(z, t)[kind]
                if not missed.size or np.abs(missed).max() < 1e-15:
                    break
                slope = complex_step(lambda w, kind=kind: self.values(w, t)[kind], z)[:, part]
                z[part] -= np.linalg.lstsq(slope, missed, rcond=None)[0]
        return z

    def end(self, z, duration, tolerance, method="DOP853", limit=400_000, times=None):
        """The motion to `duration`; None where SciPy gives up or takes too long."""
        asked = [0]

        def flow(t, z):
            asked[0] += 1
            if asked[0] > limit:
                raise TooLong
            return self.flow(t, z)

        try:
            scale = tolerance * np.maximum(1e-6, np.abs(z))
            found = solve_ivp(flow, (0.0, duration), z, method, rtol=tolerance, atol=scale, t_eval=times)
        except (TooLong, OverflowError, ValueError, ZeroDivisionError, np.linalg.LinAlgError):
            return None
        return found if found.success and np.isfinite(found.y).all() else None

    def rate(self, z, t):
        """The fastest rate of the linearised motion (1/s), by differences."""
        step = 1e-6 * np.maximum(1.0, np.abs(z))
        here = self.flow(t, z)
        columns = [(self.flow(t, z + step * (np.arange(z.size) == k)) - here) / step[k] for k in range(z.size)]
        return float(np.abs(np.linalg.eigvals(np.array(columns).T)).max())


class TooLong(Exception):
    """The flow was asked too often."""


def found_type(z):
    return complex if np.iscomplexobj(z) else float


def complex_step(function, z):
    columns = []
    for k in range(z.size):
        moved = z.astype(complex)
        moved[k] += 1e-40j
        columns.append(function(moved).imag / 1e-40)
    return np.array(columns).T


def expected(order, step, rate, duration, size):
    """A bound of the error of a method of that order where the step resolves the motion: `(h w)^p (w T) size`."""
    return min((step * rate) ** order, 1e300) * max(1.0, rate * duration) * size if math.isfinite(rate) else math.inf
