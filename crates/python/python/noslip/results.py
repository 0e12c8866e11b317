"""A run, as NumPy arrays."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray


def warn(object: Mapping[str, Any]) -> None:
    """Warns whoever has made a run of what its object warns of."""
    for told in object.get("warnings", ()):
        warnings.warn(told, stacklevel=3)


class Run(Mapping[str, NDArray[np.float64]]):
    """The nodes of a run by column name, `run["x"]` or `run.x`, and what the program says of it.

    `units` has the unit of each column.
    """

    def __init__(
        self, columns: dict[str, NDArray[np.float64]], units: dict[str, str], object: dict[str, Any] | str
    ) -> None:
        self._columns = columns
        self.units = units
        self._object = object

    @property
    def object(self) -> dict[str, Any]:
        """The object of `noslip run --json`, read when it is first asked for."""
        if isinstance(self._object, str):
            self._object = dict(json.loads(self._object))
        return self._object

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"no column {name!r}; the columns are {', '.join(self._columns)}") from None

    def __getattr__(self, name: str) -> NDArray[np.float64]:
        columns: dict[str, NDArray[np.float64]] = self.__dict__.get("_columns", {})
        if name in columns:
            return columns[name]
        raise AttributeError(f"no attribute or column {name!r}; the columns are {', '.join(columns)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def scene(self) -> str:
        """The name of the scene."""
        return str(self.object["scene"])

    @property
    def method(self) -> str:
        """The method."""
        return str(self.object["method"])

    @property
    def step(self) -> float:
        """The step (s)."""
        return float(self.object["step"])

    @property
    def steps(self) -> int:
        """How many steps were made."""
        return int(self.object["steps"])

    @property
    def energy_error(self) -> float:
        """The largest energy error `|E - E0 - work|` of all nodes (J)."""
        return float(self.object["energy"]["max_error"])

    @property
    def constraint(self) -> float:
        """The largest constraint residual `|A(q) v + b|` of all nodes; `run["constraint"]` has that of each kept node."""
        return float(self.object["constraint"]["max"])

    @property
    def events(self) -> list[dict[str, Any]]:
        """The events that happened, each with its time and state."""
        return list(self.object.get("events", []))

    @property
    def final(self) -> dict[str, float]:
        """The state at the end."""
        return dict(self.object["final"])

    def to_pandas(self) -> Any:
        """A pandas data frame with the time as its index."""
        import pandas as pd

        frame = pd.DataFrame({name: column for name, column in self.items() if name != "t"}, index=self["t"])
        frame.index.name = "t"
        frame.attrs = {"units": dict(self.units), **{key: self.object[key] for key in ("scene", "method", "step")}}
        return frame

    def to_xarray(self) -> Any:
        """An xarray dataset over the time, with units."""
        import xarray as xr

        variables = {name: ("t", column, {"units": self.units[name]}) for name, column in self.items() if name != "t"}
        attributes = {key: self.object[key] for key in ("scene", "method", "step")}
        return xr.Dataset(variables, coords={"t": ("t", self["t"], {"units": "s"})}, attrs=attributes)

    def plot(self, *names: str) -> Any:
        """A matplotlib figure: the path where there are x and y, and each column named against time."""
        import matplotlib.pyplot as plt

        path = "x" in self and "y" in self
        names = names or tuple(name for name in ("speed", "turn_rate", "energy") if name in self) or tuple(self)[1:4]
        figure, axes = plt.subplots(len(names) + path, 1, figsize=(7, 2.2 * len(names) + 4 * path), squeeze=False)
        rows = [row[0] for row in axes]
        if path:
            place = rows.pop(0)
            place.plot(self["x"], self["y"])
            place.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", title=f"{self.scene}, {self.method}")
        for axis, name in zip(rows, names, strict=True):
            axis.plot(self["t"], self[name])
            axis.set(xlabel="t [s]", ylabel=f"{name} [{self.units[name]}]")
        figure.tight_layout()
        return figure

    def __repr__(self) -> str:
        return (
            f"<noslip.Run of {self.scene} by {self.method}: {self.steps} steps of {self.step:.6g} s, "
            f"energy error {self.energy_error:.2e} J, constraint {self.constraint:.2e}>"
        )

    def _repr_html_(self) -> str:
        """The run for a notebook: its path as a picture, and its numbers."""
        from html import escape

        return f"<p>{escape(repr(self))}</p>{_path_svg(self)}"


def _path_svg(run: Run, size: int = 360) -> str:
    """The path as a line; nothing where there is no x and y."""
    if "x" not in run or "y" not in run or len(run["x"]) < 2:
        return ""
    every = max(1, len(run["x"]) // 2000)
    x, y = run["x"][::every], run["y"][::every]
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        return ""
    span = max(float(np.ptp(x)), float(np.ptp(y))) or 1.0
    across = (x - x.min()) / span * (size - 20) + 10
    down = (y.max() - y) / span * (size - 20) + 10
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, down, strict=True))
    height = float(np.ptp(y)) / span * (size - 20) + 20
    return (
        f'<svg width="{size}" height="{height:.0f}" role="img" aria-label="path">'
        f'<polyline points="{points}" fill="none" stroke="currentColor"/></svg>'
    )
