"""Reference motions of the sleigh under each effect alone, and under ten random combinations.

Regenerate, from this directory:

    pip install numpy
    python3 effects.py > effects.txt

Each block is a scene in TOML and, after `end`, its state at t = 10: x y heading speed turn_rate rotor rotor_rate.

The formulation shares nothing with the one under test: Lagrange-d'Alembert in full coordinates (X, Y, theta, psi), with
(X, Y) the centre of mass, a mass matrix by hand, and the constraints differentiated in time. With x86's extended precision
(a significand of 64 bits) and extrapolation (Gragg, Bulirsch, Stoer; order 16) it is good to about 1e-16. `main` checks each motion
with two step lengths and refuses one that does not repeat to 1e-14.
"""

import random
import sys

import numpy as np

F = np.longdouble
T = F(10)
# The formula that these scenes have.
FORMULA = "0.4*t*exp(-t)"
TAU = F("6.283185307179586476925286766559")
assert np.finfo(F).eps < 2e-19, "this needs extended precision"


# Functions of time: value, slope, second slope, on the piece that holds in the middle of [t0, t1].

def function(spec, middle):
    if isinstance(spec, float):
        return lambda t: (F(spec), F(0), F(0))
    if spec == FORMULA:
        return lambda t: (F("0.4") * t * np.exp(-t), F("0.4") * (1 - t) * np.exp(-t), F("0.4") * (t - 2) * np.exp(-t))
    if "amplitude" in spec:
        a, w, p = (F(spec[k]) for k in ("amplitude", "frequency", "phase"))
        return lambda t: (a * np.sin(w * t + p), a * w * np.cos(w * t + p), -a * w * w * np.sin(w * t + p))
    if "interpolation" in spec:
        times, values = ([F(x) for x in spec[k]] for k in ("times", "values"))
        if middle < times[0] or middle >= times[-1]:
            value = values[0] if middle < times[0] else values[-1]
            return lambda t: (value, F(0), F(0))
        i = max(k for k, time in enumerate(times) if time <= middle)
        slope = (values[i + 1] - values[i]) / (times[i + 1] - times[i])
        return lambda t: (values[i] + slope * (t - times[i]), slope, F(0))
    value = spec["values"][0]
    for time, new in zip(spec["times"], spec["values"]):
        if time <= middle:
            value = new
    return lambda t: (F(value), F(0), F(0))


def corners(polygon, period):
    """When each edge begins and ends in the first round."""
    ends = polygon[1:] + polygon[:1]
    lengths = [np.hypot(F(b[0]) - F(a[0]), F(b[1]) - F(a[1])) for a, b in zip(polygon, ends)]
    total = sum(lengths)
    times = [F(0)]
    for length in lengths:
        times.append(times[-1] + length / total * F(period))
    return times


def path(spec, middle):
    """Velocity and acceleration of the tracer."""
    period = F(spec["period"])
    if "circle" in spec:
        r, w = F(spec["circle"]["radius"]), TAU / period
        return lambda t: ((-r * w * np.sin(w * t), r * w * np.cos(w * t)),
                          (-r * w * w * np.cos(w * t), -r * w * w * np.sin(w * t)))
    polygon = spec["polygon"]
    times = corners(polygon, period)
    within = F(middle) % period
    k = max(i for i in range(len(polygon)) if times[i] <= within)
    a, b = polygon[k], polygon[(k + 1) % len(polygon)]
    v = tuple((F(b[i]) - F(a[i])) / (times[k + 1] - times[k]) for i in range(2))
    return lambda t: (v, (F(0), F(0)))


def jumps(scene):
    found = set()

    def of_function(spec):
        if isinstance(spec, dict) and "times" in spec:
            found.update(F(t) for t in spec["times"][0 if "interpolation" in spec else 1:])

    for effect in scene["effects"]:
        for key, value in effect.items():
            if key == "path":
                if "polygon" in value:
                    times = corners(value["polygon"], value["period"])
                    found.update(F(value["period"]) * n + t for n in range(11) for t in times[1:])
            elif key not in ("times", "values"):
                of_function(value)
    return sorted(t for t in found if 0 < t < T)


# The equations of motion.

