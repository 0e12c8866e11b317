"""Exact derivatives of runs in their start and in parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray


class Sensitivities:
    """Numbers of a run, and their derivatives in some keys of its scene.

    `values` has the numbers of all `columns` at the first of the times `t`, then at the next; `jacobian` has a row for each of
    them and a column for each of the `keys`: the shape that `scipy.optimize.least_squares` takes.
    """

    def __init__(
        self,
        keys: Sequence[str],
        columns: Sequence[str],
        t: Iterable[float],
        values: NDArray[np.float64],
        jacobian: NDArray[np.float64],
    ) -> None:
        self.keys = tuple(keys)
        self.columns = tuple(columns)
        self.t = np.array(list(t), dtype=np.float64)
        self.values = values
        self.jacobian = jacobian

    def _place(self, column: str) -> int:
        if column not in self.columns:
            raise KeyError(f"no column {column!r}; the columns are {', '.join(self.columns)}")
        return self.columns.index(column)

    def __getitem__(self, column: str) -> NDArray[np.float64]:
        """The numbers of a column, one for each time."""
        return self.values[self._place(column) :: len(self.columns)]

    def of(self, column: str) -> NDArray[np.float64]:
        """The derivatives of a column: a row for each time, a column for each key."""
        return self.jacobian[self._place(column) :: len(self.columns)]

    def __repr__(self) -> str:
        keys, columns = ", ".join(self.keys), ", ".join(self.columns)
        return f"<noslip.Sensitivities of {columns} in {keys} at {len(self.t)} times>"


class Prediction:
    """Numbers of a run as a function of some numbers of its scene, with its derivative, as optimisers ask for both.

    >>> predicted = scene.prediction(["sleigh.offset", "start.speed"], columns=["x", "y"], t_eval=times)
    >>> fit = least_squares(lambda p: predicted(p) - data, [0.4, 1.0], jac=predicted.jacobian)
    """

    def __init__(self, keys: Sequence[str], made: Callable[[dict[str, float]], Sensitivities]) -> None:
        self.keys = tuple(keys)
        self._made = made
        self._last: tuple[tuple[float, ...], Sensitivities] | None = None

    def sensitivities(self, numbers: ArrayLike) -> Sensitivities:
        """Numbers and derivatives at these values of the keys; those of the last call are kept."""
        at = tuple(float(number) for number in np.atleast_1d(np.asarray(numbers, dtype=np.float64)))
        if self._last is None or self._last[0] != at:
            self._last = (at, self._made(dict(zip(self.keys, at, strict=True))))
        return self._last[1]

    def __call__(self, numbers: ArrayLike) -> NDArray[np.float64]:
        """The numbers of the run."""
        return self.sensitivities(numbers).values

    def jacobian(self, numbers: ArrayLike) -> NDArray[np.float64]:
        """The derivatives of each of them in each key."""
        return self.sensitivities(numbers).jacobian
