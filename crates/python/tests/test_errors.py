"""What is wrong comes back as an exception that carries what a program needs."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import noslip


def test_a_wrong_scene_names_line_and_field() -> None:
    with pytest.raises(noslip.RequestError, match=r"sleigh.mass"):
        noslip.scene({"sleigh": {"mass": -1.0}})
    with pytest.raises(noslip.RequestError, match="bundled scenes are turnaround"):
        noslip.scene("nowhere")


@pytest.mark.parametrize(
    "wrong",
    [
        {"method": "gauss17"},
        {"step": -1.0},
        {"step": float("nan")},
        {"duration": float("inf")},
        {"every": 0},
        {"events": "place=0"},
        {"tolerance": -1.0},
        {"t_eval": []},
        {"t_eval": [5.0, 1.0, 3.0, 9.0]},
        {"t_eval": [0.1, 1000.0]},
        {"t_eval": [-1.0, 0.1]},
        {"t_eval": [0.1, float("nan")]},
    ],
)
def test_a_wrong_argument_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(noslip.NoslipError):
        noslip.scene("turnaround").run(**wrong)  # type: ignore[arg-type]


def test_a_run_that_fails_keeps_what_was_made() -> None:
    # Half a turn in a step: no solution of the discrete equations continues the motion.
    sleigh = noslip.Sleigh(speed=1.0, turn_rate=255.0, step=0.05, duration=2.0)
    with pytest.raises(noslip.RunError) as caught:
        sleigh.run(method="dla")
    error = caught.value
    assert error.step == error.result.steps + 1 and error.reason
    assert error.time == error.result["t"][-1]


def test_a_wrong_command_is_refused() -> None:
    with pytest.raises(noslip.RequestError, match="unknown method"):
        noslip.scene("turnaround").compare(methods=["gauss17"])
    with pytest.raises(noslip.RequestError, match=r"Scene.lyapunov has no argument 'foo'; its arguments are .*exponents.*step") as caught:
        noslip.scene("turnaround").lyapunov(foo=2)
    assert isinstance(caught.value, TypeError)
    with pytest.raises(noslip.RequestError) as caught:
        noslip.scene("turnaround").lyapunov(exponents="many")
    assert "--" not in str(caught.value) and "Usage" not in str(caught.value)
    with pytest.raises(noslip.RequestError, match="tolerance chooses no step for a run backward in time: give step"):
        noslip.scene("turnaround").run(tolerance=1e-3, duration=-1.0)


def test_the_interpreter_goes_on_beside_a_run() -> None:
    counted = 0
    done = threading.Event()

    def run() -> None:
        noslip.scene("bowl").run(method="gauss8", step=0.005, duration=40.0, every=1000)
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    while not done.is_set():
        counted += 1
        time.sleep(0)
    thread.join()
    assert counted > 100


def test_progress_is_told() -> None:
    told: list[tuple[str, int, int]] = []
    noslip.scene("bowl").run(
        method="gauss8", step=0.002, duration=100.0, every=10_000, progress=lambda *now: told.append(now)
    )
    assert told and told[0][0] == "gauss8" and told[0][2] == 50_000
    assert [done for _, done, _ in told] == sorted(done for _, done, _ in told)


def test_what_progress_raises_ends_the_run() -> None:
    def stop(label: str, done: int, of: int) -> None:
        raise RuntimeError("enough")

    begin = time.perf_counter()
    with pytest.raises(RuntimeError, match="enough"):
        noslip.scene("bowl").run(method="gauss8", step=1e-6, duration=100.0, every=10**6, progress=stop)
    assert time.perf_counter() - begin < 30.0


@pytest.mark.parametrize("scene", [noslip.scene("turnaround"), noslip.System(["x"], "x'^2/2")])
def test_a_run_that_does_not_fit_into_memory_is_refused_before_it_begins(scene: noslip.Scene) -> None:
    begin = time.perf_counter()
    with pytest.raises(noslip.RequestError, match=r"every=\d+ keeps fewer nodes, t_eval= the motion") as caught:
        scene.run(step=1e-8, duration=100.0)
    assert isinstance(caught.value, MemoryError) and time.perf_counter() - begin < 1.0


# A step of an adaptive method that gets nowhere: at t = 0 no coordinate of it may move.
STUCK = """
[system]
coordinates = { q0 = "1", q1 = "1" }
lagrangian = "q0'^2/2+q1'^2/2"
constraints = ["((sinh(pi) / (q1 / 3.7)))*q0' + (((2 - q0) / (0 - q0)))*q1' + ((t - 1e10) * cosh(1e-10))"]
[start]
q0 = 0.7
q1 = 0.9
[run]
step = 0.01
duration = 3.0
"""

# What is long in Python, and what is known of it when it is interrupted.
LONG = {
    "nodes": ("noslip.scene('bowl').run(method='gauss8', step=1e-6, duration=4.0)", "result['t'][-1] > 0.0"),
    "times": ("noslip.scene('bowl').run(step=1e-6, duration=1e3, t_eval=[0.001 * k for k in range(1000)])", "result['t'][-1] > 0.0"),
    "tolerance": ("noslip.scene('bowl').run(method='dla', tolerance=1e-12, duration=1e3)", "result is None"),
    "section": ("noslip.scene('bowl').section(plane='x=0', starts=2, duration=1e6)", "all(start['interrupted'] for start in result['starts'])"),
    "derivatives": ("noslip.scene('bowl').sensitivities('speed', method='gauss8', step=1e-5, duration=1e3)", None),
    "dop853": ("noslip.Scene(STUCK).run(method='dop853')", "result.steps == 0"),
    "gauss-adaptive": ("noslip.Scene(STUCK).run(method='gauss-adaptive')", "result.steps == 0"),
}


@pytest.mark.skipif(not hasattr(signal, "SIGINT") or os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("what", LONG)
def test_ctrl_c_ends_everything_at_once_and_keeps_what_is_done(what: str) -> None:
    work, known = LONG[what]
    code = f"""
import noslip, os, signal, threading, time
# Also below a shell that ignores the signal, as it does for commands in its background.
signal.signal(signal.SIGINT, signal.default_int_handler)
STUCK = {STUCK!r}
def interrupt():
    global asked
    time.sleep(0.3)
    asked = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    print({work})
except KeyboardInterrupt as interrupted:
    late = time.monotonic() - asked
    result = getattr(interrupted, "result", None)
    print({known or "True"}, late, isinstance(interrupted, noslip.Interrupted))
"""
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    good, late, carries = told.stdout.split()
    assert (good, carries) == ("True", str(known is not None)), told
    # 50 ms on a machine that does nothing else; steps without optimisation take ten times as long, and tests share a core.
    assert float(late) < 0.5
