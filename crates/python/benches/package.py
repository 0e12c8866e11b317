"""What the package costs beside the steps, how soon Ctrl-C ends a run, and how fast its code is.

    python benches/package.py

Of a wheel that was built with `maturin build --release`. To compare a portable wheel with one for this machine alone, run it with
each of them: the second is built with `RUSTFLAGS="-C target-cpu=native"`.
"""

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from random import Random
from statistics import median

import noslip

ROUNDS = 41

LONG = """
import noslip, sys, time
print("ready", flush=True)
try:
    noslip.scene(sys.argv[1]).run(method="gauss8", step=1e-6, duration=1000.0, every=10**5)
except noslip.Interrupted as interrupted:
    print(time.monotonic(), interrupted.result["t"][-1] > 0.0)
"""


def least(action: Callable[[], object], rounds: int = ROUNDS) -> float:
    """The least processor time of some rounds (s): what others do on the machine only adds to it."""
    times = []
    for _ in range(rounds):
        begin = time.process_time()
        action()
        times.append(time.process_time() - begin)
    return min(times)


def overhead(name: str, method: str) -> tuple[float, float]:
    """The time of a run of 1000 steps beyond these, all nodes kept, and of a step (s)."""
    scene = noslip.scene(name)

    def run(steps: int, every: int) -> float:
        return least(lambda: scene.run(method=method, step=0.01, duration=0.01 * steps, every=every))

    step = (run(40_000, 40_000) - run(10_000, 10_000)) / 30_000
    return run(1000, 1) - 1000 * step, step


def interrupted(tries: int = 20) -> list[float]:
    """How long after the signal a run has ended (s)."""
    random, times = Random(1), []
    for _ in range(tries):
        child = subprocess.Popen([sys.executable, "-c", LONG, "bowl"], stdout=subprocess.PIPE, text=True)
        assert child.stdout is not None
        child.stdout.readline()
        time.sleep(random.uniform(0.2, 0.5))
        sent = time.monotonic()
        child.send_signal(signal.SIGINT)
        ended, kept = child.communicate()[0].split()
        assert kept == "True"
        times.append(float(ended) - sent)
    return times


def members(method: str, count: int = 20_000) -> float:
    """The time of a member of a sweep of 1000 steps (s)."""
    random = {"seed": 1, "count": count, "start.turn_rate": {"uniform": [0.05, 0.3]}}
    sweep = {"scene": "turnaround", "method": method, "step": 0.05, "duration": 50.0, "random": random}
    return float(min(noslip.ensemble(sweep).summary["wall_seconds"] for _ in range(5))) / count


if __name__ == "__main__":
    for name, method in [("turnaround", "dla"), ("turnaround", "gauss16"), ("bowl", "gauss16"), ("rolling-disk", "dla")]:
        beyond, step = overhead(name, method)
        print(f"{name} by {method}: {1e6 * beyond:.0f} us beyond 1000 steps of {1e9 * step:.0f} ns")
    for method in ["dla", "gauss16", "rk4"]:
        print(f"a member of 1000 steps by {method}: {1e6 * members(method):.2f} us")
    times = interrupted()
    print(f"Ctrl-C: {1e3 * median(times):.1f} ms, {1e3 * max(times):.1f} ms at most of {len(times)}")
