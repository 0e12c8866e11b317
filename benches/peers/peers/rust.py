"""The Rust crates: one program integrates and times, this side judges its ends."""

import json
import os
import subprocess
import tomllib
from pathlib import Path

from mpmath import mpf

from .measure import ROUNDS, SHORT, TOLERANCES, keep_smaller, largest

HERE = Path(__file__).resolve().parents[1] / "rust"
# Steps of the fixed-step methods (s).
STEPS = [0.4 / 2**k for k in range(14)]


def versions():
    """The locked version of every crate."""
    lock = tomllib.loads((HERE / "Cargo.lock").read_text())
    return {package["name"]: package["version"] for package in lock["package"]} | {"by hand": "1"}


def ends(problem, tolerances, steps, limit, budget, methods=None):
    """What the program answers; a missing program is an error with the reason."""
    program = os.environ.get("NOSLIP_PEERS_PROGRAM", "")
    if not os.access(program, os.X_OK):
        raise FileNotFoundError(f"the program of the Rust peers was not built ({program or 'no path'})")
    counts = sorted({max(1, round(problem.duration / h)) for h in steps})
    request = {"problem": problem.as_dict(), "tolerances": tolerances, "steps": counts, "limit": limit, "budget": budget,
               "methods": methods or []}
    done = subprocess.run([program], input=json.dumps(request), text=True, capture_output=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"the program of the Rust peers ended with {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def climb(problem, reference, limit, budget, tolerances=None, steps=None, methods=None):
    """Points and failures of all crates."""
    answer = ends(problem, tolerances or TOLERANCES, steps or STEPS, limit, budget, methods)
    # Short runs in further rounds, as those of the Python side.
    place = lambda point: (point["method"], point.get("tolerance", point.get("step")))
    rounds = ROUNDS if budget > 0.0 else 0
    for _ in range(rounds):
        other = ends(problem, tolerances or TOLERANCES, steps or STEPS, SHORT, budget, methods)
        found = {place(point): point for point in other["points"]}
        for point in answer["points"]:
            if other := found.get(place(point)):
                keep_smaller(point, other["wall_seconds"], other["cpu_seconds"])
                point["repeats"] += other["repeats"]
    version = versions()
    points = []
    for point in answer["points"]:
        end = point.pop("end")
        if None in end:  # JSON has no infinity
            answer["failures"].append({"method": point["method"], "message": "the end is not a finite number"})
            continue
        # The run contains what little there is to set up.
        found = {"error": largest(map(mpf, end), reference), "version": version[point["package"]], "setup_seconds": 0.0}
        points.append(point | found)
    return points, answer["failures"]
