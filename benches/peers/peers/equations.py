"""The equations of motion as text, made once for a problem and run on every kind of number.

Signs and acting points are those of docs/scenes.md: P = (x, y) the blade's contact point, C = P + a e the centre of mass,
e = (c, s) along the blade, n = (-s, c) across it. The constants of a scene enter as the doubles that they are.
"""

import cmath
import math


def loads(problem):
    """Lines that compute from x, y, c, s, u, w: F_e and F_n at C, F_b along the blade at P, T on the heading."""
    lines = ["X = x + a*c", "Y = y + a*s"]
    fx, fy, blade, torque = [], [], [], []
    for k, e in enumerate(problem.effects):
        kind = e["kind"]
        if kind == "slope":
            fx.append(f"m*K({e['gravity'][0]!r})")
            fy.append(f"m*K({e['gravity'][1]!r})")
        elif kind == "bowl":
            (kx, ky), (cx, cy) = e["stiffness"], e["center"]
            fx.append(f"(-K({kx!r}))*(X - K({cx!r}))")
            fy.append(f"(-K({ky!r}))*(Y - K({cy!r}))")
        elif kind == "blade_bowl":
            (kx, ky), (cx, cy) = e["stiffness"], e["center"]
            # Across the blade its constraint force takes it up; for full coordinates F_p is that part.
            blade.append(f"(-K({kx!r}))*(x - K({cx!r}))*c - K({ky!r})*(y - K({cy!r}))*s")
        elif kind == "egg_crate":
            (kx, ky), height = e["wave_number"], e["height"]
            fx.append(f"K({height!r})*K({kx!r})*sin(K({kx!r})*X)")
            fy.append(f"K({height!r})*K({ky!r})*sin(K({ky!r})*Y)")
        elif kind == "hill":
            lines.append(f"dx{k} = X - K({e['x']!r})")
            lines.append(f"dy{k} = Y - K({e['y']!r})")
            lines.append(f"s2{k} = K({e['width']!r})*K({e['width']!r})")
            lines.append(f"f{k} = K({e['height']!r})/s2{k}*exp((dx{k}*dx{k} + dy{k}*dy{k})/(-2.0*s2{k}))")
            fx.append(f"f{k}*dx{k}")
            fy.append(f"f{k}*dy{k}")
        elif kind == "drag":
            blade.append(f"(-K({e['along']!r}))*u")
            torque.append(f"(-K({e['turning']!r}))*w")
        elif kind == "thrust":
            blade.append(f"K({e['force']!r})")
    lines.append(f"FX = {' + '.join(fx) or '0.0'}")
    lines.append(f"FY = {' + '.join(fy) or '0.0'}")
    # Absent forces leave no term behind that symbolic packages would have to carry.
    lines.append(f"F_e = {'FX*c + FY*s' if fx else '0.0'}")
    lines.append(f"F_n = {'FY*c - FX*s' if fx else '0.0'}")
    lines.append(f"F_b = {' + '.join(blade) or '0.0'}")
    lines.append(f"T = {' + '.join(torque) or '0.0'}")
    along = " + ".join(term for term, there in (("a*w*w", True), ("(F_e + F_b)/m", fx or blade)) if there)
    across = " + ".join(term for term, there in (("a*F_n", fx), ("T", torque), ("(-(m*a))*u*w", True)) if there)
    return lines, along, across


def function(name, arguments, lines, result):
    """The text of a function."""
    body = "".join(f"    {line}\n" for line in lines)
    return f"def {name}({arguments}):\n{body}    return {result}\n"


