"""The built wheel holds what the source tree holds: a folder without `__init__.py` would be missing in silence."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = {"rpl": "rpl", "dialects": "rpl/dialects", "postprocessors": "rpl/postprocessors", "grammars": "rpl/grammars"}
IGNORED = shutil.ignore_patterns("__pycache__", "*.egg-info")


@pytest.fixture(scope="module")
def wheel_names(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    tree = tmp_path_factory.mktemp("tree")
    for room in ROOMS:
        shutil.copytree(ROOT / room, tree / room, ignore=IGNORED)
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tree / name)
    # No isolated environment: the test must not need the network.
    command = [sys.executable, "-c", "import setuptools.build_meta as b; print(b.build_wheel('dist'))"]
    done = subprocess.run(command, cwd=tree, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": ""})
    assert done.returncode == 0, done.stderr
    (wheel,) = (tree / "dist").glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        return set(archive.namelist())


def packaged_files() -> list[tuple[str, str]]:
    found = []
    for room, inside in ROOMS.items():
        for path in sorted((ROOT / room).rglob("*")):
            parts = path.relative_to(ROOT / room).parts
            if path.is_file() and "__pycache__" not in parts and path.suffix != ".pyc":
                found.append((str(path.relative_to(ROOT)), "/".join((inside, *parts))))
    return found


def test_every_file_of_the_rooms_is_in_the_wheel(wheel_names: set[str]) -> None:
    missing = [source for source, inside in packaged_files() if inside not in wheel_names]
    assert not missing


def test_the_wheel_adds_one_package_only(wheel_names: set[str]) -> None:
    tops = {name.split("/")[0] for name in wheel_names}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"rpl"}


def test_every_folder_with_code_is_a_package() -> None:
    for room in ROOMS:
        for path in (ROOT / room).rglob("*.py"):
            assert (path.parent / "__init__.py").is_file(), f"{path.parent} has no __init__.py"


@pytest.mark.parametrize("room", ["dialects", "postprocessors"])
def test_every_language_folder_has_its_record(room: str) -> None:
    record = {"dialects": "DIALECT", "postprocessors": "TARGET"}[room]
    for folder in sorted((ROOT / room).iterdir()):
        if folder.is_dir() and folder.name != "__pycache__":
            assert record in (folder / "__init__.py").read_text("utf-8"), folder
