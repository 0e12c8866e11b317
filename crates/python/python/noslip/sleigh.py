"""The Chaplygin sleigh, in a line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import tomli_w

from .scenes import Scene, tables


class Sleigh(Scene):
    """A sleigh with its start.

    `mass` in kg, `inertia` about the centre of mass in kg m^2, `offset` of the centre of mass ahead of the blade in m.
    `effects` are dictionaries as in scene files, `{"kind": "bowl", "stiffness": [0.1, 0.1]}`.
    """

    def __init__(
        self,
        *,
        mass: float = 1.0,
        inertia: float = 1.0,
        offset: float = 0.5,
        x: float = 0.0,
        y: float = 0.0,
        heading: float = 0.0,
        speed: float = 1.0,
        turn_rate: float = 0.0,
        effects: Sequence[Mapping[str, Any]] = (),
        method: str = "dla",
        step: float = 0.05,
        duration: float = 20.0,
    ) -> None:
        start = {"x": x, "y": y, "heading": heading, "speed": speed, "turn_rate": turn_rate}
        content: dict[str, Any] = {
            "sleigh": {"mass": float(mass), "inertia": float(inertia), "offset": float(offset)},
            "start": {key: float(value) for key, value in start.items()},
            "run": {"method": method, "step": float(step), "duration": float(duration)},
        }
        if effects:
            content["effects"] = [dict(effect) for effect in effects]
        super().__init__(tomli_w.dumps(tables(content)), "sleigh")
