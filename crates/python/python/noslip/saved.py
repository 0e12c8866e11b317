"""Runs that are saved now and then, and go on after a stop."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .commands import call, flags
from .errors import Interrupted, RunError
from .progress import Progress
from .results import Run, warn


def saved_run(
    text: str, name: str, checkpoint: Path, settings: Mapping[str, Any], progress: bool | Progress | None
) -> Run:
    """The run of a scene, saved to the file `checkpoint`; where that is there already, the run goes on from there.

    The nodes are in the file of that name with `.npz` at its end.
    """
    rows = checkpoint.with_name(f"{checkpoint.name}.npz")
    saved = {"out": rows, "checkpoint": checkpoint, "resume": checkpoint if checkpoint.exists() else None}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{name}.toml"
        file.write_text(text, encoding="utf-8")
        try:
            object = call(["run", str(file), "--json", *flags({**saved, **settings})], progress)
        except Interrupted as interrupted:
            raise Interrupted(_read(rows, interrupted.result)) from None
    run = _read(rows, object)
    warn(object)
    if "failure" in object:
        raise RunError(str(object["failure"].get("reason")), run)
    return run


def _read(rows: Path, object: Any) -> Run:
    """The nodes in a file, with their units."""
    with np.load(rows) as archive:
        columns = {name: archive[name] for name in archive.files if name != "metadata"}
        metadata = json.loads(str(archive["metadata"]))
    units = {column["name"]: column.get("schema:unitText", "") for column in metadata["tableSchema"]["columns"]}
    return Run(columns, units, object)
