"""Hard sleighs and trains: fast spins, stiff wells, small inertias, drag to rest, units of any size."""

from functools import cache

import numpy as np
import sympy as sp

from hard_scene import Chance, Hard
from mechanics import TIME, Numbers, System, coordinate

# Effects by name: the symbols of their numbers, with values that leave each out.
EFFECTS = {"gx": 0, "gy": 0, "kx": 0, "ky": 0, "crate": 0, "wx": 1, "wy": 1, "hill": 0, "hx": 0, "hy": 0, "width": 1, "drag": 0, "turning": 0,
           "square": 0, "friction": 0, "smooth": 1, "thrust": 0, "fast": 1, "rate": 0}  # fmt: skip


@cache
def sleigh(trailers, rotor):
    """The equations of a sleigh under every effect."""
    value = {name: sp.Symbol(f"{name}_") for name in (*EFFECTS, "m", "J", "a", "Jr", "mt", "Jt", "at", "hitch", "bar")}
    headings = ["th", *(f"th{k}" for k in range(1, trailers + 1))]
    units = {"x": "m", "y": "m", **dict.fromkeys(headings, "angle"), **({"psi": "rad"} if rotor else {})}
    (x, u), (y, v) = map(coordinate, "xy")
    rates, place = {x: u, y: v}, sp.Matrix([x, y])
    lagrangian, rows, last = sp.Integer(0), [], None
    for k, name in enumerate(headings):
        q, w = coordinate(name)
        rates[q] = w
        ahead, across = sp.Matrix([sp.cos(q), sp.sin(q)]), sp.Matrix([-sp.sin(q), sp.cos(q)])
        if k:
            place = place - value["hitch"] * last - value["bar"] * ahead
        last = ahead
        m, inertia, a = (value[key] for key in (("mt", "Jt", "at") if k else ("m", "J", "a")))
        moved = lambda point: sum((point.diff(q) * w for q, w in rates.items()), sp.zeros(2, 1))
        cx, cy = place + a * ahead
        speed = moved(sp.Matrix([cx, cy]))
        lagrangian += m * speed.dot(speed) / 2 + inertia * w**2 / 2 + m * (value["gx"] * cx + value["gy"] * cy)
        lagrangian -= (
            value["kx"] * cx**2 / 2 + value["ky"] * cy**2 / 2 + value["crate"] * (sp.cos(value["wx"] * cx) + sp.cos(value["wy"] * cy))
        )
        lagrangian -= value["hill"] * sp.exp(-((cx - value["hx"]) ** 2 + (cy - value["hy"]) ** 2) / (2 * value["width"] ** 2))
        rows.append(across.dot(moved(place) - value["rate"] * sp.Matrix([-place[1], place[0]])))
    q, w = coordinate("th")
    along = u * sp.cos(q) + v * sp.sin(q)
    push = -value["drag"] * along - value["square"] * along * sp.sqrt(along**2) - value["friction"] * sp.tanh(along / value["smooth"])
    push += value["thrust"] * sp.sin(value["fast"] * TIME)
    forces = {"x": push * sp.cos(q), "y": push * sp.sin(q), "th": -value["turning"] * w}
    if rotor:
        lagrangian += value["Jr"] * (w + coordinate("psi")[1]) ** 2 / 2
    return Numbers(System(units, lagrangian, rows, [], forces, list(value.values()))), list(value)


