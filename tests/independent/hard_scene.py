"""Numbers drawn from a seed, and a hard scene as it is drawn."""

from dataclasses import dataclass

import numpy as np

from mechanics import Numbers


@dataclass
class Hard:
    """A scene as text, its equations, its start, and the names by which the program shows the places of its end."""

    seed: int
    kind: str
    numbers: Numbers
    start: np.ndarray
    text: object
    shown: list
    conservative: bool
    # Whether a force has a corner, where no method has its order.
    corners: bool = False


class Chance:
    """Draws numbers of a seed."""

    def __init__(self, seed, kind):
        self.random, self.seed, self.kind = np.random.default_rng([700, seed]), seed, kind

    def between(self, low, high):
        return float(self.random.uniform(low, high))

    def decades(self, low, high):
        return float(10 ** self.random.uniform(low, high))

    def sign(self):
        return float(self.random.choice((-1, 1)))
