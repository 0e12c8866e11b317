"""What a long run in a bowl loses of the energy, and how far the blade slips, against its time.

Energy and slip are looked at `CHUNKS` times; only what the integrator itself takes is in the time.
"""

import time

import heyoka as hy
import numpy as np
from numba import njit

from . import equations
from .compiled import Compiled
from .lines.heyoka_lines import system
from .scene import Refused

CHUNKS = 1000
TOLERANCES = (1e-6, 1e-9, 1e-12, 1e-15)
STEPS = (0.1, 0.05, 0.025)


def energy(problem, form, state):
    """The energy (J) of a state, and the slip of the blade (m/s)."""
    x, y, th = equations.from_own_axes(problem, *state[:3]) if form == "own axes" else state[:3]
    sin, cos = np.sin(th), np.cos(th)
    vx, vy, w = state[3:6] if form == "full" else (state[3] * cos, state[3] * sin, state[4])
    a, (kx, ky), (x0, y0) = problem.offset, problem.effects[0]["stiffness"], problem.effects[0]["center"]
    kinetic = problem.mass * ((vx - a * w * sin) ** 2 + (vy + a * w * cos) ** 2) + problem.inertia * w**2
    potential = kx * (x + a * cos - x0) ** 2 + ky * (y + a * sin - y0) ** 2
    return 0.5 * (kinetic + potential), abs(cos * vy - sin * vx)


def measured(problem, form, state, advance):
    """Seconds, the largest relative change of the energy and the largest slip, until all of the energy is lost."""
    first = energy(problem, form, state)[0]
    spent = worst = slip = 0.0
    for node in range(1, CHUNKS + 1):
        begin = time.perf_counter()
        state = advance(state, node)
        spent += time.perf_counter() - begin
        now, slipping = energy(problem, form, state)
        worst, slip = max(worst, abs(now - first) / first), max(slip, slipping)
        # What has lost its energy takes ever shorter steps.
        if not worst < 1.0:
            break
    return spent, worst, slip


def taylor(problem, form, start, tolerance):
    """A run of heyoka's Taylor series."""
    solver = hy.taylor_adaptive(system(problem, form), list(start), tol=tolerance)
    ends = np.linspace(0.0, problem.duration, CHUNKS + 1)

    def advance(_, node):
        solver.propagate_until(ends[node])
        return solver.state

    return measured(problem, form, np.array(start), advance)


def runge_kutta(problem, slope, start, step):
    """A run of the classical Runge-Kutta method in a compiled loop."""

    @njit
    def run(y, steps, h):
        for _ in range(steps):
            k1 = slope(0.0, y)
            k2 = slope(0.0, y + 0.5 * h * k1)
            k3 = slope(0.0, y + 0.5 * h * k2)
            k4 = slope(0.0, y + h * k3)
            y = y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        return y

    run(start, 1, step)
    steps = round(problem.duration / CHUNKS / step)
    return measured(problem, "full", start, lambda y, _: run(y, steps, step))


def table(problem):
    """Every peer, a row a run."""
    if len(problem.effects) != 1 or problem.effects[0]["kind"] != "bowl":
        raise Refused("--energy needs a scene with one bowl and nothing else")
    full = equations.full_start(problem)
    compiled = Compiled(problem)
    rows = [f"| {problem.name}, {problem.duration:g} s | s | energy, relative | slip, m/s |", "|---|---|---|---|"]

    def row(name, found):
        spent, worst, slip = found
        rows.append(f"| {name} | {spent:.3g} | {worst:.1e} | {slip:.1e} |")

    for tolerance in TOLERANCES:
        row(f"heyoka taylor, {tolerance:g}", taylor(problem, "reduced", problem.start, tolerance))
    if equations.round_well(problem):
        own = equations.into_own_axes(problem)
        for tolerance in TOLERANCES:
            row(f"heyoka taylor own axes, {tolerance:g}", taylor(problem, "own axes", own, tolerance))
    for tolerance in TOLERANCES:
        row(f"heyoka taylor full, {tolerance:g}", taylor(problem, "full", full, tolerance))
    for step in STEPS:
        row(f"rk4 full, {step:g} s", runge_kutta(problem, compiled.full_slope, np.array(full), step))
    return "\n".join(rows)
