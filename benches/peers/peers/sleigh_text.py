"""A scene of a sleigh as a system of text: for effects that only the exporter of formulas knows, as moving masses, rotors and turntables."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from . import text
from .scene import SCENES, Refused, number, pair

U = "(x'*c + y'*s)"
# The centre of mass.
CX, CY = "(x + a*c)", "(y + a*s)"


def function(value):
    """A function of time and its derivative, as formulas."""
    if not isinstance(value, dict):
        return repr(number({"value": value}, "value")), "0"
    if "amplitude" not in value:
        raise Refused("a table of times is no formula")
    a, w, p = number(value, "amplitude"), number(value, "frequency"), number(value, "phase", 0.0)
    return f"{a!r}*sin({w!r}*t + {p!r})", f"{a * w!r}*cos({w!r}*t + {p!r})"


def read(name, duration=None):
    """The problem of the scene of that name, of which the ends are compared in x, y and the heading."""
    path = Path(name) if Path(name).is_file() else SCENES / f"{name}.toml"
    with TemporaryDirectory() as folder:
        file = Path(folder) / path.name
        file.write_text(written(tomllib.loads(path.read_text())))
        return replace(text.read(str(file), duration), name=path.stem, coordinates=3)


def written(scene):
    """The text of the system."""
    m, inertia, a = (number(scene["sleigh"], key) for key in ("mass", "inertia", "offset"))
    start = {key: number(scene["start"], key, 0.0) for key in ("x", "y", "heading", "speed", "turn_rate")}
    terms = ["m/2*((x' - a*s*theta')^2 + (y' + a*c*theta')^2) + I/2*theta'^2"]
    forces = {"x": [], "y": [], "theta": []}
    # How fast the plane turns (rad/s): the blade moves sideways with the plane.
    coordinates, rates, turning = {"x": "m", "y": "m", "theta": "angle"}, {}, 0.0

    def along(force):
        forces["x"].append(f"({force})*c")
        forces["y"].append(f"({force})*s")

    for effect in scene.get("effects", []):
        kind = effect["kind"]
        if kind == "slope":
            gx, gy = pair(effect, "gravity")
            terms.append(f"m*({gx!r}*{CX} + {gy!r}*{CY})")
        elif kind == "bowl":
            (kx, ky), (x, y) = pair(effect, "stiffness"), pair(effect, "center", (0.0, 0.0))
            terms.append(f"-{kx!r}/2*({CX} - ({x!r}))^2 - {ky!r}/2*({CY} - ({y!r}))^2")
        elif kind == "drag":
            along(f"-{number(effect, 'along', 0.0)!r}*{U}")
            forces["theta"].append(f"-{number(effect, 'turning', 0.0)!r}*theta'")
        elif kind == "thrust":
            along(function(effect["force"])[0])
        elif kind == "torque":
            forces["theta"].append(function(effect["torque"])[0])
        elif kind == "moving_mass":
            (x, dx), (y, dy) = function(effect.get("x", 0.0)), function(effect.get("y", 0.0))
            vx = f"(x' - theta'*(s*({x}) + c*({y})) + c*({dx}) - s*({dy}))"
            vy = f"(y' + theta'*(c*({x}) - s*({y})) + s*({dx}) + c*({dy}))"
            terms.append(f"{number(effect, 'mass')!r}/2*({vx}^2 + {vy}^2)")
        elif kind == "flywheel":
            coordinates["psi"], rates["psi'"] = "rad", number(effect, "rotor_rate", 0.0)
            terms.append(f"{number(effect, 'inertia')!r}/2*(theta' + psi')^2")
            if "torque" in effect:
                forces["psi"] = [function(effect["torque"])[0]]
        elif kind == "turntable":
            turning = number(effect, "rate")
        else:
            raise Refused(f"the effect `{kind}` is no formula here")
    quoted = lambda table: "{ " + ", ".join(f'{key} = "{value}"' for key, value in table.items()) + " }"
    acting = {key: " + ".join(list_) for key, list_ in forces.items() if list_}
    cos, sin = math.cos(start["heading"]), math.sin(start["heading"])
    sideways = turning * (start["x"] * cos + start["y"] * sin)
    rates |= {"x'": start["speed"] * cos - sideways * sin, "y'": start["speed"] * sin + sideways * cos, "theta'": start["turn_rate"]}
    run = scene["run"]
    return "\n".join([
        "[system]",
        f"coordinates = {quoted(coordinates)}",
        f"parameters = {{ m = {m!r}, I = {inertia!r}, a = {a!r} }}",
        'let = { c = "cos(theta)", s = "sin(theta)" }',
        f'lagrangian = "{" + ".join(terms)}"',
        f'''constraints = ["y'*c - x'*s - ({turning!r}*(x*c + y*s))"]''',
        *([f"forces = {quoted(acting)}"] if acting else []),
        "[start]",
        *(f"{key} = {start[name]!r}" for key, name in (("x", "x"), ("y", "y"), ("theta", "heading"))),
        *(f'"{key}" = {value!r}' for key, value in rates.items()),
        "[run]",
        f"step = {number(run, 'step')!r}",
        f"duration = {number(run, 'duration')!r}",
        "",
    ])
