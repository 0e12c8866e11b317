"""Many variants of a scene."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from numpy.typing import NDArray

from . import _noslip
from .commands import call
from .parts import Submits, gather
from .progress import Progress, shown
from .scenes import Scene, tables

Sweep = str | PathLike[str] | Mapping[str, Any]


class Ensemble(dict[str, NDArray[Any]]):
    """The rows of a sweep by column name, and `summary`, the object of `noslip ensemble --json`."""

    def __init__(self, columns: dict[str, NDArray[Any]], summary: dict[str, Any]) -> None:
        super().__init__(columns)
        self.summary = summary

    def quantiles(self, *levels: float) -> dict[str, NDArray[np.float64]]:
        """The quantiles of every column over the members that did not fail; without levels the median and the quartiles."""
        good = np.asarray(self["failed"]) == 0
        return {
            name: np.nanquantile(column[good], levels or (0.25, 0.5, 0.75))
            for name, column in self.items()
            if name not in ("member", "failed") and not np.isnan(column[good]).all()
        }

    def to_pandas(self) -> Any:
        """A pandas data frame with the number of the member as its index."""
        import pandas as pd

        return pd.DataFrame(dict(self)).set_index("member")


def ensemble(
    sweep: Sweep,
    *,
    executor: Submits | None = None,
    parts: str | PathLike[str] | None = None,
    tasks: int = 64,
    retries: int = 3,
    progress: bool | Progress | None = None,
) -> Ensemble:
    """Computes all members of a sweep, given by its file or by a dictionary with the tables of one.

    The `scene` of a dictionary may be a `noslip.Scene` too.

    With `executor`, anything with the `submit` of `concurrent.futures.Executor`, or a client of Dask, the sweep is computed as
    `tasks` parts, each of them a task; the numbers are those of one process, to the last bit. Every worker writes its part into the folder
    `parts`, which all of them have. A part that fails is made again, `retries` times at most. The parts that are done stay in the folder:
    the same call makes the others.
    """
    with tempfile.TemporaryDirectory(prefix="noslip-", ignore_cleanup_errors=True) as folder:
        place = Path(folder if parts is None else parts)
        place.mkdir(parents=True, exist_ok=True)
        file, rows = written(sweep, place), Path(folder) / "members.npz"
        if executor is None and parts is None:
            summary = call(["ensemble", str(file), "--json", "--out", str(rows)], progress)
        else:
            begin = time.perf_counter()
            with shown(progress) as tell:
                computed = gather(file, place, executor, tasks, retries, tell)
            summary = call(["merge", str(place), "--json", "--out", str(rows)])
            summary |= {"wall_seconds": time.perf_counter() - begin, "computed": computed}
        with np.load(rows) as archive:
            columns = [name for name in archive.files if name != "metadata"]
            return Ensemble({name: archive[name] for name in columns}, summary)


def written(sweep: Sweep, folder: Path) -> Path:
    """The file of a sweep; of a dictionary, written into the folder."""
    if not isinstance(sweep, Mapping):
        return Path(sweep).absolute()
    content = tables(sweep)
    if isinstance(content.get("scene"), Scene):
        content["scene"] = str(_keep(folder / "scene.toml", content["scene"].text))
    return _keep(folder / "sweep.toml", tomli_w.dumps(content))


def _keep(file: Path, text: str) -> Path:
    """Writes a file, unless it is there with that text."""
    if not file.exists():
        new = file.with_name(f"{file.name}.new")
        new.write_text(text, encoding="utf-8")
        new.replace(file)
    elif file.read_text(encoding="utf-8") != text:
        raise _noslip.RequestError(f"{file} is there, of another sweep: every sweep has a folder of its own")
    return file.absolute()