def gradient_of_potential(effect, m, X, Y):
    kind = effect["kind"]
    if kind == "slope":
        return -m * F(effect["gravity"][0]), -m * F(effect["gravity"][1])
    if kind == "bowl":
        return tuple(F(effect["stiffness"][i]) * (c - F(effect["center"][i])) for i, c in enumerate((X, Y)))
    if kind == "egg_crate":
        return tuple(-F(effect["height"]) * F(k) * np.sin(F(k) * c) for k, c in zip(effect["wave_number"], (X, Y)))
    if kind == "hills":
        gx = gy = F(0)
        for hill in effect["hills"]:
            dx, dy, s = X - F(hill["x"]), Y - F(hill["y"]), F(hill["width"])
            g = -F(hill["height"]) * np.exp(-(dx * dx + dy * dy) / (2 * s * s)) / (s * s)
            gx, gy = gx + g * dx, gy + g * dy
        return gx, gy
    return F(0), F(0)


class Piece:
    """The scene between two jumps. State: X Y theta psi and their rates."""

    def __init__(self, scene, t0, t1):
        self.m, self.inertia, self.a = (F(scene["sleigh"][k]) for k in ("mass", "inertia", "offset"))
        self.scene = scene
        middle = (t0 + t1) / 2
        self.rotor = next((e for e in scene["effects"] if e["kind"] == "flywheel"), None)
        self.n = 4 if self.rotor else 3
        self.functions = []
        for e in scene["effects"]:
            keys = {"thrust": ["force"], "torque": ["torque"], "moving_mass": ["x", "y"], "servo": ["speed", "turn_rate"],
                    "flywheel": ["torque"]}.get(e["kind"], [])
            row = {k: function(e[k], middle) for k in keys if k in e}
            if e["kind"] == "tracer":
                row["path"] = path(e["path"], middle)
            self.functions.append(row)

    def mass(self, t, z):
        M = np.zeros((self.n, self.n), dtype=F)
        M[0, 0] = M[1, 1] = self.m
        M[2, 2] = self.inertia
        if self.rotor:
            ir = F(self.rotor["inertia"])
            M[2:, 2:] += ir
        for e, row in zip(self.scene["effects"], self.functions):
            if e["kind"] == "moving_mass":
                J, _, _ = self.moving(row, t, z)
                M[:3, :3] += F(e["mass"]) * J.T @ J
        return M

    def moving(self, row, t, z):
        """Jacobian of the mass's position in (X, Y, theta), its acceleration with q'' = 0, and its drift velocity."""
        s, c = np.sin(z[2]), np.cos(z[2])
        (rx, dx, ddx), (ry, dy, ddy) = row["x"](t), row["y"](t)
        R = np.array([[c, -s], [s, c]], dtype=F)
        R1 = np.array([[-s, -c], [c, -s]], dtype=F)
        rho, d, dd = (np.array(p, dtype=F) for p in ((rx - self.a, ry), (dx, dy), (ddx, ddy)))
        J = np.zeros((2, 3), dtype=F)
        J[0, 0] = J[1, 1] = F(1)
        J[:, 2] = R1 @ rho
        w = z[self.n + 2]
        return J, -(R @ rho) * w * w + 2 * w * (R1 @ d) + R @ dd, R @ d

    def forces(self, t, z):
        n, a = self.n, self.a
        X, Y, th, w = z[0], z[1], z[2], z[n + 2]
        s, c = np.sin(th), np.cos(th)
        # The blade's velocity, and the Jacobian of its position.
        vx, vy = z[n] + a * s * w, z[n + 1] - a * c * w
        u = c * vx + s * vy
        Q = np.zeros(n, dtype=F)

        def at_blade(fx, fy):
            Q[0] += fx
            Q[1] += fy
            Q[2] += a * (s * fx - c * fy)

        for e, row in zip(self.scene["effects"], self.functions):
            gx, gy = gradient_of_potential(e, self.m, X, Y)
            Q[0] -= gx
            Q[1] -= gy
            kind = e["kind"]
            if kind == "drag":
                f = -F(e["along"]) * u
                at_blade(f * c, f * s)
                Q[2] -= F(e["turning"]) * w
            elif kind == "quadratic_drag":
                f = -F(e["along"]) * u * abs(u)
                at_blade(f * c, f * s)
                Q[2] -= F(e["turning"]) * w * abs(w)
            elif kind == "friction":
                f = -F(e["along"]) * np.tanh(u / F(e["smoothing"]))
                at_blade(f * c, f * s)
                Q[2] -= F(e["turning"]) * np.tanh(w / F(e["turning_smoothing"]))
            elif kind == "thrust":
                f = row["force"](t)[0]
                at_blade(f * c, f * s)
            elif kind == "torque":
                Q[2] += row["torque"](t)[0]
            elif kind == "flywheel" and "torque" in row:
                Q[3] += row["torque"](t)[0]
            elif kind == "moving_mass":
                J, bias, _ = self.moving(row, t, z)
                Q[:3] -= F(e["mass"]) * J.T @ bias
        return Q

    def constraints(self, t, z):
        """Rows A of A q' + b = 0, b, and the time derivative of A q' + b with q'' = 0."""
        n, a = self.n, self.a
        X, Y, th, vX, vY, w = z[0], z[1], z[2], z[n], z[n + 1], z[n + 2]
        s, c = np.sin(th), np.cos(th)
        rate = sum((F(e["rate"]) for e in self.scene["effects"] if e["kind"] == "turntable"), F(0))
        rows, b, bias = [[-s, c, -a]], [], []
        # n . C' - a theta' = rate (n . (-y, x)); with x = X - a c, y = Y - a s: n . (-y, x) = X c + Y s - a.
        b.append(-rate * (X * c + Y * s - a))
        bias.append(-(c * vX + s * vY) * w - rate * (vX * c + vY * s + w * (Y * c - X * s)))
        for e, row in zip(self.scene["effects"], self.functions):
            if e["kind"] == "servo":
                if "speed" in row:
                    u, du, _ = row["speed"](t)
                    rows.append([c, s, F(0)])
                    b.append(-u)
                    bias.append((-s * vX + c * vY) * w - du)
                if "turn_rate" in row:
                    omega, domega, _ = row["turn_rate"](t)
                    rows.append([F(0), F(0), F(1)])
                    b.append(-omega)
                    bias.append(-domega)
            elif e["kind"] == "tracer":
                v, acc = row["path"](t)
                for i in range(2):
                    rows.append([F(1) if j == i else F(0) for j in range(3)])
                    b.append(-v[i])
                    bias.append(-acc[i])
        A = np.zeros((len(rows), n), dtype=F)
        A[:, :3] = rows
        return A, np.array(b, dtype=F), np.array(bias, dtype=F)

    def slope(self, t, z):
        n = self.n
        A, _, bias = self.constraints(t, z)
        return np.concatenate([z[n:], saddle(self.mass(t, z), A, self.forces(t, z), -bias)])

    def onto_constraint(self, t, z, first):
        """The velocity after the impulse of the constraints; at the start, the admissible one that was asked for."""
        n = self.n
        A, b, _ = self.constraints(t, z)
        M = self.mass(t, z)
        if first:
            # The nearest (x', y', theta', psi') at the blade.
            B = np.eye(n, dtype=F)
            B[0, 2], B[1, 2] = self.a * np.sin(z[2]), -self.a * np.cos(z[2])
            M = B.T @ B
        z = z.copy()
        z[n:] = saddle(M, A, M @ z[n:], -b)
        return z


