#!/usr/bin/env python3
"""Makes the tables of times in docs/benchmarks.md again, and says what has moved.

    docs/tables.py [--program PATH] [--write]
    docs/tables.py --race FILE... [--write]

The second makes the table of noslip beside other programs from what `benches/peers/run --race SCENE...` printed to these files.

The program is target/release/noslip unless another is given. Times of another machine differ, so a time has moved where it is more than
three times as large or as small, and a method where it is overtaken by one that took twice as long. Figures that are not times are
compared digit by digit by the tests (tests/book/figures.txt). With --write the page gets the new table.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "benchmarks.md"
HEAD = "| method | order | `turnaround`: slope | time to an error | `bowl`: slope | time to an error |"
SCENES = ("turnaround", "bowl")
TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)
FACTOR = 3.0


def measured(program, scene):
    """By method: order, slope, and microseconds to each error (None: not reached)."""
    command = [program, "precision", scene, "--alpha", "0.5", "--json"]
    told = json.loads(subprocess.run(command, capture_output=True, text=True, check=False).stdout)
    rows = {}
    for method in told["methods"]:
        times = {entry["error"]: entry["seconds"] for entry in method["seconds_to"]}
        micro = [None if times.get(target) is None else 1e6 * times[target] for target in TARGETS]
        rows[method["method"]] = (method.get("order"), method.get("slope"), micro)
    return rows


def three(x):
    """Three digits; a dash for what is not reached."""
    return "-" if x is None else f"{x:.3g}" if x < 1000 else str(int(float(f"{x:.3g}")))


def cells(times, cheapest):
    bold = lambda k, text: f"**{text}**" if times[k] is not None and times[k] == cheapest[k] else text
    return " / ".join(bold(k, three(t)) for k, t in enumerate(times))


def made(found):
    """The lines of the table."""
    least = {scene: [min((row[2][k] for row in rows.values() if row[2][k] is not None), default=None) for k in range(4)]
             for scene, rows in found.items()}
    lines = [HEAD, "|---|---|---|---|---|---|"]
    for name, (order, _, _) in found[SCENES[0]].items():
        line = f"| {name} | {'-' if order is None else order} |"
        for scene in SCENES:
            _, slope, times = found[scene].get(name, (None, None, [None] * 4))
            line += f" {'-' if slope is None else f'{slope:.2f}'} | {cells(times, least[scene])} |"
        lines.append(line)
    return lines


def told(lines):
    """By method: the times of each scene, as the page has them."""
    number = lambda text: None if text.strip("* ") == "-" else float(text.strip("* "))
    rows = {}
    for line in lines[2:]:
        parts = [part.strip() for part in line.strip("|").split("|")]
        rows[parts[0]] = [[number(t) for t in parts[k].split("/")] for k in (3, 5)]
    return rows


def moved(old, new):
    """Sentences on what is no longer as the page says."""
    for name in sorted(set(old) ^ set(new)):
        yield f"{name}: {'no longer measured' if name in old else 'not on the page'}"
    both = [name for name in old if name in new]
    for s, scene in enumerate(SCENES):
        for k, target in enumerate(TARGETS):
            times = {name: (old[name][s][k], new[name][s][k]) for name in both}
            for name, (before, now) in times.items():
                if (before is None) != (now is None):
                    yield f"{scene}, {target:g}: {name} {'is not reached any more' if now is None else 'is reached now'}"
                elif before and not 1 / FACTOR < now / before < FACTOR:
                    yield f"{scene}, {target:g}: {name} takes {three(now)} us, the page says {three(before)}"
            known = {name: pair for name, pair in times.items() if None not in pair}
            for a, (before, now) in known.items():
                for b, (other, later) in known.items():
                    if other > 2.0 * before and later < now:
                        yield f"{scene}, {target:g}: {b} is now quicker than {a}"


RACE = "| scene | 1e-3 | 1e-6 | 1e-9 | 1e-12 |"


def cell(ours, peer):
    """Two methods with their times, and the second time over the first, of the digits that are shown."""
    if ours == peer == "-":
        return "-"
    if "-" in (ours, peer):
        return f"{ours}, {peer}"
    first, second = (float(of.split(" ")[-1]) for of in (ours, peer))
    return f"{ours}, {peer}: **{second / first:.2f}**"


def raced(files):
    """The lines of the race, a line for each scene, in the order of the files."""
    scenes = {}
    for file in files:
        for line in Path(file).read_text().splitlines():
            parts = [part.strip() for part in line.strip("|").split("|")]
            if len(parts) == 5 and parts[0] not in ("scene", "---"):
                scene, _, ours, peer, _ = parts
                scenes.setdefault(scene, []).append(cell(ours.removesuffix(" us"), peer.removesuffix(" us")))
    return [RACE, "|---|---|---|---|---|", *(f"| `{scene}` | {' | '.join(cells)} |" for scene, cells in scenes.items())]


def replaced(text, head, lines):
    """The text with another table below this heading."""
    begin = text.index(head)
    end = text.index("\n\n", begin)
    return text[:begin] + "\n".join(lines) + text[end:]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "target" / "release" / "noslip"))
    parser.add_argument("--race", nargs="+", metavar="FILE", help="what benches/peers/run --race printed")
    parser.add_argument("--write", action="store_true", help="put the new table into the page")
    options = parser.parse_args()
    text = PAGE.read_text()
    if options.race:
        lines = raced(options.race)
        print("\n".join(lines))
        if options.write:
            PAGE.write_text(replaced(text, RACE, lines))
        return 0
    begin = text.index(HEAD)
    end = text.index("\n\n", begin)
    lines = made({scene: measured(options.program, scene) for scene in SCENES})
    found = list(moved(told(text[begin:end].split("\n")), told(lines)))
    print("\n".join(found) or "nothing has moved")
    if options.write:
        PAGE.write_text(replaced(text, HEAD, lines))
    return 1 if found and not options.write else 0


if __name__ == "__main__":
    sys.exit(main())
