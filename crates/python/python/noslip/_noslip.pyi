from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

class NoslipError(Exception): ...
class RequestError(NoslipError): ...
class ComputationError(NoslipError): ...

def bundled() -> list[tuple[str, str]]: ...
def methods() -> list[tuple[str, int, str, str]]: ...
def command(
    arguments: list[str], progress: Callable[[str, int, int], object] | None = None
) -> tuple[int, str, str, BaseException | None]: ...

class Scene:
    def __new__(
        cls,
        text: str,
        origin: str,
        method: str | None = None,
        step: float | None = None,
        duration: float | None = None,
        alpha: float | None = None,
    ) -> Scene: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def method(self) -> str: ...
    @property
    def step(self) -> float: ...
    @property
    def duration(self) -> float: ...
    @property
    def moved(self) -> list[tuple[str, float, float]]: ...
    def run(
        self,
        every: int,
        times: list[float],
        tolerance: float | None,
        substep: bool,
        events: list[str],
        until: list[str],
        progress: Callable[[str, int, int], object] | None,
    ) -> tuple[dict[str, NDArray[np.float64]], list[tuple[str, str]], str, str | None, BaseException | None]: ...
