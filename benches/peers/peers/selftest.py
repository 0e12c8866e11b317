"""Does everyone integrate the same sleigh? Loosely: a wrong sign or acting point shows in the first digit."""

import sys
from dataclasses import replace

from . import measure, rust, scene
from .reference import closed_form, general, reference

# What the peers reach on these short runs with tolerance 1e-8 or 6 ms steps is below this; a wrong term is far above.
LOOSE = 1e-3
TOLERANCE = 1e-8
STEP = 0.2 / 2**5

FREE = scene.Problem("free", 1.0, 1.0, 0.5, (0.0, 0.0, 0.0, -1.0, 0.1), 20.0)
BEHIND = scene.Problem("centre of mass behind", 1.3, 0.8, -0.4, (0.3, -0.2, 0.5, 0.6, 1.1), 10.0)
EVERYTHING = scene.Problem(
    "every effect", 1.3, 0.8, 0.4, (0.3, -0.2, 0.5, -0.6, 1.1), 5.0,
    (
        {"kind": "slope", "gravity": (0.1, -0.2)},
        {"kind": "bowl", "stiffness": (0.3, 0.2), "center": (0.1, 0.4)},
        {"kind": "blade_bowl", "stiffness": (0.2, 0.1), "center": (-0.3, 0.2)},
        {"kind": "egg_crate", "height": 0.2, "wave_number": (1.0, 1.5)},
        {"kind": "hill", "height": 0.5, "x": 0.5, "y": 0.1, "width": 0.7},
        {"kind": "drag", "along": 0.1, "turning": 0.2},
        {"kind": "thrust", "force": 0.3},
    ),
)

ROUND = scene.Problem(
    "round well", 1.3, 0.8, 0.4, (0.3, -0.2, 0.5, -0.6, 1.1), 5.0,
    ({"kind": "bowl", "stiffness": (0.3, 0.3), "center": (0.1, 0.4)},),
)

# Ends from elsewhere, to 15 digits: the blade's from those of the centre of mass, (X, Y, heading) at 10 s, m = I = 1, a = 1/2.
PUBLISHED = [
    ((), (0.0, 0.0, 0.0, 1.0, 0.3), (8.630050962159051, 5.777081619895769, 0.7128922085503294)),
    (({"kind": "bowl", "stiffness": (1.0, 1.0), "center": (0.0, 0.0)},), (0.5, 0.0, 0.3, 0.4, 0.7),
     (-0.6032875134127324, 0.7304442206425285, 6.937651159895837)),
    (({"kind": "egg_crate", "height": 0.5, "wave_number": (1.0, 1.0)},), (0.5, 1.0, 0.3, 0.4, 0.7),
     (6.116263299104192, 12.39178403258227, 1.011883547635337)),
]


def at_center(point, offset, sign):
    from math import cos, sin

    return (point[0] + sign * offset * cos(point[2]), point[1] + sign * offset * sin(point[2]), point[2])


def peers(problem, exact, load):
    """(method, error or message) of every peer at one tolerance or step."""
    modules, absent = load()
    for entry in absent:
        yield entry["package"], entry["message"]
    for module in modules:
        for line in module.lines(problem):
            rung = TOLERANCE if line.rung == "tolerance" else STEP
            points, failures = measure.climb(replace(line, rungs=[rung]), "", exact.end, 60.0, 0.0)
            yield line.method, points[0]["error"] if points else failures[0]["message"]
    try:
        points, failures = rust.climb(problem, exact.end, 60.0, 0.0, [TOLERANCE], [STEP])
    except (OSError, RuntimeError) as error:
        yield "the Rust crates", str(error)
        return
    for entry in points:
        yield entry["method"], entry["error"]
    for entry in failures:
        yield entry["method"], entry["message"]


def main(load):
    bad = 0

    def check(fine, text):
        nonlocal bad
        bad += not fine
        print(f"{'ok  ' if fine else 'BAD '} {text}")

    # The references against each other and against ends from elsewhere.
    for problem in (FREE, BEHIND):
        form, other = closed_form(problem), general(problem)
        apart = measure.largest(form.end, other.end)
        check(apart <= form.error + 10 * other.error, f"closed form and extrapolation, {problem.name}: {apart:.1e} apart")
    for effects, start, end in PUBLISHED:
        blade = (*at_center(start, 0.5, -1), *start[3:])
        exact = reference(scene.Problem("published", 1.0, 1.0, 0.5, blade, 10.0, effects))
        error = measure.largest(end, at_center(tuple(map(float, exact.end)), 0.5, 1))
        # Fifteen printed digits, and the start at the blade rounded once more.
        check(error < 1e-13, f"published end under {len(effects)} effects: {error:.1e}")

    # The peers, and the positive control: another sleigh would be found out.
    for problem in (FREE, BEHIND, EVERYTHING, ROUND):
        exact = reference(problem)
        for changed in (replace(problem, offset=-problem.offset), replace(problem, inertia=1.1 * problem.inertia)):
            apart = measure.largest(reference(changed).end, exact.end)
            check(apart > 10 * LOOSE, f"{problem.name}: another sleigh ends {apart:.1e} away")
        for k in range(len(problem.effects)):
            less = problem.effects[:k] + problem.effects[k + 1:]
            apart = measure.largest(reference(replace(problem, effects=less)).end, exact.end)
            check(apart > 10 * LOOSE, f"{problem.name}: without {problem.effects[k]['kind']} {apart:.1e} away")
        for method, error in peers(problem, exact, load):
            fine = isinstance(error, float) and error < LOOSE
            check(fine, f"{problem.name}: {method}: {error if isinstance(error, str) else f'{error:.1e}'}")

    # What cannot be followed is refused.
    for name in ("flywheel", "parking", "turntable", "no-such-scene"):
        try:
            scene.read(name)
            check(False, f"{name} is refused")
        except scene.Refused as refused:
            check(True, f"{name} is refused: {refused}")
    ladder = [{"error": 1e-2, "cpu_seconds": 1.0}, {"error": 1e-4, "cpu_seconds": 4.0}]
    check(abs(measure.time_to(ladder, 1e-3) - 2.0) < 1e-12 and measure.time_to(ladder, 1e-6) is None, "interpolation")
    print(f"{bad} bad" if bad else "all fine", file=sys.stderr)
    return 1 if bad else 0