def saddle(M, A, right, level):
    """x with M x = right + A' lambda, A x = level."""
    n, k = len(M), len(A)
    K = np.zeros((n + k, n + k + 1), dtype=F)
    K[:n, :n], K[:n, n:n + k], K[n:, :n] = M, A.T, A
    K[:n, -1], K[n:, -1] = right, level
    for i in range(n + k):
        p = i + int(np.argmax(np.abs(K[i:, i])))
        K[[i, p]] = K[[p, i]]
        K[i] = K[i] / K[i, i]
        for j in range(n + k):
            if j != i and K[j, i] != 0:
                K[j] -= K[j, i] * K[i]
    return K[:n, -1]


# Extrapolation of the modified midpoint rule.

COLUMNS = [2, 4, 6, 8, 10, 12, 14, 16]


def extrapolated(f, t, z, h):
    table = []
    for k, n in enumerate(COLUMNS):
        sub = h / n
        before, now = z, z + sub * f(t, z)
        for i in range(1, n):
            before, now = now, before + 2 * sub * f(t + i * sub, now)
        row = [(before + now + sub * f(t + h, now)) / 2]
        for j in range(1, k + 1):
            ratio = (F(n) / COLUMNS[k - j]) ** 2
            row.append(row[j - 1] + (row[j - 1] - table[k - 1][j - 1]) / (ratio - 1))
        table.append(row)
    return table[-1][-1]


