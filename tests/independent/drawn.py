"""Draws systems of text at random: two to six coordinates, velocity rows, positions, time, forces."""

import numpy as np
import sympy as sp

from mechanics import TIME, Numbers, System, coordinate

NAMES = ("x", "y", "phi", "s", "alpha", "w")


class Draw:
    """One system, by its seed."""

    def __init__(self, seed, still=False):
        self.random, self.seed = np.random.default_rng([62, seed]), seed
        self.timed = not still and self.random.random() < 0.6
        size = int(self.random.integers(2, 7))
        self.names = NAMES[:size]
        self.angles = {name for name in ("phi", "alpha") if self.random.random() < 0.6}
        units = {name: "angle" if name in self.angles else "m" for name in self.names}
        pairs = dict(zip(self.names, map(coordinate, self.names)))
        self.q = {name: pair[0] for name, pair in pairs.items()}
        self.v = {name: pair[1] for name, pair in pairs.items()}
        leads = list(self.random.permutation(self.names))
        held = int(self.random.integers(0, size))
        self.held = [leads.pop() for _ in range(min(held, 4))]
        on_places = int(self.random.integers(0, min(2, len(self.held)) + 1))
        positions = [self.position(name) for name in self.held[:on_places] if name not in self.angles]
        rest = [name for name in self.held if name in self.angles or name not in self.held[:on_places]]
        rows = [self.row(name, still) for name in rest]
        self.system = System(units, self.kinetic() - self.potential(), rows, positions, self.forces())
        self.numbers = Numbers(self.system)
        z = self.numbers.admissible(self.random.uniform(-0.5, 0.5, size), self.random.uniform(-1, 1, size))
        self.start = z if np.abs(self.numbers.constraints(0.0, z)).max(initial=0.0) < 1e-13 else None

    def number(self, low, high):
        return sp.Float(round(float(self.random.uniform(low, high)), 3))

    def sometimes(self, share):
        return self.random.random() < share

    def shape(self, without=()):
        """A smooth function of a coordinate, of size one, with the period of a turn in an angle."""
        name = str(self.random.choice([name for name in self.names if name not in without] or list(self.names)))
        q, k = self.q[name], self.number(0.5, 1.6)
        if name in self.angles:
            return [sp.sin(q + k), sp.cos(q), sp.sin(2 * q), 1 / (2 + sp.cos(q - k))][self.random.integers(4)]
        smooth = [sp.sin(k * q), sp.cos(k * q + k), k * q, q**2 / 2 + k, 1 / (1 + q**2), sp.exp(-(q**2)), sp.tanh(k * q), sp.sqrt(1 + q**2)]
        return smooth[self.random.integers(len(smooth))]

    def in_time(self):
        """A function of time, or one."""
        if not self.timed or self.sometimes(0.5):
            return sp.Integer(1)
        k = self.number(0.5, 2.5)
        return [1 + sp.sin(k * TIME) / 3, sp.exp(-TIME / 4), 1 / (1 + TIME**2 / 9), sp.cos(k * TIME)][self.random.integers(4)]

    def kinetic(self):
        total = sp.Integer(0)
        for i, name in enumerate(self.names):
            speed = self.v[name]
            for other in self.names[:i]:
                if self.sometimes(0.4):
                    speed += self.number(-0.6, 0.6) * self.shape() * self.v[other]
            if self.timed and self.sometimes(0.2):
                speed += self.number(-0.4, 0.4) * sp.sin(self.number(0.5, 2.0) * TIME)
            mass = self.number(0.5, 2.0)
            if self.sometimes(0.3):
                mass *= 1 + self.shape() ** 2 / 5
            total += mass * speed**2 / 2
        return total

    def potential(self):
        total = sp.Integer(0)
        for name, q in self.q.items():
            k, place = self.number(0.4, 3.0), self.number(-0.5, 0.5)
            if name in self.angles:
                total -= k * sp.cos(q - place)
            elif self.sometimes(0.85):
                total += k * (q - place) ** 2 / 2 + (self.number(0.1, 0.6) * q**4 / 4 if self.sometimes(0.3) else 0)
        for _ in range(int(self.random.integers(0, 3))):
            total += self.number(-0.6, 0.6) * self.shape() * self.shape() * self.in_time()
        return total

    def row(self, name, still):
        row = self.v[name]
        for other in self.names:
            if other not in self.held and self.sometimes(0.7):
                row += self.number(-1.0, 1.0) * self.shape() * self.in_time() * self.v[other]
        if not still and self.sometimes(0.3):
            row += self.number(-0.5, 0.5) * self.shape() * self.in_time()
        return row

    def position(self, name):
        """`name` as a function of the coordinates that are free, in closed form or not."""
        q, known = self.q[name], (*self.held,)
        place = q + self.number(-0.3, 0.3)
        for _ in range(int(self.random.integers(1, 3))):
            place += self.number(-0.7, 0.7) * self.shape(known) * self.in_time()
        if self.sometimes(0.4):
            place += self.number(0.1, 0.3) * sp.sin(q) * self.shape(known)
        if self.sometimes(0.3):
            # The same set as a level of squares: a circle, a hyperbola, .. about a far middle.
            place = ((place + 2) ** 2 - 4) / 4
        return sp.expand(place) if self.sometimes(0.2) else place

    def forces(self):
        forces = {}
        for name in self.names:
            force, v = sp.Integer(0), self.v[name]
            if self.sometimes(0.4):
                force -= self.number(0.05, 0.6) * v
            if self.sometimes(0.15):
                force -= self.number(0.05, 0.3) * v * sp.sqrt(1 + v**2)
            if self.sometimes(0.2):
                force += self.number(-0.5, 0.5) * self.shape() * self.in_time()
            if self.timed and self.sometimes(0.2):
                force += self.number(-0.8, 0.8) * sp.cos(self.number(0.5, 3.0) * TIME)
            if force != 0:
                forces[name] = force
        return forces