class Sleigh(Chance):
    """Draws one."""

    def draw(self):
        kind, random = self.kind, self.random
        length = mass = time = 1.0
        if kind == "units":
            length, mass, time = self.decades(-6, 6), self.decades(-9, 9), self.decades(-5, 5)
        given = {
            "m": self.between(0.5, 2),
            "J": self.between(0.3, 2),
            "a": self.between(-0.5, 0.7) * random.integers(0, 2),
            "Jr": 0.0,
            "mt": 0.0,
            "Jt": 0.0,
            "at": 0.0,
            "hitch": 0.0,
            "bar": 1.0,
        }
        start = {
            "x": self.between(-1, 1),
            "y": self.between(-1, 1),
            "heading": self.between(-3, 3),
            "speed": self.between(-1.5, 1.5),
            "turn_rate": self.between(-1.5, 1.5),
        }
        effects, trailers = {}, 0
        wells = (("kx", "ky"), ("crate", "wx", "wy"), ("hill", "hx", "hy", "width"), ("gx", "gy"), ())
        chosen = wells[random.integers(len(wells))]
        effects |= {key: self.between(0.3, 2) for key in chosen}
        if kind == "spin":
            start["turn_rate"] = self.sign() * self.decades(0.5, 2.4)
        if kind == "stiff":
            effects = {"kx": self.decades(2, 9), "ky": self.decades(2, 9)}
            reach = self.decades(-4, 0)
            start |= {key: start[key] * reach for key in ("x", "y")}
        if kind == "light":
            given |= {"J": self.decades(-12, -2), "a": given["a"] * random.integers(0, 2)}
        if kind == "train":
            trailers = int(random.integers(1, 4))
            given |= {
                "mt": self.between(0.1, 1),
                "Jt": self.decades(-2, -0.5),
                "at": self.between(0, 0.2),
                "hitch": self.between(0, 0.3),
                "bar": self.between(0.3, 0.8),
            }
        losses = (("drag", "turning"), ("square", "drag"), ("friction", "smooth", "turning"))
        if kind == "rest" or random.random() < 0.3:
            effects |= {key: self.between(0.1, 1.5) for key in losses[random.integers(3)]}
            if "smooth" in effects:
                effects["smooth"] = self.decades(-2, 0)
        if kind != "rest" and random.random() < 0.2:
            effects |= {"thrust": self.between(-1, 1), "fast": self.decades(-0.5, 1.5)}
        if kind in ("spin", "light") and random.random() < 0.15:
            effects["rate"] = self.sign() * self.decades(-1, 1.3)
        rotor = kind in ("spin", "rest") and random.random() < 0.3
        if rotor:
            given["Jr"] = self.between(0.1, 1)
        self.rescale(given, start, effects, (length, mass, time))
        return self.finished(given, start, effects, trailers, rotor, (length, time))

    def rescale(self, given, start, effects, units):
        """The same motion in units of length, mass and time of other sizes."""
        powers = {"m": (0, 1, 0), "J": (2, 1, 0), "a": (1, 0, 0), "Jr": (2, 1, 0), "bar": (1, 0, 0), "x": (1, 0, 0), "y": (1, 0, 0), "speed": (1, 0, -1), "turn_rate": (0, 0, -1),
                      "gx": (1, 0, -2), "gy": (1, 0, -2), "kx": (0, 1, -2), "ky": (0, 1, -2), "crate": (2, 1, -2), "wx": (-1, 0, 0), "wy": (-1, 0, 0), "hill": (2, 1, -2),
                      "hx": (1, 0, 0), "hy": (1, 0, 0), "width": (1, 0, 0), "drag": (0, 1, -1), "turning": (2, 1, -1), "square": (-1, 1, 0), "friction": (1, 1, -2),
                      "smooth": (1, 0, -1), "thrust": (1, 1, -2), "fast": (0, 0, -1), "rate": (0, 0, -1)}  # fmt: skip
        for numbers in (given, start, effects):
            for key in numbers:
                for unit, power in zip(units, powers.get(key, (0, 0, 0))):
                    numbers[key] *= unit**power

    def finished(self, given, start, effects, trailers, rotor, units):
        numbers, order = sleigh(trailers, rotor)
        values = {**EFFECTS, **given, **effects}
        # The width of a hill and the smoothing of a friction that are left out in units of that size.
        values |= {key: size for key, size in (("width", units[0]), ("smooth", units[0] / units[1])) if key not in effects}
        numbers = numbers.bound([values[key] for key in order])
        headings = [start["heading"]] * (trailers + 1)
        q = [start["x"], start["y"], *headings, *([0.0] * rotor)]
        v = np.zeros(len(q))
        turned, speed = start["turn_rate"], start["speed"]
        ahead, across = np.array([np.cos(q[2]), np.sin(q[2])]), np.array([-np.sin(q[2]), np.cos(q[2])])
        table = effects.get("rate", 0.0) * np.array([-q[1], q[0]])
        v[:2] = speed * ahead + (table @ across) * across
        v[2] = turned
        # The turn rate of a trailer follows from the blade before.
        z = np.concatenate([q, v])
        for k in range(1, trailers + 1):
            for _ in range(3):
                missed = numbers.values(z, 0.0)[5][k]
                moved = z.copy()
                moved[len(q) + 2 + k] += 1
                slope = numbers.values(moved, 0.0)[5][k] - missed
                z[len(q) + 2 + k] -= missed / slope
        shown = [("final", "x", 0), ("final", "y", 1), ("final", "heading", 2)]
        if trailers:
            shown.append(("last", "heading", 2 + trailers))
        losses = {"drag", "turning", "square", "friction", "thrust", "rate"}
        written = lambda step, duration: self.written(given, start, effects, trailers, step, duration)
        return Hard(self.seed, self.kind, numbers, z, written, shown, not losses & set(effects), "square" in effects)

    def written(self, given, start, effects, trailers, step, duration):
        lines = ["[sleigh]", f"mass = {given['m']!r}", f"inertia = {given['J']!r}", f"offset = {float(given['a'])!r}", "[start]"]
        lines += [f"{key} = {float(value)!r}" for key, value in start.items()]
        lines += ["[run]", f"step = {step!r}", f"duration = {duration!r}"]

        def effect(kind, **numbers):
            lines.extend(["[[effects]]", f'kind = "{kind}"', *(f"{key} = {value}" for key, value in numbers.items())])

        has = effects.get
        if "gx" in effects:
            effect("slope", gravity=[has("gx"), has("gy")])
        if "kx" in effects:
            effect("bowl", stiffness=[has("kx"), has("ky")])
        if "crate" in effects:
            effect("egg_crate", height=has("crate"), wave_number=[has("wx"), has("wy")])
        if "hill" in effects:
            effect("hills", hills=f"[{{ height = {has('hill')!r}, x = {has('hx')!r}, y = {has('hy')!r}, width = {has('width')!r} }}]")
        if "drag" in effects or "turning" in effects:
            effect("drag", **{name: has(key) for name, key in (("along", "drag"), ("turning", "turning")) if key in effects})
        if "square" in effects:
            effect("quadratic_drag", along=has("square"))
        if "friction" in effects:
            effect("friction", along=has("friction"), smoothing=has("smooth"))
        if "thrust" in effects:
            effect("thrust", force=f"{{ amplitude = {has('thrust')!r}, frequency = {has('fast')!r} }}")
        if "rate" in effects:
            effect("turntable", rate=has("rate"))
        if given["Jr"]:
            effect("flywheel", inertia=given["Jr"])
        if trailers:
            names = {"mass": "mt", "inertia": "Jt", "offset": "at", "hitch": "hitch", "bar": "bar"}
            heading = float(start["heading"])
            effect("trailers", count=trailers, headings=[heading] * trailers, **{name: float(given[key]) for name, key in names.items()})
        return "\n".join([*lines, ""])
