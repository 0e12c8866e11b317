"""A scene file, read as far as the peers can follow it."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

SCENES = Path(__file__).resolve().parents[3] / "docs" / "scenes"


class Refused(Exception):
    """A scene that the peers cannot integrate, or no scene at all."""


@dataclass(frozen=True)
class Problem:
    """The sleigh and what acts on it: kg, kg m^2, m; start (x, y, heading, speed, turn_rate) in m, rad, m/s, rad/s."""

    name: str
    mass: float
    inertia: float
    offset: float
    start: tuple
    duration: float
    effects: tuple = ()

    def as_dict(self):
        keys = ("mass", "inertia", "offset", "start", "duration", "effects")
        return {key: getattr(self, key) for key in keys}


def number(table, key, default=None):
    """A number of a table; anything else under its key is refused."""
    value = table.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Refused(f"`{key}` must be a constant number here, not {value!r}")
    return float(value)


def pair(table, key, default=None):
    """Two numbers of a table."""
    value = table.get(key, default)
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise Refused(f"`{key}` must be two numbers, not {value!r}")
    return tuple(number({key: x}, key) for x in value)


def read_effect(entry):
    """The effects of one entry of a scene: `hills` are one for each hill."""
    kind = entry.get("kind")
    if kind == "slope":
        return [{"kind": kind, "gravity": pair(entry, "gravity")}]
    if kind == "bowl":
        return [{"kind": kind, "stiffness": pair(entry, "stiffness"), "center": pair(entry, "center", (0.0, 0.0))}]
    if kind == "egg_crate":
        return [{"kind": kind, "height": number(entry, "height"), "wave_number": pair(entry, "wave_number")}]
    if kind == "hills":
        keys = ("height", "x", "y", "width")
        return [{"kind": "hill", **{key: number(hill, key) for key in keys}} for hill in entry.get("hills", [])]
    if kind == "drag":
        return [{"kind": kind, "along": number(entry, "along", 0.0), "turning": number(entry, "turning", 0.0)}]
    if kind == "thrust":
        return [{"kind": kind, "force": number(entry, "force")}]
    raise Refused(f"the peers know no effect `{kind}`; they know slope, bowl, egg_crate, hills, drag, constant thrust")


def read(scene, duration=None):
    """The problem of a scene file or of a bundled scene. `duration` (s) replaces that of the file.

    Without it a scene with an egg crate runs 20 s at most, and one with a bowl, where the motion comes back, 100 s.
    """
    path = Path(scene)
    if not path.is_file():
        path = SCENES / f"{scene.replace('_', '-')}.toml"
    if not path.is_file():
        bundled = ", ".join(sorted(p.stem for p in SCENES.glob("*.toml")))
        raise Refused(f"no scene `{scene}`: neither a file nor one of {bundled}")
    try:
        table = tomllib.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise Refused(f"{path}: {error}") from None
    body, start, run = (table.get(key, {}) for key in ("sleigh", "start", "run"))
    try:
        effects = tuple(e for entry in table.get("effects", []) for e in read_effect(entry))
        if duration is None:
            duration = number(run, "duration")
            kinds = {e["kind"] for e in effects}
            # Two runs of a chaotic motion have nothing in common after that.
            if "egg_crate" in kinds:
                duration = min(duration, 20.0)
            elif "bowl" in kinds:
                duration = 100.0
        begin = (number(start, "x", 0.0), number(start, "y", 0.0), number(start, "heading", 0.0),
                 number(start, "speed"), number(start, "turn_rate"))
        parameters = (number(body, key) for key in ("mass", "inertia", "offset"))
        return Problem(path.stem, *parameters, begin, duration, effects)
    except Refused as refused:
        raise Refused(f"{path}: {refused}") from None


def case(name, duration=None):
    """The cases S1, S2, L, bowl: m = I = 1, (u, omega) = (-1, 0.1), 100 s."""
    weak = {"stiffness": (0.05, 0.05), "center": (0.0, 0.0)}
    cases = {
        "S1": (0.5, ()),
        "S2": (0.1, ()),
        "L": (0.5, ({"kind": "blade_bowl", **weak},)),  # V = r^2 / 40 at the blade
        "bowl": (0.5, ({"kind": "bowl", "stiffness": (0.1, 0.1), "center": (0.0, 0.0)},)),
    }
    if name not in cases:
        raise Refused(f"no case `{name}`: {', '.join(cases)}")
    offset, effects = cases[name]
    return Problem(name, 1.0, 1.0, offset, (0.0, 0.0, 0.0, -1.0, 0.1), duration or 100.0, effects)