def motion(scene, h):
    a = F(scene["sleigh"]["offset"])
    start = {k: F(v) for k, v in scene["start"].items()}
    th, u, w = start["heading"], start["speed"], start["turn_rate"]
    s, c = np.sin(th), np.cos(th)
    q = [start["x"] + a * c, start["y"] + a * s, th]
    v = [u * c - a * w * s, u * s + a * w * c, w]
    rotor = next((e for e in scene["effects"] if e["kind"] == "flywheel"), None)
    if rotor:
        q, v = q + [F(0)], v + [F(rotor["rotor_rate"])]
    z, first = np.array(q + v, dtype=F), True
    times = [F(0)] + jumps(scene) + [T]
    for t0, t1 in zip(times, times[1:]):
        piece = Piece(scene, t0, t1)
        z = piece.onto_constraint(t0, z, first)
        first = False
        steps = max(1, int(np.ceil((t1 - t0) / h - F(1e-9))))
        for k in range(steps):
            z = extrapolated(piece.slope, t0 + k * (t1 - t0) / steps, z, (t1 - t0) / steps)
    n = piece.n
    th, w = z[2], z[n + 2]
    s, c = np.sin(th), np.cos(th)
    vx, vy = z[n] + a * s * w, z[n + 1] - a * c * w
    rotor = [z[3], z[7]] if n == 4 else [F(0), F(0)]
    return np.array([z[0] - a * c, z[1] - a * s, th, c * vx + s * vy, w] + rotor, dtype=F)


# The scenes.

SLEIGH = {"mass": 1.3, "inertia": 0.8, "offset": 0.4}
START = {"x": 0.3, "y": -0.2, "heading": 0.5, "speed": -0.6, "turn_rate": 1.1}


def sine(amplitude, frequency, phase):
    return {"amplitude": amplitude, "frequency": frequency, "phase": phase}


def table(times, values):
    return {"times": times, "values": values}


ALONE = {
    "slope": [{"gravity": [0.3, -0.2]}],
    "bowl": [{"stiffness": [0.4, 0.15], "center": [0.2, -0.3]}],
    "egg_crate": [{"height": 0.3, "wave_number": [1.0, 1.4]}],
    "hills": [{"hills": [{"height": 0.5, "x": 1.0, "y": 0.4, "width": 0.8},
                         {"height": -0.7, "x": -0.6, "y": -0.9, "width": 1.2}]}],
    "drag": [{"along": 0.2, "turning": 0.1}],
    "thrust": [{"force": -0.5}, {"force": sine(0.6, 1.3, 0.4)}, {"force": table([0.0, 2.5, 6.0], [0.5, -0.7, 0.2])}],
    "torque": [{"torque": 0.2}, {"torque": table([1.0, 4.0], [0.3, -0.3])}],
    "moving_mass": [{"mass": 0.4, "x": sine(0.3, 2.0, 0.0), "y": 0.2}, {"mass": 0.3, "x": 0.5, "y": sine(0.4, 1.7, 1.0)}],
    "flywheel": [{"inertia": 0.2, "rotor_rate": 3.0}, {"inertia": 0.2, "rotor_rate": -1.0, "torque": sine(0.3, 1.5, 0.2)}],
    "servo": [{"speed": sine(0.8, 1.1, 0.5)}, {"turn_rate": sine(0.9, 0.7, 1.2)},
              {"speed": 0.7, "turn_rate": table([0.0, 3.0, 7.5], [0.5, -0.8, 0.3])}],
    "tracer": [{"path": {"circle": {"radius": 0.7, "center": [0.1, 0.2]}, "period": 6.0}},
               {"path": {"polygon": [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], "period": 6.0}}],
    "turntable": [{"rate": 0.35}],
}

# From a start that only goes forward, where the square of the speed is smooth.
FORWARD = dict(START, speed=0.8)


def ramps(times, values):
    return {"times": times, "values": values, "interpolation": "linear"}


LATER = [
    ("quadratic_drag 1", FORWARD, {"along": 0.2, "turning": 0.1}),
    ("friction 1", START, {"along": 0.3, "smoothing": 0.4, "turning": 0.05, "turning_smoothing": 0.5}),
    ("thrust 4", START, {"force": ramps([1.0, 2.5, 6.0], [0.5, -0.7, 0.2])}),
    ("thrust 5", START, {"force": FORMULA}),
    ("moving_mass 3", START, {"mass": 0.4, "x": FORMULA, "y": 0.2}),
    ("servo 4", START, {"speed": ramps([0.0, 5.0], [0.0, 1.0]), "turn_rate": ramps([3.0, 4.0, 7.5], [0.5, -0.8, 0.3])}),
]


