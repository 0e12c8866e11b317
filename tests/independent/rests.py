"""Steady motions of random systems of text: places, eigenvalues to 1e-8 and limits of steps by `equilibria`, against SymPy and SciPy."""

import sys
from math import factorial

import numpy as np
from scipy.linalg import null_space
from scipy.optimize import least_squares, linear_sum_assignment

from drawn import Draw
from mechanics import complex_step
from program import Findings, Program, arguments

METHODS = ("dla", "rk4")
STEP, STARTS, NEAR = 0.02, 6, 1.0
# The reason of methods that do not differentiate their steps under constraints on positions.
BY_KIND = "constraints on positions"
# Of the largest eigenvalue: a smaller one is a double zero and its rounding.
ZERO = 1e-7


def main():
    options = arguments(__doc__, 150).parse_args()
    program, findings = Program(options.program, options.folder), Findings()
    for seed in range(options.first, options.first + options.count):
        draw = Draw(seed, still=True)
        if draw.start is None:
            findings.count("no start")
            continue
        findings.count("systems")
        findings.count("with positions", bool(draw.system.positions))
        n = draw.system.size
        file = program.scene(f"rests-{seed}", draw.system.text(draw.start[:n], draw.start[n:], STEP, 2.0))
        near = rest_nearby(draw.numbers, draw.start[:n])
        for method in METHODS:
            judge(program, findings, draw, file, method, near)
    return findings.end()


def judge(program, findings, draw, file, method, near):
    where = {"seed": draw.seed, "method": method}
    answer = program.ask("equilibria", file, "--method", method)
    if answer.code not in (0, 1, 2):
        return findings.fail("panic or no end", **where, code=answer.code, message=answer.messages[:300])
    if answer.code != 0:
        # None found is right where none is.
        if near is not None:
            return findings.fail("none found", **where, distance=near[0], rest=near[1].tolist(), message=answer.refusal)
        return findings.count("none, and none known")
    for found in answer.shown["equilibria"]:
        findings.count("steady motions")
        check(program, findings, draw, file, where, found)
    return None


def check(program, findings, draw, file, where, found):
    numbers, n = draw.numbers, draw.system.size
    z = draw.start.copy()
    kept = [k for k, name in enumerate(draw.system.units) if name in found["depends_on"]]
    z[kept] = list(found["depends_on"].values())
    z[n:] = list(found["rates"].values())
    missed = np.abs(numbers.constraints(0.0, z)).max(initial=0.0)
    if missed > 1e-10:
        return findings.fail("off the constraints", **where, missed=missed, place=z[:n].tolist())
    chosen = [*kept, *range(n, 2 * n)]
    moves = np.abs(numbers.flow(0.0, z)[chosen]).max()
    if moves > 1e-8 * (1 + np.abs(z).max()):
        return findings.fail("not steady", **where, rate=moves, place=z[:n].tolist(), rates=z[n:].tolist())
    slope, across = numbers.slope(0.0, z), complex_step(lambda w: numbers.constraints(0.0, w), z)
    left_out = [k for k in range(n) if k not in kept]
    if max(np.abs(part[:, left_out]).max(initial=0.0) for part in (slope, across)) > 1e-9:
        return findings.fail("depends on", **where, shown=sorted(found["depends_on"]))
    slope, across = slope[np.ix_(chosen, chosen)], across[:, chosen]
    along = null_space(across, rcond=1e-10) if across.size else np.eye(len(chosen))
    reduced = along.T @ slope @ along
    right = np.linalg.eigvals(reduced)
    shown = np.array([complex(value["re"], value["im"]) for value in found["flow"]])
    if shown.size != right.size:
        return findings.fail("number of eigenvalues", **where, shown=shown.size, right=right.size)
    scale = max(1.0, np.abs(right).max())
    if not alike(shown, right, scale):
        return findings.fail("eigenvalues", **where, shown=pairs(shown), right=pairs(right))
    findings.count("eigenvalues right", right.size)
    # Directions that stay at rest, by singular values; growth, by eigenvalues whose size is beyond their rounding.
    singular = np.linalg.svd(reduced, compute_uv=False)
    family = int((singular <= 1e-9 * singular.max()).sum())
    if found["family"] != family:
        findings.fail("family", **where, shown=found["family"], right=family)
    if np.abs(right.real).max() > 1e-6 * scale and found["stable"] != bool(right.real.max() <= 1e-6 * scale):
        findings.fail("stable", **where, shown=found["stable"], right=pairs(right))
    return limits(findings, draw.system.positions, where, found, right, scale)


