"""Hard systems of text: oscillators and stiff springs, light coordinates, bodies that turn far by a unit vector or a quaternion."""

from functools import cache

import numpy as np
import sympy as sp

from hard_scene import Chance, Hard
from mechanics import Numbers, System, coordinate


def symbols(names):
    return [sp.Symbol(name, positive=True) for name in names.split()]


@cache
def text(name):
    """The equations of a system of text by name, with the units of its parameters as symbols."""
    (x, u), (y, v), (s, w), (c, o) = map(coordinate, "xysc")
    if name == "oscillator":
        m, k = symbols("m k")
        return Numbers(System({"x": "m"}, m * u**2 / 2 - k * x**2 / 2, parameters=[m, k]))
    if name == "two springs":
        m, k, n = symbols("m k n")
        return Numbers(System({"x": "m", "y": "m"}, m * (u**2 + v**2) / 2 - k * x**2 / 2 - n * (y - x - 1) ** 2 / 2, parameters=[m, k, n]))
    if name == "light cart":
        m, n, g = symbols("m n g")
        lagrangian = m * w**2 / 2 + n * (u**2 + v**2) / 2 - n * g * y
        return Numbers(System(dict.fromkeys("sxy", "m"), lagrangian, positions=[(x - s) ** 2 + y**2 - 1], parameters=[m, n, g]))
    if name == "light caster":
        m, n, k = symbols("m n k")
        th, r = coordinate("th")
        lagrangian = m * (u**2 + v**2) / 2 + n * r**2 / 2 - k * (x**2 + 2 * y**2) / 2
        return Numbers(
            System({"x": "m", "y": "m", "th": "angle"}, lagrangian, [-u * sp.sin(th) + v * sp.cos(th) - r / 5], parameters=[m, n, k])
        )
    if name == "vector":
        m, j, k = symbols("m j k")
        lagrangian = m * ((u + o / 3) ** 2 + (v + w / 3) ** 2) / 2 + j * (o**2 + w**2) / 2 - k * (x**2 + y**2) / 2
        return Numbers(System({"x": "m", "y": "m", "c": "", "s": ""}, lagrangian, [c * v - s * u], [c**2 + s**2 - 1], parameters=[m, j, k]))
    if name == "top":
        j, k, l = symbols("j k l")
        e, r = (sp.Matrix(pair) for pair in zip(*(coordinate(f"e{i}") for i in range(4))))
        turn = [
            2 * (e[0] * r[i] - e[i] * r[0] - e[(i % 3) + 1] * r[(i + 1) % 3 + 1] + e[(i + 1) % 3 + 1] * r[i % 3 + 1]) for i in (1, 2, 3)
        ]
        lagrangian = sum(inertia * rate**2 for inertia, rate in zip((j, k, l), turn)) / 2 + sp.Rational(1, 5) * (e[1] ** 2 + e[2] ** 2)
        lagrangian += (j + k + l) / 6 * sum(e[i] * r[i] for i in range(4)) ** 2
        return Numbers(System({f"e{i}": "" for i in range(4)}, lagrangian, positions=[(e.dot(e) - 1) / 2], parameters=[j, k, l]))
    raise ValueError(name)


class Text(Chance):
    """Draws one."""

    def draw(self):
        names = ("light cart", "light caster") if self.kind == "light" else ("oscillator", "two springs", "vector", "top", "vector", "top")
        name = str(self.random.choice(names))
        if name == "oscillator":
            values, q, v = (self.decades(-6, 6), self.decades(-6, 9)), [self.between(-1, 1) * self.random.integers(0, 2)], [self.sign()]
        elif name == "two springs":
            values = (self.decades(-1, 2), self.decades(1, 3), self.decades(3, 15))
            q, v = [0.5, 1.5], [0.0, 0.0]
        elif name == "light cart":
            angle = self.between(-2, 2)
            values, q, v = (self.decades(-12, -2), self.decades(-1, 1), 9.81), [0.0, np.sin(angle), -np.cos(angle)], [0.3, 0.0, 0.0]
        elif name == "light caster":
            values = (self.decades(-1, 1), self.decades(-14, -3), self.decades(-1, 1))
            q, v = [0.5, -0.3, self.between(-2, 2)], [self.between(-1, 1), self.between(-1, 1), 0.0]
        elif name == "vector":
            angle, turn = self.between(-3, 3), self.sign() * self.decades(-1, 2)
            ahead, across = np.cos(angle), np.sin(angle)
            values = (1.0, self.decades(-1, 1), self.decades(-2, 2))
            q, v = [0.2, 0.1, ahead, across], [0.5 * ahead, 0.5 * across, -turn * across, turn * ahead]
        else:
            e = self.random.normal(size=4)
            e /= np.linalg.norm(e)
            rate = self.random.normal(size=4) * self.decades(-1, 1.5)
            values, q, v = tuple(self.decades(-0.5, 0.5) for _ in range(3)), e, rate - e * (e @ rate)
        numbers = text(name).bound(values)
        z = numbers.admissible(np.array(q, dtype=float), np.array(v, dtype=float))
        system, n = numbers.system, numbers.size
        written = lambda step, duration: system.text(z[:n], z[n:], step, duration, values)
        return Hard(
            self.seed, f"{self.kind}, {name}", numbers, z, written, [("final", name, k) for k, name in enumerate(system.units)], True
        )
