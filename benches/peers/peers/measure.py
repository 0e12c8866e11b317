"""Ladders of tolerances or steps: one run after the other, each repeated and timed alone."""

import math
import time
from dataclasses import dataclass
from statistics import median
from typing import Callable

from mpmath import mpf

TOLERANCES = [10.0**-k for k in range(3, 15)]


@dataclass
class Line:
    """One method of one package in one form.

    `prepare(value)` sets up for a tolerance or a step and returns a run, which gives (x, y, heading) and a number of steps.
    """

    method: str
    package: str
    form: str
    prepare: Callable
    rungs: list
    rung: str = "tolerance"
    # Trajectories that a run crosses at once: the time is that of one.
    lanes: int = 1


def largest(end, reference):
    """The largest distance of position (m) and heading (rad). The reference may have more digits than a double."""
    dx, dy, turn = (float(p - q) for p, q in zip(end, reference))
    return max(math.hypot(dx, dy), abs(turn))


# The clock of the processor is a system call: short runs are timed in groups that take this long (s).
GROUP = 2e-4
# Runs longer than this (s) are timed once.
LONG = 1.0


def timed(run, first, budget):
    """Medians of the wall and CPU time of a run (s), which took `first` (s) before, and of how many that is."""
    size = max(1, math.ceil(GROUP / max(first, 1e-9)))
    groups = min(max(int(budget / max(first * size, 1e-9)), 3), 1001) | 1
    wall, cpu = [], []
    for _ in range(groups):
        begin, begin_cpu = time.perf_counter(), time.process_time()
        for _ in range(size):
            run()
        cpu.append((time.process_time() - begin_cpu) / size)
        wall.append((time.perf_counter() - begin) / size)
    return median(wall), median(cpu), groups * size


# Runs shorter than this (s) are timed in further rounds, when the others have had their turn.
SHORT = 0.02
ROUNDS = 2


def keep_smaller(point, wall, cpu):
    """The smaller of two medians: for seconds at a time a shared machine's clock is half as fast again or slower."""
    point["wall_seconds"], point["cpu_seconds"] = min(point["wall_seconds"], wall), min(point["cpu_seconds"], cpu)


def again(kept, budget):
    """Times the short runs that `climb` kept once more."""
    for point, run, lanes in kept:
        first = point["wall_seconds"] * lanes
        wall, cpu, repeats = timed(run, first, budget)
        keep_smaller(point, wall / lanes, cpu / lanes)
        point["repeats"] += repeats


def climb(line, version, reference, limit, budget, kept=None, size=largest):
    """The points and failures of a line. It ends with the first run that takes longer than `limit` (s).

    Short runs are put into `kept`, for `again`.
    """
    points, failures = [], []
    kept = [] if kept is None else kept
    try:
        # What a package or a compiler does once only, it does here.
        line.prepare(line.rungs[0])()
    except Exception:  # it fails again below, and is reported there
        pass
    for value in line.rungs:
        begin = time.perf_counter()
        try:
            run = line.prepare(value)
            setup = time.perf_counter() - begin
            end, steps = run()
            end = [float(v) for v in end]
            if not all(map(math.isfinite, end)):
                raise ArithmeticError("the end is not a finite number")
            begin, begin_cpu = time.perf_counter(), time.process_time()
            run()
            wall, cpu, repeats = time.perf_counter() - begin, time.process_time() - begin_cpu, 1
            # A run that takes longer is not repeated for a digit more.
            if wall < LONG:
                wall, cpu, repeats = timed(run, wall, budget)
        except Exception as error:  # what a package fails with is its result
            message = f"{type(error).__name__}: {error}"[:300]
            failures.append({"method": line.method, line.rung: value, "message": message})
            continue
        points.append({
            "method": line.method, line.rung: value, "steps": int(steps), "error": size(list(map(mpf, end)), reference),
            "wall_seconds": wall / line.lanes, "cpu_seconds": cpu / line.lanes, "package": line.package, "version": version,
            "form": line.form, "setup_seconds": setup, "repeats": repeats,
        })
        if wall < SHORT:
            kept.append((points[-1], run, line.lanes))
        if wall > limit:
            failures.append({"method": line.method, line.rung: value, "message": f"stopped here: over {limit} s a run"})
            break
    return points, failures


def time_to(points, target):
    """CPU seconds to an error, on the log-log ladder in its order; `None` where it is never reached."""
    best = None
    for before, point in zip([None, *points], points):
        if point["error"] > target:
            continue
        seconds = point["cpu_seconds"]
        if before and before["error"] > target and point["error"] > 0.0:
            share = math.log(before["error"] / target) / math.log(before["error"] / point["error"])
            seconds = before["cpu_seconds"] ** (1.0 - share) * seconds**share
        best = seconds if best is None else min(best, seconds)
    return best