def texts(problem):
    """The text of `reduced`, `full` and `residual`.

    reduced: slope of (x, y, heading, u, omega).
    full: slope of (x, y, heading, x', y', omega), the constraint differentiated and its multiplier eliminated.
    residual: the equations M(q) v' = k + A' L', A v = 0 in (x, y, heading, x', y', omega, L), of index 1 since the
    multiplier is the derivative L' of an unknown.
    """
    forces, along, across = loads(problem)
    trig = ["c = cos(th)", "s = sin(th)"]
    reduced = function("reduced", "x, y, th, u, w", trig + forces, f"(u*c, u*s, w, {along}, ({across})/J)")
    full = function(
        "full", "x, y, th, vx, vy, w",
        [*trig, "u = vx*c + vy*s", *forces, f"du = {along}", f"dw = ({across})/J"],
        "(vx, vy, w, du*c - u*w*s, du*s + u*w*c, dw)",
    )
    residual = function(
        "residual", "x, y, th, vx, vy, w, dx, dy, dth, dvx, dvy, dw, lam",
        [*trig, "u = vx*c + vy*s", *forces],
        "(dx - vx, dy - vy, dth - w,"
        " m*dvx - m*a*s*dw - m*a*c*w*w - FX - F_b*c + lam*s,"
        " m*dvy + m*a*c*dw - m*a*s*w*w - FY - F_b*s - lam*c,"
        " m*a*(c*dvy - s*dvx) + J*dw - a*F_n - T,"
        " c*vy - s*vx)",
    )
    return reduced + full + residual


def namespace(problem, constant=float, cos=math.cos, sin=math.sin, exp=math.exp):
    """The functions of `texts` on the numbers whose functions are given."""
    m, inertia, a = (constant(x) for x in (problem.mass, problem.inertia, problem.offset))
    # pylint: disable=exec-used
    found = {"m": m, "a": a, "J": inertia + m * a * a, "K": constant, "cos": cos, "sin": sin, "exp": exp}
    exec(compile(texts(problem), "equations", "exec"), found)  # the text is ours
    if round_well(problem):
        found["own axes"] = own_axes(problem, constant)
    return found


def on_complex(problem):
    """On Python's complex numbers: for derivatives by a complex step, exact to rounding."""
    return namespace(problem, float, cmath.cos, cmath.sin, cmath.exp)


def round_well(problem):
    """(k, b, centre) of one round well alone, that draws the point `b` ahead of the blade; of no effect one without force."""
    if not problem.effects:
        return (0.0, 0.0, problem.start[:2])
    if [e["kind"] for e in problem.effects] not in (["bowl"], ["blade_bowl"]):
        return None
    (well,) = problem.effects
    (kx, ky) = well["stiffness"]
    return (kx, problem.offset if well["kind"] == "bowl" else 0.0, well["center"]) if kx == ky else None


def own_axes(problem, constant=float):
    """The slope of (X, Y, heading, u, omega) in a round well, (X, Y) the blade in the axes of the sleigh from the centre, or free."""
    stiffness, ahead, _ = round_well(problem)
    # No rounding but that of the numbers that the other forms have too.
    m, inertia, a, k, b = (constant(x) for x in (problem.mass, problem.inertia, problem.offset, stiffness, ahead))
    j = inertia + m * a * a
    # What there is not leaves no term behind.
    def slope(x, y, th, u, w):
        along, turning = a * w * w, -(m * a / j) * u * w
        if stiffness:
            along = along - k / m * (x + b if ahead else x)
        if stiffness and ahead:
            turning = turning - k * b / j * y
        return (u + w * y, -w * x, w, along, turning)

    return slope


def into_own_axes(problem):
    """The start of (X, Y, heading, u, omega)."""
    x, y, th, u, w = problem.start
    cx, cy = round_well(problem)[2]
    c, s = math.cos(th), math.sin(th)
    return (c * (x - cx) + s * (y - cy), c * (y - cy) - s * (x - cx), th, u, w)


def from_own_axes(problem, x, y, th):
    """(x, y, heading) on the plane."""
    cx, cy = round_well(problem)[2]
    c, s = math.cos(th), math.sin(th)
    return (cx + c * x - s * y, cy + s * x + c * y, th)


def full_start(problem):
    """(x, y, heading, x', y', omega) at the start."""
    x, y, th, u, w = problem.start
    return (x, y, th, u * math.cos(th), u * math.sin(th), w)


def multiplier(problem):
    """The force across the blade at the start (N): m (u omega + a omega') - F_n. Forces at P have no such part."""
    x, y, th, u, w = problem.start
    dw = namespace(problem)["reduced"](*problem.start)[4]
    probe = namespace(problem)["residual"](*full_start(problem), *(0.0,) * 7)
    # F_n from the residual without accelerations: -(F . n) in its two rows.
    c, s = math.cos(th), math.sin(th)
    minus_fn = (probe[4] * c - probe[3] * s)
    return problem.mass * (u * w + problem.offset * dw) + minus_fn
