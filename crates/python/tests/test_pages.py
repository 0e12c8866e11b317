"""The blocks of Python in README and book: those of a page run one after the other."""

import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[3]
PAGES = ["README.md", "crates/python/README.md", *(str(page.relative_to(ROOT)) for page in sorted((ROOT / "docs").rglob("*.md")))]
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)

# What is not installed for tests: such a block is compiled only.
ELSEWHERE = ["import ray", "dask_jobqueue", *([] if find_spec("distributed") else ["dask.distributed"])]


def blocks(page: str) -> list[str]:
    return BLOCK.findall((ROOT / page).read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page)])
def test_the_blocks_of_a_page_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"__name__": "page"}
    for block in blocks(page):
        code = compile(block, page, "exec")
        if not any(word in block for word in ELSEWHERE):
            exec(code, names)
    pytest.importorskip("matplotlib.pyplot").close("all")


def test_there_are_blocks() -> None:
    assert sum(len(blocks(page)) for page in PAGES) > 6
