"""`python -m peers SCENE... --out FILE`: every peer on a scene, accuracy against time."""

import argparse
import importlib
import json
import os
import platform
import sys
import time
import warnings
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from . import measure, race, rust, scene, selftest, sleigh_text, text
from .reference import reference

MODULES = ("heyoka_lines", "scipy_lines", "sundials_lines", "solve_dae_lines", "exudyn_lines")
TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)


def say(text):
    print(text, file=sys.stderr, flush=True)


def load():
    """The modules whose packages are there, and why the others are not."""
    there, absent = [], []
    for name in MODULES:
        try:
            there.append(importlib.import_module(f"peers.lines.{name}"))
        except Exception as error:  # a broken installation is a finding
            absent.append({"package": name.removesuffix("_lines"), "message": f"{type(error).__name__}: {error}"})
    failed = Path(os.environ.get("NOSLIP_PEERS_FAILED", "/nonexistent"))
    if failed.is_file():
        for line in failed.read_text().splitlines():
            package, _, message = line.partition(": ")
            absent.append({"package": package, "message": message})
    return there, absent


def version_of(package):
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


def read(name, duration):
    """The problem of a scene: a sleigh, or a system of text."""
    if text.is_text(name):
        return text.read(name, duration)
    try:
        return scene.read(name, duration)
    except scene.Refused:
        # What no line knows by name may be known as formulas.
        return sleigh_text.read(name, duration)


def against(name, problem, options, bench):
    """The rows of the race for one scene: the peers that integrate it are made ready once."""
    if isinstance(problem, text.TextProblem):
        exact, lines, size = text.reference(problem).end, text.lines(problem), text.distance
        crates = lambda: []
    else:
        exact, size = reference(problem).end, measure.largest
        lines = [line for module in load()[0] if module.__name__.endswith("heyoka_lines") for line in module.lines(problem) if line.lanes == 1]
        crates = lambda: rust.climb(problem, exact, options.limit, options.budget, methods=options.methods)[0]

    def theirs():
        ladders = {}
        for line in lines:
            if wanted(line.method, options):
                ladders[line.method] = measure.climb(line, version_of(line.package), exact, options.limit, options.budget, size=size)[0]
        for point in crates():
            ladders.setdefault(point["method"], []).append(point)
        return ladders

    say(f"{name}: {problem.duration:g} s")
    return race.row(name, problem, theirs, options.ours, bench)


def wanted(method, options):
    return not options.methods or any(method.startswith(name) for name in options.methods)


def compare(problem, options):
    """The result of a problem, as `noslip precision --json` prints it, with what failed and what was absent."""
    say(f"{problem.name}: reference of {problem.duration} s")
    exact = reference(problem)
    modules, absent = load()
    points, failures, kept = [], [], []
    compiling = {}
    for module in modules:
        begin = time.perf_counter()
        lines = module.lines(problem)
        compiling[module.__name__.rsplit(".", 1)[-1].removesuffix("_lines")] = time.perf_counter() - begin
        for line in lines:
            if not wanted(line.method, options):
                continue
            say(f"{problem.name}: {line.method}")
            found = measure.climb(line, version_of(line.package), exact.end, options.limit, options.budget, kept)
            points += found[0]
            failures += found[1]
    for turn in range(measure.ROUNDS):
        say(f"{problem.name}: short runs, round {turn + 2}")
        measure.again(kept, options.budget)
    try:
        say(f"{problem.name}: the Rust crates")
        found = rust.climb(problem, exact.end, options.limit, options.budget, methods=options.methods)
        points += found[0]
        failures += found[1]
    except (OSError, RuntimeError) as error:
        absent.append({"package": "the Rust crates", "message": str(error)})
    for entry in absent:
        say(f"absent: {entry['package']}: {entry['message']}")
    machine = {"processor": processor(), "load_average": os.getloadavg(), "python": platform.python_version()}
    return {"program": "peers", "scene": problem.name, "duration": problem.duration, "reference": exact.as_dict(), "machine": machine,
            "compile_seconds": compiling, "points": points, "failures": failures, "absent": absent}


def processor():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor()


