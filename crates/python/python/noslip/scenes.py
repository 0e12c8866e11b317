"""Scenes: a system, its start and how to run it."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from . import _noslip
from .commands import call, flags
from .errors import ArgumentError, Interrupted, RunError, TooLargeError
from .progress import Progress, shown
from .results import Run, warn
from .saved import saved_run
from .sensitivities import Prediction, Sensitivities

Texts = str | Iterable[str] | None


def _list(texts: Texts) -> list[str]:
    return [texts] if isinstance(texts, str) else list(texts or ())


def _times(t_eval: Iterable[float] | None) -> list[float]:
    """The times of samples; none where nothing is said of them."""
    times = [] if t_eval is None else [float(t) for t in t_eval]
    if t_eval is not None and not times:
        raise _noslip.RequestError("t_eval has no times; leave t_eval out for all nodes of a run, or for its end")
    return times


def tables(value: Any) -> Any:
    """The tables of a scene with arrays and numbers of NumPy as TOML has them."""
    if isinstance(value, Mapping):
        return {key: tables(one) for key, one in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [tables(one) for one in value]
    return value


def methods() -> dict[str, dict[str, Any]]:
    """The methods by name, with their order, what they keep to round-off, and what they are."""
    return {
        name: {"order": order, "keeps": keeps, "summary": summary} for name, order, keeps, summary in _noslip.methods()
    }


def scenes() -> list[str]:
    """The names of the bundled scenes."""
    return [name for name, _ in _noslip.bundled()]


def scene(source: str | PathLike[str] | Mapping[str, Any]) -> Scene:
    """The bundled scene of that name, the scene of a file, or the one that a dictionary has the tables of.

    Raises `noslip.RequestError` with the line and the field that is wrong.
    """
    if isinstance(source, Mapping):
        return Scene(tomli_w.dumps(tables(source)), str(source.get("title") or "scene"))
    named = dict(_noslip.bundled())
    name = str(source).replace("_", "-")
    if name in named:
        return Scene(named[name], name)
    try:
        return Scene(Path(source).read_text(encoding="utf-8"), str(source))
    except (OSError, UnicodeDecodeError) as error:
        known = ", ".join(named)
        message = f"{source}: no file that can be read ({error}); the bundled scenes are {known}"
        raise _noslip.RequestError(message) from None


class Scene:
    """A scene; its methods are the commands of the program.

    `text` is the scene as a file has it. Scenes can be pickled, compared and hashed.
    """

    def __init__(self, text: str, origin: str = "scene") -> None:
        self._checked = _noslip.Scene(text, origin)
        self.text = text
        self.origin = origin
        for key, given, taken in self._checked.moved:
            message = f"the constraints do not admit {key} = {given:.6g} at the start; the run starts with {taken:.6g}"
            warnings.warn(message, stacklevel=3)

    @property
    def name(self) -> str:
        """The name."""
        return self._checked.name

    @property
    def title(self) -> str:
        """The title; the name where there is none."""
        return self._checked.title

    @property
    def method(self) -> str:
        """The method of its run."""
        return self._checked.method

    @property
    def step(self) -> float:
        """The largest step of its run (s)."""
        return self._checked.step

    @property
    def duration(self) -> float:
        """The duration of its run (s)."""
        return self._checked.duration

    def __reduce__(self) -> tuple[Any, ...]:
        return Scene, (self.text, self.origin)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and (self.text, self.name) == (other.text, other.name)

    def __hash__(self) -> int:
        return hash((self.text, self.name))

    def __repr__(self) -> str:
        return f"<noslip.Scene {self.name}: {self.title}>"

    def run(
        self,
        *,
        method: str | None = None,
        step: float | None = None,
        tolerance: float | None = None,
        duration: float | None = None,
        alpha: float | None = None,
        t_eval: Iterable[float] | None = None,
        every: int = 1,
        substep: bool = False,
        events: Texts = None,
        until: Texts = None,
        checkpoint: str | PathLike[str] | None = None,
        checkpoint_every: int | None = None,
        progress: bool | Progress | None = None,
    ) -> Run:
        """Makes a run, and keeps every `every`-th node, or the motion at the times `t_eval` (s, in order).

        `events` and `until` are texts as `"speed=0"`: what is reported, and what ends the run. `progress` is `True` for a
        bar of tqdm, or is called with a label, the steps done, and all steps. Arguments left out are those of the scene. A negative
        `duration` goes backward in time.

        With `checkpoint`, a file, the run is saved there at every `checkpoint_every`-th step (a million, if not said) and after
        Ctrl-C, its nodes beside it. The same call goes on from there, to the same last bit; so does one with a longer duration.

        Raises `noslip.RequestError`; `noslip.RunError` where a step fails, with the run so far; `noslip.Interrupted`, a
        `KeyboardInterrupt` with the run so far, after Ctrl-C.
        """
        if every < 1:
            raise _noslip.RequestError(f"every = {every}: accepted are whole numbers from 1")
        backward = duration is not None and duration < 0.0
        if backward and t_eval is not None:
            raise _noslip.RequestError("t_eval: a run backward in time keeps nodes; leave t_eval out")
        checked = self._checked.with_settings(method, step, None if duration is None else abs(duration), alpha)
        if checkpoint is not None:
            if t_eval is not None:
                raise _noslip.RequestError("checkpoint: a run that is saved has no t_eval")
            settings = {
                "method": method,
                "step": step,
                "tolerance": tolerance,
                "duration": duration,
                "alpha": alpha,
                "every": every,
                "substep": substep,
                "checkpoint_every": checkpoint_every,
                "event": _list(events),
                "until": _list(until),
            }
            return saved_run(self.text, self.name, Path(checkpoint), settings, progress)
        times = _times(t_eval)
        with shown(progress) as tell:
            try:
                made = checked.run(every, times, tolerance, substep, _list(events), _list(until), backward, tell)
            except KeyboardInterrupt:
                raise Interrupted(None) from None
            except MemoryError as error:
                raise TooLargeError(*error.args) from None
        columns, units, text, failure, ended = made
        result = Run(columns, dict(units), text)
        if '"warnings"' in text:
            warn(result.object)
        if isinstance(ended, KeyboardInterrupt):
            raise Interrupted(result) from None
        if ended is not None:
            raise ended
        if failure is not None:
            raise RunError(failure, result)
        return result

    def varied(self, values: Mapping[str, float]) -> Scene:
        """The scene with other numbers, by their keys: `{"sleigh.mass": 2.0, "start.speed": 0.5}`.

        The numbers that `sensitivities` takes derivatives in go by their names alone too: `mass`, `x'`, or a parameter's.
        """
        numbers = [(key, float(value)) for key, value in values.items()]
        return Scene(self._checked.varied(self.text, self.origin, numbers), self.origin)

    def sensitivities(
        self,
        keys: str | Iterable[str] | Mapping[str, float],
        *,
        columns: Texts = None,
        t_eval: Iterable[float] | None = None,
        method: str | None = None,
        step: float | None = None,
        duration: float | None = None,
        alpha: float | None = None,
        progress: bool | Progress | None = None,
    ) -> Sensitivities:
        """The exact derivatives of a run in numbers of its start and in parameters, at the times `t_eval` or at its end.

        `keys` are numbers of the scene: of a sleigh `mass`, `inertia`, `offset`, `x`, `y`, `heading`, `speed` and
        `turn_rate`, of a `System` its parameters, coordinates and rates. With a dictionary the run is made at its values. Where a
        number of the start has to stay admissible, the derivative is that of the admissible start that is taken.

        `columns` are coordinates, velocities, `energy`, a sleigh's `center_x` and `center_y`, and the outputs of a `System`.

        The derivatives are those of the steps that the method makes, to round-off, not of the equations that it approximates. A
        method whose steps have none is refused with `noslip.RequestError`, which names those that have.
        """
        if isinstance(keys, Mapping):
            return self.varied(keys).sensitivities(
                list(keys),
                columns=columns,
                t_eval=t_eval,
                method=method,
                step=step,
                duration=duration,
                alpha=alpha,
                progress=progress,
            )
        checked = self._checked.with_settings(method, step, duration, alpha)
        times = _times(t_eval)
        asked = _list(keys)
        with shown(progress) as tell:
            told, t, values, jacobian = checked.sensitivities(asked, _list(columns), times, tell)
        return Sensitivities(asked, told, t, values, jacobian)

    def prediction(self, keys: str | Iterable[str], **settings: Any) -> Prediction:
        """Numbers of a run as a function of the scene's numbers with these keys, for `scipy.optimize`.

        Arguments besides are those of `sensitivities`.
        """
        asked = _list(keys)
        return Prediction(asked, lambda values: self.sensitivities(values, **settings))

    def compare(
        self, *, methods: Texts = None, progress: bool | Progress | None = None, **settings: Any
    ) -> dict[str, Any]:
        """Long-run constraint and energy, method by method: the object of `noslip compare --json`."""
        return self._command("compare", progress, settings, methods)

    def precision(
        self, *, methods: Texts = None, progress: bool | Progress | None = None, **settings: Any
    ) -> dict[str, Any]:
        """What accuracy costs in time: the object of `noslip precision --json`."""
        return self._command("precision", progress, settings, methods)

    def equilibria(self, *, progress: bool | Progress | None = None, **settings: Any) -> dict[str, Any]:
        """The steady motions and their stability: the object of `noslip equilibria --json`."""
        return self._command("equilibria", progress, settings)

    def lyapunov(self, *, progress: bool | Progress | None = None, **settings: Any) -> dict[str, Any]:
        """The Lyapunov exponents: the object of `noslip lyapunov --json`."""
        return self._command("lyapunov", progress, settings)

    def section(self, *, progress: bool | Progress | None = None, **settings: Any) -> dict[str, Any]:
        """Where motions cross a plane: the object of `noslip section --json`."""
        return self._command("section", progress, settings)

    def cost(self, *, progress: bool | Progress | None = None, **settings: Any) -> dict[str, Any]:
        """What each effect costs a step: the object of `noslip cost --json`."""
        return self._command("cost", progress, settings)

    def equations(self, **settings: Any) -> dict[str, Any]:
        """The reduced equations of motion of a system of text, as formulas: the object of `noslip equations --json`."""
        return self._command("equations", None, settings)

    def _command(
        self,
        command: str,
        progress: bool | Progress | None,
        settings: Mapping[str, Any],
        methods: Texts = None,
    ) -> dict[str, Any]:
        known = sorted({"progress", *_noslip.arguments(command)} - {"json"})
        for key in settings:
            if key not in known:
                raise ArgumentError(f"Scene.{command} has no argument {key!r}; its arguments are {', '.join(known)}")
        listed = _list(methods)
        chosen = [f"--methods={','.join(listed)}"] if listed else []
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / f"{self.name}.toml"
            file.write_text(self.text, encoding="utf-8")
            return call([command, str(file), "--json", *chosen, *flags(settings)], progress)
