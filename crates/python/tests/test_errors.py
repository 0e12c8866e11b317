"""What is wrong comes back as an exception that carries what a program needs."""

import os
import signal
import subprocess
import sys
import textwrap
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
    with pytest.raises(noslip.RequestError):
        noslip.scene("turnaround").lyapunov(nonsense=3)


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


@pytest.mark.skipif(not hasattr(signal, "SIGINT") or os.name != "posix", reason="signals of POSIX")
def test_ctrl_c_keeps_what_is_done() -> None:
    code = textwrap.dedent(
        """
        import noslip, time
        print("ready", flush=True)
        try:
            noslip.scene("bowl").run(method="gauss8", step=1e-6, duration=1000.0, every=10**5)
        except noslip.Interrupted as interrupted:
            print(interrupted.result["t"][-1] > 0.0, isinstance(interrupted, KeyboardInterrupt))
        """
    )
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None and child.stdout.readline() == "ready\n"
    time.sleep(1.0)
    child.send_signal(signal.SIGINT)
    out, _ = child.communicate(timeout=60)
    assert out == "True True\n"
