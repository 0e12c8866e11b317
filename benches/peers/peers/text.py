"""A system of text as the peers integrate it: its reduced equations, as `noslip equations` prints them."""

import ast
import json
import os
import shutil
import subprocess
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .measure import TOLERANCES, Line
from .reference import DIGITS, Reference
from .scene import SCENES, Refused

FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "abs")
ROOT = Path(__file__).resolve().parents[3]


class Products(ast.NodeTransformer):
    """Small whole powers as products: the series of a power divides by its base, which may begin with zero."""

    def visit_BinOp(self, node):
        self.generic_visit(node)
        power = node.right.value if isinstance(node.op, ast.Pow) and isinstance(node.right, ast.Constant) else None
        if power not in (2, 3, 4):
            return node
        product = node.left
        for _ in range(power - 1):
            product = ast.BinOp(product, ast.Mult(), node.left)
        return product


@dataclass(frozen=True)
class TextProblem:
    """Unknowns are the coordinates, and behind them the quasi-velocities; formulas are in the words of a scene."""

    name: str
    duration: float
    coordinates: int
    unknowns: tuple
    statements: tuple
    rates: tuple
    start: tuple

    def slope(self, functions):
        """The function `slope(t, ..unknowns)` on the numbers whose functions are given."""
        python = lambda formula: ast.unparse(Products().visit(ast.parse(formula.replace("^", "**"), mode="eval")))
        names = ", ".join(f"v{k}" for k in range(len(self.unknowns)))
        # A coordinate may have any name, that of a function or a word of Python too.
        lines = [f"    {name} = {python(meaning)}" for name, meaning in self.renamed(self.statements)]
        rates = ", ".join(python(rate) for _, rate in self.renamed([("", rate) for rate in self.rates]))
        text = "\n".join([f"def slope(t, {names}):", *lines, f"    return ({rates},)"])
        found = dict(functions)
        exec(compile(text, self.name, "exec"), found)  # pylint: disable=exec-used
        return found["slope"]

    def renamed(self, pairs):
        import re

        new = {name: f"v{k}" for k, name in enumerate(self.unknowns)}
        word = re.compile(r"[A-Za-z_][A-Za-z_0-9]*")
        return [(name, word.sub(lambda found: new.get(found[0], found[0]), formula)) for name, formula in pairs]


def program():
    """noslip itself: `NOSLIP`, the release build of this tree, or the one in the path."""
    built = ROOT / "target" / "release" / "noslip"
    found = os.environ.get("NOSLIP") or (str(built) if built.is_file() else shutil.which("noslip"))
    if not found:
        raise Refused("noslip is needed: `cargo build --release`, or its path in NOSLIP")
    return found


def is_text(scene):
    """Whether a scene file, or a bundled scene, is a system of text."""
    path = Path(scene) if Path(scene).is_file() else SCENES / f"{scene}.toml"
    try:
        return "system" in tomllib.loads(path.read_text())
    except (OSError, ValueError):
        return False


def read(scene, duration=None):
    done = subprocess.run([program(), "equations", scene, "--json"], capture_output=True, text=True, check=False)
    if done.returncode:
        raise Refused(done.stderr.strip())
    told = json.loads(done.stdout)
    statements = tuple(tuple(pair) for pair in told["statements"])
    return TextProblem(told["scene"], duration or min(told["duration"], 20.0), told["coordinates"], tuple(told["unknowns"]), statements,
                       tuple(told["rates"]), tuple(told["start"]))


def heyoka_system(problem, constant=float):
    import heyoka as hy

    unknowns = hy.make_vars(*(f"v{k}" for k in range(len(problem.unknowns))))
    functions = {name: getattr(hy, name) for name in FUNCTIONS if hasattr(hy, name)}
    rates = problem.slope(functions)(hy.time, *unknowns)
    numbers = (int, float)
    return [(v, hy.expression(constant(r)) if isinstance(r, numbers) else r) for v, r in zip(unknowns, rates)]


def reference(problem):
    """The end by Taylor series in 128 bits; its error from a looser run."""
    import heyoka as hy
    import mpmath as mp

    bits = 128
    system = heyoka_system(problem, lambda x: hy.real(x, bits))

    def end(tolerance):
        start = [hy.real(v, bits) for v in problem.start]
        solver = hy.taylor_adaptive(system, start, fp_type=hy.real, tol=hy.real(tolerance, prec=bits))
        solver.propagate_until(hy.real(problem.duration, bits))
        with mp.workdps(DIGITS):
            return tuple(mp.mpf(str(v)) for v in solver.state[:problem.coordinates])

    best, looser = end("1e-30"), end("1e-24")
    error = max(float(abs(p - q)) for p, q in zip(best, looser))
    return Reference(best, error, "Taylor series in 128 bits (heyoka)")


def distance(end, exact):
    """The largest distance in any coordinate."""
    return max(abs(float(p - q)) for p, q in zip(end, exact))


def lines(problem):
    """heyoka, and DOP853 through SciPy with equations that numba compiles."""
    import heyoka as hy
    from numba import njit
    from scipy.integrate import ode, solve_ivp

    start, n = np.array(problem.start), problem.coordinates

    def taylor(tolerance):
        solver = hy.taylor_adaptive(heyoka_system(problem), list(start), tol=tolerance)

        def run():
            solver.time = 0.0
            solver.state[:] = start
            outcome = solver.propagate_until(problem.duration)
            if outcome[0] != hy.taylor_outcome.time_limit:
                raise ArithmeticError(str(outcome[0]))
            return solver.state[:n].copy(), outcome[3]
        return run

    functions = {name: getattr(np, {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2"}.get(name, name)) for name in FUNCTIONS}
    inner = njit(problem.slope(functions))
    unpacked = ", ".join(f"y[{k}]" for k in range(len(start)))
    found = {"inner": inner, "np": np}
    exec(f"def slope(t, y):\n    return np.array(inner(t, {unpacked}))\n", found)  # pylint: disable=exec-used
    slope = njit(found["slope"])
    slope(0.0, start)

    def compiled(tolerance):
        def run():
            solver = ode(slope).set_integrator("dop853", rtol=tolerance, atol=tolerance, nsteps=10_000_000)
            solver.set_initial_value(start, 0.0)
            y = solver.integrate(problem.duration)
            if not solver.successful():
                raise ArithmeticError(f"return code {solver.get_return_code()}")
            return y[:n], 0
        return run

    def interpreted(tolerance):
        def run():
            found = solve_ivp(slope, (0.0, problem.duration), start, "DOP853", t_eval=[problem.duration], rtol=tolerance, atol=tolerance)
            if not found.success:
                raise ArithmeticError(found.message)
            return found.y[:n, -1], found.nfev
        return run

    return [
        Line("heyoka taylor", "heyoka", "reduced", taylor, [*TOLERANCES, 1e-15]),
        Line("scipy dop853 compiled loop", "scipy", "reduced", compiled, TOLERANCES),
        Line("scipy dop853", "scipy", "reduced", interpreted, TOLERANCES),
    ]
