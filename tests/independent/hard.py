"""Hard motions by 22 methods: right, refused with a reason, or accepted though wrong, against SciPy on equations derived by SymPy."""

import re
import sys
from collections import Counter

import numpy as np

from hard_sleighs import Sleigh
from hard_texts import Text
from mechanics import expected
from program import Findings, Program, arguments

METHODS = ("dla", "dla-trapezoid", "dla-alpha", "dla4", "dla6", "dla8", "lobatto3", "lobatto4", "lobatto5", "gauss4", "gauss8", "gauss12", "gauss16",
           "gauss-adaptive", "energy2", "energy4", "energy8", "rk4", "rk4-projected", "rk4-reduced", "implicit-midpoint", "dop853")  # fmt: skip
KINDS = ("spin", "stiff", "light", "train", "rest", "units", "text")
OWN_STEPS = ("gauss-adaptive", "dop853")
TRAINS = ("dla", "dla4", "dla6", "dla8")
# A step resolves a motion where it is at most so much of the time of its fastest rate.
RESOLVED = 0.5
# An end is promised where the bound of its error is at most so much of the way.
PROMISED = 0.1
# A refusal that says what a method never does.
BY_KIND = re.compile(r"refused|does not do|do not do|cannot")


class Truth:
    """The end of a hard scene, the sizes of its motion, its fastest rate, and how it magnifies errors."""

    def __init__(self, hard, duration):
        numbers, start, n = hard.numbers, hard.start, hard.numbers.size
        fine, rough = (numbers.end(start, duration, tolerance, limit=40_000) for tolerance in (1e-13, 1e-11))
        self.known = fine is not None and rough is not None
        if not self.known:
            return
        self.end = fine.y[:n, -1]
        chosen = [k for _, _, k in hard.shown]
        travel = np.abs(fine.y[:n] - start[:n, None]).max(axis=1)
        metric = np.array([unit == "m" for unit in numbers.system.units.values()])
        # Places have one size, angles and numbers another.
        size = np.where(metric, travel[metric].max(initial=0.0), travel[~metric].max(initial=0.0))
        self.size = np.maximum(size, 1e-9 * np.maximum(np.abs(fine.y[:n]).max(axis=1), 1e-300))[chosen]
        places = range(0, fine.t.size, max(1, fine.t.size // 6))
        turning = np.abs(fine.y[n:][~metric]).max(initial=0.0) if hard.shown[-1][0] != "final" or "heading" in str(hard.shown) else 0.0
        self.rate = max(turning, *(numbers.rate(fine.y[:, k], fine.t[k]) for k in places))
        # What is quick for a moment shows in the steps of DOP853, which are some 0.15 to 0.3 over the rate at this tolerance.
        steps = np.diff(rough.t)[2:-1]
        if steps.size and not hard.corners:
            self.rate = max(self.rate, 0.15 / steps.min())
        moved = start.copy()
        moved[:n] += 1e-7 * size * np.random.default_rng(hard.seed).uniform(-1, 1, n)
        other = numbers.end(numbers.admissible(moved[:n], moved[n:]), duration, 1e-10, limit=40_000)
        drift = np.inf if other is None else (np.abs(other.y[:n, -1] - self.end)[chosen] / self.size).max() / 1e-7
        self.amplified = max(1.0, float(drift))
        apart = (np.abs(rough.y[:n, -1] - self.end)[chosen] / self.size).max()
        # What rounding and SciPy's own errors may come to, relative to the motion.
        far = (np.abs(start[:n]).max() / self.size.min()) if self.size.min() > 0 else 1.0
        self.floor = 10 * apart + 1e-10 * self.amplified + 1e-13 * min(far, 1e12)
        self.kinetic = max(float(v @ numbers.values(fine.y[:, k], fine.t[k])[0] @ v) / 2 for k in places for v in [fine.y[n:, k]])
        self.chosen = chosen


def main():
    options = arguments(__doc__, 700).parse_args()
    program, findings, refusals = Program(options.program, options.folder), Findings(), Counter()
    for seed in range(options.first, options.first + options.count):
        kind = KINDS[seed % len(KINDS)]
        draw = (Text if kind == "text" or (kind == "light" and seed % 2) else Sleigh)(seed, kind)
        hard = draw.draw()
        rate = max(
            hard.numbers.rate(hard.start, 0.0),
            np.abs(hard.start[hard.numbers.size :][2:3]).max(initial=0.0) if hard.shown[-1][1] == "heading" else 0.0,
            1e-300,
        )
        pace, steps = draw.decades(-1.7, 0.4), int(draw.random.integers(40, 160))
        step = float(f"{pace / rate:.3g}")
        truth = Truth(hard, steps * step)
        findings.count("scenes")
        findings.count("scenes without a known end", not truth.known)
        file = program.scene(f"hard-{seed}", hard.text(step, steps * step))
        for method in TRAINS if hard.kind == "train" else METHODS:
            judge(program, findings, refusals, hard, truth, (file, method, step, steps * step))
    for (message, kind), count in refusals.most_common():
        print(count, kind, message)
    return findings.end()


def judge(program, findings, refusals, hard, truth, run):
    file, method, step, duration = run
    answer = program.ask("run", file, "--method", method)
    findings.count("runs")
    where = {"seed": hard.seed, "scene": hard.kind, "method": method, "step": step}
    resolved = truth.known and step * truth.rate <= RESOLVED
    if answer.code in (101, 134, -1) or answer.code < 0:
        return findings.fail("panic or no end", **where, code=answer.code, message=answer.refusal)
    if answer.code != 0:
        if not answer.refusal:
            return findings.fail("no message", **where, code=answer.code)
        if answer.code == 2 or f"{method} refused" in answer.refusal:
            return findings.count("refused by kind")
        plain = re.sub(r"-?\d[\d.]*(e-?\d+)?", "#", answer.refusal)[:160]
        refusals[plain, "smooth" if resolved else "long" if truth.known else "unknown"] += 1
        if resolved:
            return findings.fail("refused a smooth motion", **where, turns=step * truth.rate, message=answer.refusal[:300])
        return findings.count("refused a long step" if truth.known else "refused, end unknown")
    warned = "warning" in answer.messages
    shown = np.array([answer.shown[part][name] for part, name, _ in hard.shown], dtype=float)
    if not np.isfinite(shown).all():
        return findings.fail("not finite", **where, warned=warned)
    if not truth.known:
        return findings.count("end unknown")
    error = float((np.abs(shown - truth.end[truth.chosen]) / truth.size).max())
    # With the weight of one half, which is that of a scene without one, `dla-alpha` is of order two; constants of errors are below 1/4.
    order = 2 if hard.corners else max(2, answer.shown["order"])
    bound = expected(order, step, truth.rate, duration, truth.amplified) / 4
    if method in OWN_STEPS:
        # The tolerance of 1e-12 (m, rad) is one of every step, kept to a factor of 30.
        bound = max(1e-7, 3e-11 * answer.shown["steps"] / min(1.0, truth.size.min())) * truth.amplified
    bound = max(bound, truth.floor)
    if error <= bound:
        return findings.count("right" if bound < PROMISED else "right, though nothing is promised")
    if bound < PROMISED:
        if warned:
            return findings.count("wrong with a warning")
        return findings.fail("wrong", **where, error=error, bound=bound, turns=step * truth.rate, amplified=truth.amplified)
    energy = answer.shown["energy"]
    lost = abs(energy["final"] - energy["initial"]) / truth.kinetic if hard.conservative and truth.kinetic > 0 else 0.0
    if lost > 0.1:
        if warned:
            return findings.count("energy lost, with a warning")
        return findings.fail("energy lost without a warning", **where, lost=lost, error=error, turns=step * truth.rate)
    return findings.count("step too long, the energy kept")


if __name__ == "__main__":
    sys.exit(main())
