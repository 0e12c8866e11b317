"""noslip beside the peers, scene by scene: the same duration and measure of errors, in one run."""

import json
import math
import os
import subprocess
import tempfile
from pathlib import Path
from statistics import median

from . import measure, text

TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)
# Other people's integrators, which noslip has beside its own.
NOT_OURS = {"dop853", "rk4", "rk4-projected", "rk4-reduced", "implicit-midpoint"}
ROUNDS = 3


# What is raced where the system is compiled and nobody names a method; `dop853` is a peer on the same equations.
COMPILED = ("gauss-adaptive", "gauss16", "dla8", "dla")
PEER = "dop853"


def own(scene, duration, methods):
    """The points of noslip, by method, of a system as the program has it; no peer is among them."""
    command = [text.program(), "precision", scene, "--duration", repr(duration), "--json"]
    if methods:
        command += ["--methods", ",".join(methods)]
    return {name: points for name, points in measured(command).items() if name not in NOT_OURS}, {}


def compiled(bench, scene, duration, methods):
    """The points of noslip, by method, of the system that `system!` compiled into the bench, and those of DOP853 on the same equations."""
    ladders = measured([bench, "--points", scene, repr(duration), ",".join([*(methods or COMPILED), PEER])])
    peers = {f"differential-equations {PEER}": ladders.pop(PEER)} if PEER in ladders else {}
    return ladders, peers


def measured(command):
    """The points that a command prints, by method."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
    try:
        points = json.loads(done.stdout)["points"]
    except ValueError:
        raise RuntimeError(done.stderr.strip() or "no points") from None
    ladders = {}
    for point in points:
        # A run that failed has no error.
        if point["error"] is not None:
            ladders.setdefault(point["method"], []).append(point)
    return ladders


def build():
    """The bench whose systems `system!` compiles: `NOSLIP_COMPILED`, or one built here."""
    given = os.environ.get("NOSLIP_COMPILED")
    if given:
        return given
    command = ["cargo", "bench", "--quiet", "--package", "noslip", "--bench", "text", "--no-run", "--message-format", "json"]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, cwd=text.ROOT, check=True)
    told = [json.loads(line) for line in done.stdout.splitlines()]
    return next(found["executable"] for found in told if found.get("target", {}).get("name") == "text" and found.get("executable"))


def best(ladders):
    """The least time of any ladder to each target, with its name; None where none gets there."""
    found = []
    for target in TARGETS:
        times = [(measure.time_to(points, target), name) for name, points in ladders.items()]
        found.append(min((pair for pair in times if pair[0] is not None), default=None))
    return found


def row(name, problem, theirs, methods, bench=None):
    """The lines of the table for a scene. `theirs()` measures the peers once. `bench` has the system compiled by `system!`."""
    # A command that runs in a folder of its own finds a file by its whole path only.
    scene = str(Path(name).resolve()) if Path(name).is_file() else name
    pairs = []
    for _ in range(ROUNDS):
        ladders, beside = compiled(bench, scene, problem.duration, methods) if bench else own(scene, problem.duration, methods)
        ours = best(ladders)
        pairs.append((ours, best({**theirs(), **beside})))
        # The methods that came nearest to the front in the first round are enough for the others.
        methods = sorted({pair[1] for pair in ours if pair}) or methods
    lines = []
    for k, target in enumerate(TARGETS):
        one = [ours[k] for ours, _ in pairs if ours[k]]
        other = [peers[k] for _, peers in pairs if peers[k]]
        if not one or not other:
            cell = lambda found: f"{found[0][1]} {1e6 * median(t for t, _ in found):.3g} us" if found else "-"
            lines.append(f"| {name} | {target:g} | {cell(one)} | {cell(other)} | - |")
            continue
        ratios = [theirs_[k][0] / ours[k][0] for ours, theirs_ in pairs if ours[k] and theirs_[k]]
        spread = math.exp(max(ratios and [abs(math.log(r / median(ratios))) for r in ratios], default=0.0))
        lines.append(
            f"| {name} | {target:g} | {one[0][1]} {1e6 * median(t for t, _ in one):.3g} us |"
            f" {other[0][1]} {1e6 * median(t for t, _ in other):.3g} us | {median(ratios):.2f} (x/{spread:.2f}) |"
        )
    return lines


HEAD = ["| scene | error | noslip | best peer | peer over noslip |", "|---|---|---|---|---|"]
