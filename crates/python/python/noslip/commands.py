"""Commands of the program: their flags, the object that each prints, and its errors as exceptions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from . import _noslip
from .errors import Interrupted
from .progress import Progress, shown


def flags(settings: Mapping[str, Any]) -> list[str]:
    """Keyword arguments as flags: `event_samples=8` is `--event-samples=8`, `True` is a flag alone, a list is given item by item."""
    given = []
    for key, value in settings.items():
        flag = f"--{key.replace('_', '-')}"
        if value is True:
            given.append(flag)
        elif isinstance(value, list):
            given.extend(f"{flag}={one}" for one in value)
        elif value is not None and value is not False:
            given.append(f"{flag}={value}")
    return given


def call(arguments: list[str], progress: bool | Progress | None = None) -> dict[str, Any]:
    """The object that a command of the program prints; its errors as exceptions."""
    with shown(progress) as tell:
        code, out, err, ended = _noslip.command(arguments, tell)
    object: dict[str, Any] = json.loads(out) if out else {}
    if isinstance(ended, KeyboardInterrupt):
        raise Interrupted(object) from None
    if ended is not None:
        raise ended
    # What the program says of a command line is not for who writes Python.
    message = err.partition("\n\nUsage:")[0].partition("\n\nFor more")[0].partition("\n\n  tip:")[0].strip().removeprefix("error: ")
    if code == 2:
        raise _noslip.RequestError(message)
    if code != 0 and not object:
        raise _noslip.ComputationError(message)
    return object
