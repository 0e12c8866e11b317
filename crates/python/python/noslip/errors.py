"""Exceptions that carry what a program needs to act on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._noslip import ComputationError, RequestError

if TYPE_CHECKING:
    from .results import Run


class ArgumentError(RequestError, TypeError):
    """An argument that there is not, or of another kind than those that are accepted."""


class TooLargeError(RequestError, MemoryError):
    """More than fits into memory; nothing of the memory has been taken."""


class RunError(ComputationError):
    """A run that failed, with all that was made before.

    `step` is the number of the step that failed, `time` its start in s, `reason` and `hint` are texts, `corrections` the
    norms of the corrections of Newton's method in that step, and `result` is the run up to the last good node.
    """

    def __init__(self, message: str, result: Run) -> None:
        super().__init__(message)
        self.result = result
        failure: dict[str, Any] = result.object.get("failure") or {}
        self.step: int | None = failure.get("step")
        self.time: float | None = failure.get("time")
        self.reason: str = failure.get("reason") or message
        self.hint: str | None = failure.get("hint")
        self.corrections: list[float] = failure.get("corrections") or []

    def __reduce__(self) -> tuple[Any, ...]:
        return RunError, (str(self), self.result)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C; `result` is what was done until then."""

    def __init__(self, result: object) -> None:
        super().__init__("interrupted; `result` has what was done")
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        return Interrupted, (self.result,)