def random_scene(rng):
    def u(low, high):
        return round(rng.uniform(low, high), 3)

    def times(count):
        return sorted(0.05 * k for k in rng.sample(range(10, 190), count))

    def of_time(size, jumping=True):
        which = rng.randrange(3 if jumping else 2)
        if which == 0:
            return u(-size, size)
        if which == 1:
            return sine(u(0.3 * size, size), u(0.5, 2.0), u(-3.0, 3.0))
        return table([round(t, 2) for t in [0.0] + times(2)], [u(-size, size) for _ in range(3)])

    makers = {
        "slope": lambda: {"gravity": [u(-0.4, 0.4), u(-0.4, 0.4)]},
        "bowl": lambda: {"stiffness": [u(0.1, 0.5), u(0.1, 0.5)], "center": [u(-1.0, 1.0), u(-1.0, 1.0)]},
        "egg_crate": lambda: {"height": u(-0.3, 0.3), "wave_number": [u(0.5, 1.5), u(0.5, 1.5)]},
        "hills": lambda: {"hills": [{"height": u(-0.6, 0.6), "x": u(-2.0, 2.0), "y": u(-2.0, 2.0), "width": u(0.6, 1.5)}
                                    for _ in range(rng.randrange(1, 4))]},
        "drag": lambda: {"along": u(0.0, 0.3), "turning": u(0.0, 0.3)},
        "thrust": lambda: {"force": of_time(0.6)},
        "torque": lambda: {"torque": of_time(0.4)},
        "moving_mass": lambda: {"mass": u(0.1, 0.5), "x": of_time(0.5, False), "y": of_time(0.5, False)},
    }
    effects = [dict(kind=k, **makers[k]()) for k in rng.sample(sorted(makers), rng.randrange(2, 6))]
    return effects, of_time, u


def scenes():
    for kind, variants in ALONE.items():
        for k, keys in enumerate(variants):
            yield f"{kind} {k + 1}", {"sleigh": SLEIGH, "start": START, "effects": [dict(kind=kind, **keys)]}
    rng = random.Random(20240229)
    bodies = ["plain", "flywheel", "turntable", "speed", "turn_rate", "both", "tracer", "flywheel turntable",
              "flywheel speed turntable", "flywheel tracer"]
    for k, body in enumerate(bodies):
        effects, of_time, u = random_scene(rng)
        if "flywheel" in body:
            effects.insert(0, {"kind": "flywheel", "inertia": u(0.1, 0.4), "rotor_rate": u(-3.0, 3.0), "torque": of_time(0.3)})
        if "turntable" in body:
            effects.append({"kind": "turntable", "rate": u(-0.4, 0.4)})
        if "speed" in body:
            effects.append({"kind": "servo", "speed": of_time(0.8)})
        elif "turn_rate" in body:
            effects.append({"kind": "servo", "turn_rate": of_time(0.8)})
        elif "both" in body:
            effects.append({"kind": "servo", "speed": of_time(0.8), "turn_rate": of_time(0.8)})
        elif "tracer" in body:
            circle = {"circle": {"radius": u(0.3, 1.2), "center": [u(-1.0, 1.0), u(-1.0, 1.0)]}, "period": u(4.0, 9.0)}
            effects.append({"kind": "tracer", "path": circle})
        sleigh = {"mass": u(0.5, 2.0), "inertia": u(0.4, 1.5), "offset": rng.choice([-1, 1]) * u(0.2, 0.8)}
        start = {"x": u(-1.0, 1.0), "y": u(-1.0, 1.0), "heading": u(-3.0, 3.0), "speed": u(-1.0, 1.0),
                 "turn_rate": u(-1.2, 1.2)}
        yield f"random {k + 1} {body}", {"sleigh": sleigh, "start": start, "effects": effects}


def later():
    for name, start, keys in LATER:
        yield name, {"sleigh": SLEIGH, "start": start, "effects": [dict(kind=name.split()[0], **keys)]}


def toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def main():
    print("# Written by effects.py, do not edit.")
    for name, scene in [*scenes(), *later()]:
        rough, fine = motion(scene, F("0.125")), motion(scene, F("0.1"))
        error = np.max(np.abs(fine - rough))
        print(f"{name}: {float(error):.1e}", file=sys.stderr)
        assert error < 1e-14, name
        print(f'scene\ntitle = "{name}"')
        for part in ("sleigh", "start"):
            print(f"[{part}]")
            for key, value in scene[part].items():
                print(f"{key} = {toml(value)}")
        print('[run]\nmethod = "dla8"\nstep = 0.05\nduration = 10.0')
        for effect in scene["effects"]:
            print("[[effects]]")
            for key, value in effect.items():
                print(f"{key} = {toml(value)}")
        print("end", *(np.format_float_scientific(x, unique=False, precision=18, trim="-") for x in fine))


main()
