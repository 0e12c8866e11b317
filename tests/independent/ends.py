"""End states, works and multipliers of random systems of text by several methods, at the order claimed, against DOP853 on equations derived by SymPy."""

import sys

import numpy as np

from drawn import Draw
from mechanics import expected
from program import Findings, Program, arguments

METHODS = (
    "dla",
    "dla-trapezoid",
    "dla4",
    "dla8",
    "lobatto3",
    "lobatto5",
    "gauss4",
    "gauss8",
    "gauss16",
    "gauss-adaptive",
    "taylor",
    "energy4",
    "rk4-reduced",
    "dop853",
)
OWN_STEPS = ("gauss-adaptive", "taylor", "dop853")
STEP, DURATION = 0.05, 3.0


def main():
    options = arguments(__doc__, 150).parse_args()
    program, findings = Program(options.program, options.folder), Findings()
    for seed in range(options.first, options.first + options.count):
        draw = Draw(seed)
        if draw.start is None:
            findings.count("no start")
            continue
        truth, rough = (draw.numbers.end(draw.start, DURATION, tolerance) for tolerance in (1e-13, 1e-11))
        if truth is None or rough is None:
            findings.count("no truth")
            continue
        truth, path = truth.y[:, -1], rough
        energies = [draw.numbers.energy(path.y[:, k], path.t[k]) for k in range(path.t.size)]
        findings.count("systems")
        for kind in ("rows", "positions", "forces"):
            findings.count(f"with {kind}", bool(getattr(draw.system, kind)))
        findings.count("with time", draw.timed)
        rate = max(draw.numbers.rate(path.y[:, k], path.t[k]) for k in range(0, path.t.size, max(1, path.t.size // 8)))
        # What errors of 1e-11 in SciPy's steps come to at the end, and the digits of the start.
        floor = 1e-11 + np.abs(path.y[:, -1] - truth).max()
        size = max(1.0, np.abs(path.y).max())
        n = draw.system.size
        file = program.scene(f"ends-{seed}", draw.system.text(draw.start[:n], draw.start[n:], STEP, DURATION))
        for method in METHODS:
            judge(program, findings, draw, file, method, truth, floor, (rate, size), energies)
    return findings.end()


def balanced(findings, where, shown, energies, error):
    """The energy of the start, and the work: what the motion gains. A run whose end is wrong by `error` is wrong in its work by the energy."""
    size = 1.0 + max(map(abs, energies))
    if abs(shown["initial"] - energies[0]) > 1e-12 * size:
        findings.fail("energy", **where, told=shown["initial"], right=energies[0])
    if not abs(shown["work"] - (energies[-1] - energies[0])) <= (1e-9 + 1e3 * error) * size:
        findings.fail("work", **where, told=shown["work"], right=energies[-1] - energies[0])


def carried(findings, where, draw, final):
    """The multipliers of the constraints at the state where the run ended."""
    names = [*draw.system.units, *(f"{name}'" for name in draw.system.units)]
    right = draw.numbers.multipliers(final["t"], np.array([final[name] for name in names], dtype=float))
    told = np.array([final[f"lambda{k + 1}"] for k in range(right.size)], dtype=float)
    findings.count("multipliers", right.size)
    if not np.abs(told - right).max(initial=0.0) <= 1e-9 * (1 + np.abs(right).max(initial=0.0)):
        findings.fail("multipliers", **where, told=told.tolist(), right=right.tolist())


def judge(program, findings, draw, file, method, truth, floor, measure, energies):
    errors = []
    for part in (1, 2, 4):
        step = STEP / part
        answer = program.ask("run", file, "--method", method, "--step", step)
        findings.count("runs")
        where = {"seed": draw.seed, "method": method, "step": step}
        if answer.code == 2 or answer.refusal.startswith(f"error: {method} refused"):
            return findings.count("refused by kind")
        if answer.code != 0:
            return findings.fail("refused", **where, code=answer.code, message=answer.refusal)
        names = [*draw.system.units, *(f"{name}'" for name in draw.system.units)]
        errors.append(np.abs(np.array([answer.shown["final"][name] for name in names], dtype=float) - truth).max())
        if not np.isfinite(errors[-1]):
            return findings.fail("not finite", **where)
        if answer.shown["constraint"]["max"] > 1e-12 * measure[1]:
            findings.fail("constraint", **where, residual=answer.shown["constraint"]["max"])
        balanced(findings, where, answer.shown["energy"], energies, errors[-1])
        carried(findings, where, draw, answer.shown["final"])
        if method in OWN_STEPS:
            if errors[-1] > 10 * floor:
                findings.fail("end", **where, error=errors[-1], bar=10 * floor)
            if part == 2:
                return None
            continue
        order = answer.shown["order"]
        if part == 1:
            continue
        # The second step has the order claimed to a half, or the third step has: an error may change its sign.
        bars = (
            [max(10 * floor, error / 2 ** ((order - 0.5) * k)) for k, error in zip((2, 1), errors[-3:-1])]
            if part == 4
            else [max(10 * floor, errors[0] / 2 ** (order - 0.5))]
        )
        bound = max(10 * floor, expected(order, step, *([measure[0], DURATION, measure[1]])))
        if errors[-1] > bound:
            return findings.fail("end", **where, error=errors[-1], bar=bound)
        if errors[-1] <= max(bars):
            return findings.count("order as claimed")
    return findings.fail("order", **where, order=order, errors=errors)


if __name__ == "__main__":
    sys.exit(main())