def table(result):
    """Microseconds to each error, a row a method, the fastest first."""
    methods = {}
    for point in result["points"]:
        methods.setdefault(point["method"], []).append(point)
    rows = []
    for method, points in methods.items():
        times = [measure.time_to(points, target) for target in TARGETS]
        cells = ["-" if t is None else f"{t * 1e6:.3g}" if t < 1e-2 else f"{t * 1e6:.0f}" for t in times]
        smallest = min(p["error"] for p in points)
        key = [float("inf") if t is None else t for t in (times[2], times[1], times[0])]
        rows.append((key, f"| {method} | {points[0]['form']} | {' | '.join(cells)} | {smallest:.1e} |"))
    head = f"| {result['scene']}, {result['duration']:g} s | form | us to 1e-3 | 1e-6 | 1e-9 | 1e-12 | smallest error |"
    return "\n".join([head, "|---|---|---|---|---|---|---|", *(row for _, row in sorted(rows))])


def write(path, result, force):
    """The whole file or none, and not over another unless asked."""
    if path.exists() and not force:
        raise scene.Refused(f"{path} is there already; --force overwrites it")
    part = path.with_name(path.name + ".part")
    part.write_text(json.dumps(result, indent=1) + "\n")
    part.replace(path)


def main():
    parser = argparse.ArgumentParser(prog="benches/peers/run", description=__doc__)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="a scene file or a bundled name")
    parser.add_argument("--case", action="append", default=[], help="S1, S2, L or bowl: 100 s")
    parser.add_argument("--duration", type=float, help="s, instead of the scene's (egg crate: at most 20 s)")
    parser.add_argument("--out", type=Path, help="JSON; with several scenes FILE.json becomes FILE.SCENE.json")
    parser.add_argument("--force", action="store_true", help="overwrite")
    parser.add_argument("--methods", type=lambda s: s.split(","), help="only those that begin so")
    parser.add_argument("--limit", type=float, default=5.0, help="a ladder ends with the first run longer than this (s)")
    parser.add_argument("--budget", type=float, default=0.2, help="what is spent on repeating a run (s)")
    parser.add_argument("--race", action="store_true", help="noslip beside the best peer on each scene, systems of text too")
    parser.add_argument("--compiled", action="store_true", help="of noslip the systems that system! compiles into the bench `text` (--race)")
    parser.add_argument("--ours", type=lambda s: s.split(","), help="of noslip only these methods (--race)")
    parser.add_argument("--energy", action="store_true", help="energy and slip of long runs in a bowl, against their time")
    parser.add_argument("--self-test", action="store_true", help="all peers against closed forms, loosely")
    options = parser.parse_args()
    # What fails is in the result; what is left warns of tolerances near rounding, at every run.
    warnings.simplefilter("ignore")
    try:
        if options.self_test:
            return selftest.main(load)
        if options.duration is not None and not options.duration > 0.0:
            raise scene.Refused("--duration must be positive")
        if options.race:
            bench = race.build() if options.compiled else None
            print("\n".join(race.HEAD), flush=True)
            for name in options.scenes:
                try:
                    rows = against(name, read(name, options.duration), options, bench)
                except (scene.Refused, RuntimeError) as refused:
                    rows = [f"| {name} | - | - | - | {refused} |"]
                print("\n".join(rows), flush=True)
            return 0
        problems = [scene.read(name, options.duration) for name in options.scenes]
        problems += [scene.case(name, options.duration) for name in options.case]
        if not problems:
            raise scene.Refused("no scene: name one, or --case, or --self-test")
        if options.energy:
            # Its packages are needed for nothing else.
            energy = importlib.import_module("peers.energy")
            for problem in problems:
                print(energy.table(problem), flush=True)
            return 0
        for problem in problems:
            several = len(problems) > 1
            path = options.out
            if path and several:
                path = path.with_suffix(f".{problem.name}{path.suffix}")
            if path and path.exists() and not options.force:
                raise scene.Refused(f"{path} is there already; --force overwrites it")
            result = compare(problem, options)
            if path:
                write(path, result, options.force)
            print(table(result), flush=True)
    except scene.Refused as refused:
        say(f"error: {refused}")
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
