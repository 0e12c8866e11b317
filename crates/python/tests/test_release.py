"""What a release carries of others: the licence of every package that is compiled into it."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.skipif(shutil.which("cargo") is None, reason="licences are found by cargo")
@pytest.mark.parametrize("package", ["noslip-cli", "noslip-python"])
def test_every_package_of_a_release_has_its_licence(package: str) -> None:
    told = subprocess.run([ROOT / ".ci/licences", package], capture_output=True, text=True, check=True).stdout
    tree = ["cargo", "tree", "--locked", "--edges=normal", "--prefix=none", "--format={p}", f"--package={package}"]
    listed = subprocess.run(tree, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    names = {tuple(line.split()[:2]) for line in listed.splitlines() if line}
    others = [f"{name} {version.removeprefix('v')}: " for name, version in names if not name.startswith("noslip")]
    assert len(others) > 50 and [name for name in others if f"\n{name}" not in told] == []
    # The font, and the licence that asks most: its notice has to go with every copy.
    assert "Bitstream Vera Fonts Copyright" in told and "Permission is hereby granted" in told
