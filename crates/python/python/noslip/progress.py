"""Progress of long work: a callable, or a bar of tqdm."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = Callable[[str, int, int], object]


@contextmanager
def shown(progress: bool | Progress | None) -> Iterator[Progress | None]:
    """What is to be called: `True` stands for a bar of tqdm, and for nothing where tqdm is not installed."""
    if progress is not True:
        yield progress or None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        yield None
        return
    bar: Any = tqdm(leave=False)

    def tell(label: str, done: int, of: int) -> None:
        bar.set_description(label, refresh=False)
        bar.total = of
        bar.n = done
        bar.refresh()

    try:
        yield tell
    finally:
        bar.close()