def limits(findings, positions, where, found, right, scale):
    """Eigenvalues of the step are exp(h lambda) to the order of the method, and no limit stands where steps resolve the motion."""
    h = min(STEP, 0.1 / scale)
    if found["map"] is None and BY_KIND in found["map_failure"] and positions and where["method"] == "rk4":
        return findings.count("no map, by kind")
    if found["map"] is None or h < STEP:
        return findings.fail("no map", **where, scale=scale) if found["map"] is None and h == STEP else None
    shown = np.array([complex(value["re"], value["im"]) for value in found["map"]])
    if not alike(shown, np.exp(h * right), (h * scale) ** 3 / 1e-8, roots=False):
        findings.fail("map", **where, shown=pairs(shown), right=pairs(np.exp(h * right)))
    limit, right_limit = found["step_limit"], runge_kutta_limit(right) if where["method"] == "rk4" and found["stable"] else None
    told = {"limit": limit, "fastest": scale, "reason": found["step_limit_reason"]}
    if limit is not None and limit * scale < 0.3:
        findings.fail("false limit", **where, **told)
    elif limit is None and found["step_limit_reason"] == "no step":
        findings.count("limits not told")
    elif right_limit is not None and right_limit < 1000 * STEP and (limit is None or abs(limit / right_limit - 1) > 0.02):
        findings.fail("limit", **where, **told, right=right_limit)
    return findings.count("maps and limits looked at")


def runge_kutta_limit(flow):
    """The step from which on the stability function of order four leaves the unit disc; None where no eigenvalue moves."""
    if np.abs(flow).max() < 1e-6:
        return None
    flow = np.where(np.abs(flow) < ZERO * np.abs(flow).max(), 0.0, flow)
    largest = lambda h: np.abs(sum((h * flow) ** k / factorial(k) for k in range(5))).max()
    low = high = 1e-3 / np.abs(flow).max()
    while largest(high) <= 1 + 1e-9:
        low, high = high, 1.02 * high
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if largest(middle) <= 1 + 1e-9 else (low, middle)
    return low


def alike(shown, right, scale, roots=True):
    """Each within 1e-8; of values that coincide, the polynomial of which they are the roots."""
    if shown.size != right.size:
        return False
    distance = np.abs(shown[:, None] - right[None, :])
    if distance[linear_sum_assignment(distance)].max(initial=0.0) <= 1e-8 * scale:
        return True
    return roots and np.abs(np.poly(shown / scale) - np.poly(right / scale)).max() <= 1e-8


def pairs(values):
    return [[round(value.real, 10), round(value.imag, 10)] for value in sorted(values, key=lambda value: (value.real, value.imag))]


def rest_nearby(numbers, start):
    """The nearest place of rest that least squares find from the start and places beside it: distance and place."""
    n, (m, p) = numbers.size, numbers.shape
    still = np.concatenate([start, np.zeros(n)])
    if np.abs(numbers.constraints(0.0, still)[p:]).max(initial=0.0) > 1e-12:
        return None

    def missed(unknown):
        z = np.concatenate([unknown[:n], np.zeros(n)])
        _, f, rows, _, g, r = numbers.values(z, 0.0)
        return np.concatenate([f - rows.T @ unknown[n:], g, r])

    best = None
    random = np.random.default_rng(1)
    for k in range(STARTS):
        guess = start + (k > 0) * random.uniform(-0.5, 0.5, n)
        found = least_squares(missed, np.concatenate([guess, np.zeros(m)]), xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=200)
        distance = np.abs(found.x[:n] - start).max()
        if np.abs(found.fun).max() < 1e-10 and distance < NEAR and (best is None or distance < best[0]):
            best = (distance, found.x[:n])
    return best


if __name__ == "__main__":
    sys.exit(main())
