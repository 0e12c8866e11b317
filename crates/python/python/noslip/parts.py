"""Parts of a sweep, made by the workers of an executor."""

from __future__ import annotations

import hashlib
import time
import uuid
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from queue import SimpleQueue
from typing import Any, NamedTuple, Protocol, TypeVar

from . import _noslip
from .commands import call
from .errors import Interrupted
from .progress import Progress

Value = TypeVar("Value", covariant=True)

# How long a worker waits for another process that makes the same part (s), and how often it looks.
PATIENCE = 60.0
OFTEN = 0.2


class Promise(Protocol[Value]):
    """What a task will give, as `concurrent.futures.Future`."""

    def result(self) -> Value: ...
    def cancel(self) -> Any: ...
    def add_done_callback(self, fn: Any, /) -> Any: ...


class Submits(Protocol):
    """What takes tasks, as `concurrent.futures.Executor`."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Promise[Any]: ...


class Task(NamedTuple):
    """A part to be made: all that a worker needs to know."""

    sweep: str
    folder: str
    number: int
    of: int
    name: str
    # Sets each try apart: an executor that remembers what a task gave would give the failure again.
    token: str


class Made(NamedTuple):
    """A part that is there: its hash, and how many members were computed for it now."""

    hash: str
    computed: int


class Later:
    """A task of the calling thread, which does it when it is asked for the result."""

    def __init__(self, made: Callable[[], Any]) -> None:
        self._made = made

    def result(self) -> Any:
        return self._made()

    def cancel(self) -> None:
        """Nothing has begun."""

    def add_done_callback(self, fn: Any, /) -> None:
        fn(self)


class Here:
    """The calling thread, as what takes tasks."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Promise[Any]:
        return Later(partial(fn, *args, **kwargs))


def make(task: Task) -> Made:
    """Makes a part, unless it is there; one that was interrupted goes on. Done by a worker."""
    arguments = ["ensemble", task.sweep, "--json", "--out", task.folder, "--part", f"{task.number}/{task.of}"]
    until = time.monotonic() + PATIENCE
    while True:
        try:
            told = call(arguments)
            part = Path(task.folder) / task.name
            if not part.exists():
                raise OSError(
                    f"the worker did not make {task.name}: it has another version of noslip or another set of instructions than the "
                    "driver, and its numbers would differ in the last bits"
                )
            return Made(digest(part), int(told["computed"]))
        except _noslip.BusyError:
            # A worker that was given up may still be at work.
            if time.monotonic() > until:
                raise
            time.sleep(OFTEN)


def digest(file: Path) -> str:
    """The hash of a part."""
    found = hashlib.sha256()
    with file.open("rb") as rows:
        while block := rows.read(1 << 20):
            found.update(block)
    return found.hexdigest()


def gather(sweep: Path, folder: Path, executor: Submits | None, tasks: int, retries: int, tell: Progress | None) -> int:
    """Has all parts of a sweep made, and says how many members were computed for them."""
    stem, _, names = _noslip.plan(str(sweep), max(tasks, 0))
    _, version = stem.split("-", 1)
    if any(file.stem != stem for file in folder.glob(f"*-{version}.json")):
        raise _noslip.RequestError(f"{folder} has parts of another sweep: every sweep has a folder of its own")
    # The tasks of a Dask client are its executor's, which has the futures of the standard library.
    get_executor = getattr(executor, "get_executor", None)
    submits: Submits = get_executor(pure=False) if get_executor is not None else executor or Here()
    run, failures, done = uuid.uuid4().hex, Counter[int](), 0
    ready: SimpleQueue[Promise[Made]] = SimpleQueue()
    pending: dict[Promise[Made], int] = {}

    def submit(part: int) -> None:
        token = f"{run} {part} {failures[part]}"
        task = Task(str(sweep), str(folder.absolute()), part + 1, len(names), names[part], token)
        try:
            promise = submits.submit(make, task)
        except Exception as error:
            raise failed("the executor takes no more tasks", error) from error
        pending[promise] = part
        promise.add_done_callback(ready.put)

    def failed(problem: str, error: Exception) -> _noslip.ComputationError:
        kept = f"{done} of {len(names)} parts are done; in a folder that is given as `parts` they stay, and the same call makes the others"
        return _noslip.ComputationError(f"{problem}: {type(error).__name__}: {error}; {kept}")

    computed = 0
    try:
        for part in range(len(names)):
            submit(part)
        while pending:
            promise = ready.get()
            part = pending.pop(promise)
            try:
                made = promise.result()
                if not (folder / names[part]).exists():
                    raise FileNotFoundError(f"a worker made {names[part]}, and it is not in {folder}: have they one folder?")
                if digest(folder / names[part]) != made.hash:
                    raise OSError(f"{names[part]} is not as its worker wrote it")
            except Exception as error:
                failures[part] += 1
                if failures[part] > retries:
                    raise failed(f"part {part + 1} failed {failures[part]} times, at last", error) from error
                submit(part)
                continue
            done, computed = done + 1, computed + made.computed
            if tell is not None:
                tell("parts", done, len(names))
    except KeyboardInterrupt:
        raise Interrupted({"parts": done, "of": len(names), "folder": str(folder)}) from None
    finally:
        for promise in pending:
            promise.cancel()
    return computed
