"""Sweeps as parts, made by the workers of an executor: the numbers of one process, whatever is killed."""

import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

import noslip
from noslip.commands import call
from noslip.parts import Task, make

SWEEP = {
    "scene": "turnaround",
    "duration": 5.0,
    "random": {"seed": 3, "count": 501, "start.turn_rate": {"uniform": [0.05, 0.3]}},
}

TRIES = int(os.environ.get("NOSLIP_TRIES", "1"))


def equal(found: noslip.Ensemble, expected: noslip.Ensemble) -> None:
    assert list(found) == list(expected)
    for name, column in expected.items():
        np.testing.assert_array_equal(found[name], column, err_msg=name)
    for key in ("members", "failed", "columns"):
        assert found.summary[key] == expected.summary[key]


@pytest.fixture(scope="module")
def serial() -> noslip.Ensemble:
    return noslip.ensemble(SWEEP)


def rows(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.rows"))


@pytest.mark.parametrize("tasks", [1, 7])
def test_threads_and_processes_give_the_numbers_of_one_process(tasks: int, serial: noslip.Ensemble) -> None:
    with ThreadPoolExecutor(2) as threads:
        equal(noslip.ensemble(SWEEP, executor=threads, tasks=tasks), serial)
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as processes:
        equal(noslip.ensemble(SWEEP, executor=processes, tasks=tasks), serial)


def test_parts_without_an_executor_are_made_here_and_kept(tmp_path: Path, serial: noslip.Ensemble) -> None:
    told: list[tuple[str, int, int]] = []
    found = noslip.ensemble(SWEEP, parts=tmp_path / "parts", tasks=5, progress=lambda *now: told.append(now))
    equal(found, serial)
    assert found.summary["computed"] == 501 and told == [("parts", k, 5) for k in range(1, 6)]
    assert len(rows(tmp_path / "parts")) == 5
    # Parts that are there are not made again, but for one that is damaged.
    again = noslip.ensemble(SWEEP, parts=tmp_path / "parts", tasks=5)
    equal(again, serial)
    assert again.summary["computed"] == 0
    rows(tmp_path / "parts")[2].write_bytes(b"damaged")
    mended = noslip.ensemble(SWEEP, parts=tmp_path / "parts", tasks=5)
    equal(mended, serial)
    assert 0 < mended.summary["computed"] < 200


class Flaky(Executor):
    """Fails each task so many times before it makes it."""

    def __init__(self, failures: int, spared: int = 0) -> None:
        self.failures = failures
        self.spared = spared
        self.tries: dict[int, int] = {}

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        task: Task = args[0]
        tried = self.tries[task.number] = self.tries.get(task.number, 0) + 1
        future: Future[Any] = Future()
        if task.number > self.spared and tried <= self.failures:
            future.set_exception(RuntimeError("a node was lost"))
        else:
            future.set_result(fn(*args, **kwargs))
        return future


def test_a_part_that_fails_is_made_again(serial: noslip.Ensemble) -> None:
    flaky = Flaky(3)
    equal(noslip.ensemble(SWEEP, executor=flaky, tasks=6), serial)
    assert flaky.tries == dict.fromkeys(range(1, 7), 4)


def test_tries_are_bounded_and_what_is_done_stays(tmp_path: Path, serial: noslip.Ensemble) -> None:
    flaky = Flaky(10**9, spared=2)
    with pytest.raises(noslip.ComputationError, match=r"part 3 failed 3 times.*a node was lost.*2 of 6 parts are done") as caught:
        noslip.ensemble(SWEEP, executor=flaky, parts=tmp_path, tasks=6, retries=2)
    assert isinstance(caught.value.__cause__, RuntimeError)
    assert len(rows(tmp_path)) == 2
    found = noslip.ensemble(SWEEP, executor=Flaky(0), parts=tmp_path, tasks=6)
    equal(found, serial)
    assert found.summary["computed"] == 501 - 167


class Elsewhere(Executor):
    """Has a folder of its own, as a worker on a machine without the driver's."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(fn(args[0]._replace(folder=str(self.folder))))
        return future


def test_workers_with_another_folder_are_noticed(tmp_path: Path) -> None:
    with pytest.raises(noslip.ComputationError, match="have they one folder"):
        noslip.ensemble(SWEEP, executor=Elsewhere(tmp_path / "other"), parts=tmp_path / "parts", tasks=3)


def test_a_folder_has_the_parts_of_one_sweep(tmp_path: Path) -> None:
    noslip.ensemble(SWEEP, parts=tmp_path, tasks=2)
    other = {**SWEEP, "duration": 6.0}
    with pytest.raises(noslip.RequestError, match=r"sweep.toml is there, of another sweep"):
        noslip.ensemble(other, parts=tmp_path)
    (tmp_path / "sweep.toml").unlink()
    with pytest.raises(noslip.RequestError, match="has parts of another sweep"):
        noslip.ensemble(other, parts=tmp_path)
    for wrong in [{**SWEEP, "scene": "nowhere"}, {**SWEEP, "duration": -1.0}, {**SWEEP, "grid": {"start.z": [1.0]}}]:
        with pytest.raises(noslip.RequestError):
            noslip.ensemble(wrong, executor=Flaky(0), tasks=3)
    with pytest.raises(noslip.RequestError, match="0 parts"):
        noslip.ensemble(SWEEP, executor=Flaky(0), tasks=0)


def test_a_scene_of_ones_own_is_swept(tmp_path: Path) -> None:
    system = noslip.System({"x": "m"}, "m/2*x'^2 - k/2*x^2", parameters={"m": 1.0, "k": 4.0}, q=[1.0], duration=1.0)
    sweep = {"scene": system, "method": "gauss8", "grid": {"parameters.k": [1.0, 4.0, 9.0]}}
    found = noslip.ensemble(sweep, executor=Flaky(0), parts=tmp_path)
    assert len(rows(tmp_path)) == 3, "no task is without a member"
    np.testing.assert_allclose(found["x"], np.cos([1.0, 2.0, 3.0]), atol=1e-9)
    equal(noslip.ensemble({**sweep, "scene": str(tmp_path / "scene.toml")}), found)


@pytest.mark.skipif(os.name != "posix", reason="locks of POSIX")
def test_a_part_that_another_process_makes_is_waited_for(tmp_path: Path, serial: noslip.Ensemble) -> None:
    import fcntl

    noslip.ensemble(SWEEP, parts=tmp_path, tasks=2)
    part = rows(tmp_path)[0]
    whole = part.read_bytes()
    part.unlink()
    with part.with_name(f"{part.name}.part").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        number = 1 if part.name.split("-")[2] == "0" else 2
        task = Task(str(tmp_path / "sweep.toml"), str(tmp_path), number, 2, part.name, "")
        with pytest.raises(noslip.BusyError, match="another process"):
            call(["ensemble", task.sweep, "--out", task.folder, "--part", f"{number}/2"])
        threading.Timer(0.5, lambda: fcntl.flock(held, fcntl.LOCK_UN)).start()
        made = make(task)
    assert made.computed > 0 and part.read_bytes() == whole


def test_errors_of_workers_can_be_sent() -> None:
    with pytest.raises(noslip.RunError) as caught:
        noslip.Sleigh(speed=1.0, turn_rate=255.0, step=0.05, duration=2.0).run(method="dla")
    error = pickle.loads(pickle.dumps(caught.value))
    assert (error.step, error.reason, str(error)) == (caught.value.step, caught.value.reason, str(caught.value))
    np.testing.assert_array_equal(error.result["x"], caught.value.result["x"])
    interrupted = pickle.loads(pickle.dumps(noslip.Interrupted({"members": 3})))
    assert interrupted.result == {"members": 3}
    for kind in (noslip.RequestError, noslip.ComputationError, noslip.BusyError):
        assert type(pickle.loads(pickle.dumps(kind("so")))) is kind


# Half a second to some seconds of work, so that a kill comes in the middle.
LONG = {
    "scene": "turnaround",
    "method": "rk4",
    "duration": 100.0,
    "random": {"seed": 5, "count": 480, "start.turn_rate": {"uniform": [0.05, 0.3]}},
}
TASKS = 24


@pytest.fixture(scope="module")
def long_serial() -> noslip.Ensemble:
    return noslip.ensemble(LONG)


def wait_for(folder: Path, parts: int) -> None:
    """Until so many parts are there."""
    until = time.monotonic() + 120.0
    while len(rows(folder)) < parts:
        assert time.monotonic() < until, f"{len(rows(folder))} parts after two minutes"
        time.sleep(0.005)


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
def test_a_pool_that_lost_a_process_is_broken_and_its_parts_stay(tmp_path: Path, long_serial: noslip.Ensemble) -> None:
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        victims = {pool.submit(os.getpid).result()}

        def kill() -> None:
            wait_for(tmp_path, 3)
            os.kill(victims.pop(), signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        with pytest.raises(noslip.ComputationError, match="parts are done"):
            noslip.ensemble(LONG, executor=pool, parts=tmp_path, tasks=TASKS)
        killer.join()
    with ThreadPoolExecutor(2) as threads:
        found = noslip.ensemble(LONG, executor=threads, parts=tmp_path, tasks=TASKS)
    equal(found, long_serial)
    assert 0 < found.summary["computed"] < 480


# Of its own for every test: one that lost several workers does not always get new ones.
@pytest.fixture
def client() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        yield client


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_dask_gives_the_numbers_of_one_process(client: Any, serial: noslip.Ensemble, tmp_path: Path) -> None:
    equal(noslip.ensemble(SWEEP, executor=client, tasks=7), serial)
    equal(noslip.ensemble(SWEEP, executor=client.get_executor(), parts=tmp_path, tasks=7), serial)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("number", range(TRIES))
def test_dask_finishes_after_a_killed_worker(number: int, client: Any, long_serial: noslip.Ensemble, tmp_path: Path) -> None:
    random = Random(number)
    client.wait_for_workers(2, timeout=60)
    victim = random.choice(sorted(client.run(os.getpid).values()))
    killed: list[int] = []

    def kill() -> None:
        wait_for(tmp_path, random.randrange(1, TASKS - 4))
        time.sleep(random.uniform(0.0, 0.05))
        os.kill(victim, signal.SIGKILL)
        killed.append(len(rows(tmp_path)))

    killer = threading.Thread(target=kill)
    killer.start()
    found = noslip.ensemble(LONG, executor=client, parts=tmp_path, tasks=TASKS)
    killer.join()
    assert killed and killed[0] < TASKS, "the kill came too late to tell"
    equal(found, long_serial)
    assert not Path(f"/proc/{victim}/exe").exists()


DRIVER = """
    import json, sys
    import distributed, noslip

    if __name__ == "__main__":
        cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
        with cluster, distributed.Client(cluster) as client:
            noslip.ensemble(json.loads(sys.argv[1]), executor=client, parts=sys.argv[2], tasks=int(sys.argv[3]))
"""


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("number", range(TRIES))
def test_a_killed_driver_is_resumed(number: int, client: Any, long_serial: noslip.Ensemble, tmp_path: Path) -> None:
    random = Random(number)
    parts, script = tmp_path / "parts", tmp_path / "driver.py"
    script.write_text(textwrap.dedent(DRIVER), encoding="utf-8")
    command = [sys.executable, str(script), json.dumps(LONG), str(parts), str(TASKS)]
    driver = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    wait_for(parts, random.randrange(1, TASKS - 4))
    driver.kill()
    driver.wait()
    there = len(rows(parts))
    assert 0 < there < TASKS, "the kill came too late to tell"
    found = noslip.ensemble(LONG, executor=client, parts=parts, tasks=TASKS)
    equal(found, long_serial)
    assert 0 < found.summary["computed"] < 480
