"""Many variants of a scene."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from numpy.typing import NDArray

from .progress import Progress
from .scenes import call


class Ensemble(dict[str, NDArray[Any]]):
    """The rows of a sweep by column name, and `summary`, the object of `noslip ensemble --json`."""

    def __init__(self, columns: dict[str, NDArray[Any]], summary: dict[str, Any]) -> None:
        super().__init__(columns)
        self.summary = summary


def ensemble(sweep: str | PathLike[str] | Mapping[str, Any], *, progress: bool | Progress | None = None) -> Ensemble:
    """Computes all members of a sweep, given by its file or by a dictionary with the tables of one."""
    with tempfile.TemporaryDirectory() as folder:
        if isinstance(sweep, Mapping):
            file = Path(folder) / "sweep.toml"
            file.write_text(tomli_w.dumps(dict(sweep)), encoding="utf-8")
        else:
            file = Path(sweep)
        rows = Path(folder) / "members.npz"
        summary = call(["ensemble", str(file), "--json", "--out", str(rows)], progress)
        with np.load(rows) as archive:
            columns = [name for name in archive.files if name != "metadata"]
            return Ensemble({name: archive[name] for name in columns}, summary)
