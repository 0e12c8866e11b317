"""Lyapunov exponents of one motion in two forms, minimal coordinates and coordinates held by positions: the same within their intervals."""

import sys

import numpy as np
import sympy as sp

from mechanics import TIME, Numbers, System, coordinate
from program import Findings, Program, arguments


def pendulum():
    """Driven and damped, by its angle and by its place; the sum of the exponents is that of the damping."""
    th, w = coordinate("th")
    (x, u), (y, v) = map(coordinate, "xy")
    push = sp.Float(1.15) * sp.cos(2 * TIME / 3)
    angle = System({"th": "angle"}, w**2 / 2 + sp.cos(th), forces={"th": -w / 2 + push})
    place = System(
        {"x": "m", "y": "m"}, (u**2 + v**2) / 2 - y, positions=[x**2 + y**2 - 1], forces={"x": -u / 2 - y * push, "y": -v / 2 + x * push}
    )
    start = 0.5
    return (angle, [start], [0.0]), (place, [np.sin(start), -np.cos(start)], [0.0, 0.0]), 0.05, -0.5


def double_pendulum():
    """By two angles and by two places; the energy is kept, so the exponents add up to zero."""
    (a, p), (b, r) = map(coordinate, ("a", "b"))
    (x, u), (y, v), (z, w), (s, o) = map(coordinate, "xyzs")
    angles = System({"a": "angle", "b": "angle"}, p**2 + r**2 / 2 + p * r * sp.cos(a - b) + 2 * sp.cos(a) + sp.cos(b))
    places = System(
        dict.fromkeys("xyzs", "m"), (u**2 + v**2 + w**2 + o**2) / 2 - y - s, positions=[x**2 + y**2 - 1, (z - x) ** 2 + (s - y) ** 2 - 1]
    )
    first, second = 1.9, 2.3
    x0, y0 = np.sin(first), -np.cos(first)
    return (angles, [first, second], [0.0, 0.0]), (places, [x0, y0, x0 + np.sin(second), y0 - np.cos(second)], [0.0] * 4), 0.02, 0.0


def sleigh():
    """In a valley, by its heading and by the unit vector along its blade."""
    (_, u), (y, v), (th, w) = map(coordinate, ("x", "y", "th"))
    (c, dc), (s, ds) = map(coordinate, "cs")

    def valley(ahead, across, dahead, dacross):
        speed = (u + dahead / 2) ** 2 + (v + dacross / 2) ** 2
        return speed / 2 + (dahead**2 + dacross**2) / 2 - (y + across / 2) ** 2 / 2, [-across * u + ahead * v]

    lagrangian, rows = valley(sp.cos(th), sp.sin(th), -sp.sin(th) * w, sp.cos(th) * w)
    heading = System({"x": "m", "y": "m", "th": "angle"}, sp.expand(lagrangian), rows)
    lagrangian, rows = valley(c, s, dc, ds)
    vector = System({"x": "m", "y": "m", "c": "", "s": ""}, lagrangian, rows, [c**2 + s**2 - 1])
    angle, speed, turn = 0.7, -1.1, 1.3
    ahead, across = np.cos(angle), np.sin(angle)
    place = [0.0, 0.3]
    moves = [speed * ahead, speed * across]
    return (heading, [*place, angle], [*moves, turn]), (vector, [*place, ahead, across], [*moves, -across * turn, ahead * turn]), 0.05, None


def main():
    parser = arguments(__doc__, 3)
    parser.add_argument("--duration", type=float, default=4000.0, help="s [default: %(default)s]")
    options = parser.parse_args()
    program, findings = Program(options.program, options.folder), Findings()
    for pair in (pendulum, double_pendulum, sleigh)[: options.count]:
        *forms, step, total = pair()
        files = []
        for kind, (system, q, v) in zip(("minimal", "held"), forms):
            z = Numbers(system).admissible(np.array(q), np.array(v))
            n = system.size
            files.append(program.scene(f"{pair.__name__}-{kind}", system.text(z[:n], z[n:], step, 10.0)))
        for method in ("gauss8", "dla4"):
            where = {"pair": pair.__name__, "method": method}
            answers = [program.ask("lyapunov", file, "--method", method, "--duration", options.duration) for file in files]
            for kind, answer in zip(("minimal", "held"), answers):
                if answer.code != 0:
                    findings.fail("refused", **where, form=kind, message=answer.refusal)
            if any(answer.code != 0 for answer in answers):
                continue
            (one, far), (other, near) = ((answer.shown["exponents"], answer.shown["ci"]) for answer in answers)
            shown = {"minimal": [round(value, 5) for value in one], "held": [round(value, 5) for value in other]}
            if len(one) != len(other):
                findings.fail("number of exponents", **where, **shown)
            elif any(abs(a - b) > k + l for a, b, k, l in zip(one, other, far, near)):
                findings.fail("exponents", **where, **shown, intervals=[far, near])
            elif total is not None and max(abs(sum(one) - total), abs(sum(other) - total)) > 1e-3:
                findings.fail("sum", **where, **shown, right=total)
            else:
                findings.count("pairs right")
                print(where, shown, "+-", [round(k + l, 5) for k, l in zip(far, near)], flush=True)
    return findings.end()


if __name__ == "__main__":
    sys.exit(main())
