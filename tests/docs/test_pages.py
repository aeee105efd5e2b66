"""What the pages tell a reader to type works: blocks of commands and Python are run, page by page, top to bottom.

Pages share this process, so that languages and arms are loaded once. See "Examples in the pages" in CONTRIBUTING.md.
"""

from __future__ import annotations

import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import click
import pytest

from rpl.cell import parse_cell
from rpl.cli.main import COMMANDS, rpl, run
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
NOT_RUN = "# (not run by the tests:"
# Blocks that install or run the tests themselves.
HOW_MANY_NOT_RUN = 5
# Languages of fenced blocks; the first two are run.
KNOWN = ("sh", "python", "rpl", "toml", "json", "csv", "text")
# As asked, or with what the exit status says: written with guarded stops, alike and not equal.
DONE = (0, 3)


@dataclass(frozen=True)
class Block:
    """One fenced block: its language, its text and the line that it begins at."""

    language: str
    text: str
    line: int

    @property
    def runs(self) -> bool:
        return self.language in ("sh", "python") and not self.text.startswith(NOT_RUN)

    @property
    def file(self) -> tuple[str, bool] | None:
        """The name of the file that it is, and whether it goes on with it."""
        found = re.match(r"(?:#|--) ([\w-]+\.\w+)(, continued)?(?::|$)", self.text.partition("\n")[0])
        return (found[1], bool(found[2])) if found else None


def blocks(page: Path) -> list[Block]:
    text = page.read_text("utf-8")
    found = re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return [Block(one[1], one[2], text.count("\n", 0, one.start()) + 1) for one in found]


WITH_COMMANDS = [page for page in PAGES if any(block.runs for block in blocks(page))]


class Input(io.TextIOWrapper):
    """Standard input of one command."""

    def __init__(self, text: str) -> None:
        super().__init__(io.BytesIO(text.encode()), encoding="utf-8")


def piped(commands: list[list[str]], statuses: tuple[int, ...] = DONE) -> str:
    """Commands of ours, each reading what the one before wrote, with one of these statuses; the last one's output."""
    text = ""
    for words in commands:
        out, err, before = io.StringIO(), io.StringIO(), sys.stdin
        sys.stdin = Input(text)
        try:
            with redirect_stdout(out), redirect_stderr(err):
                status = run(words[1:])
        finally:
            sys.stdin = before
        assert status in statuses, f"{shlex.join(words)} ends with {status}: {err.getvalue()}"
        text = out.getvalue()
    return text


@contextmanager
def in_background(words: list[str]) -> Iterator[None]:
    """A command that stands in for a controller (`&`), from when it is ready until the page ends."""
    process = subprocess.Popen([sys.executable, "-m", "rpl.cli.main", *words[1:]], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("{")
        yield
    finally:
        process.terminate()
        process.communicate(timeout=60)


def execute(line: str, page: ExitStack) -> None:
    """One line as a shell does it: commands of ours in this process, everything else by the shell. A remark `exits
    with N` at its end says which status it has."""
    words = shlex.split(line, comments=True)
    if words[-1:] == ["&"]:
        page.enter_context(in_background(words[:-1]))
        return
    if words[:1] == ["export"]:
        name, _, value = words[1].partition("=")
        page.enter_context(patch.dict(os.environ, {name: value}))
        return
    said = re.search(r"# exits with (\d)$", line)
    if not words:
        return
    target = None
    if ">" in words:
        at = words.index(">")
        target, words = Path(words[at + 1]), words[:at]
    commands: list[list[str]] = [[]]
    for word in words:
        if word == "|":
            commands.append([])
        else:
            commands[-1].append(word)
    if any(command[0] != "rpl" for command in commands):
        subprocess.run(["bash", "-ec", line], check=True, timeout=600, capture_output=True)
        return
    text = piped(commands, (int(said[1]),) if said else DONE)
    if target is not None:
        target.write_text(text, "utf-8")


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """A folder like a fresh checkout, with the samples in it."""
    shutil.copytree(ROOT / "samples", tmp_path / "samples")
    before = Path.cwd()
    os.chdir(tmp_path)
    yield tmp_path
    os.chdir(before)


@pytest.mark.parametrize("page", WITH_COMMANDS, ids=lambda page: page.stem)
def test_what_a_page_says_to_type_works(page: Path, folder: Path) -> None:
    with ExitStack() as stack:
        for block in blocks(page):
            if block.file is not None:
                name, goes_on = block.file
                text = (folder / name).read_text("utf-8") + block.text if goes_on else block.text
                (folder / name).write_text(text, "utf-8")
            elif block.runs and block.language == "python":
                with redirect_stdout(io.StringIO()):
                    exec(compile(block.text, f"{page.name}:{block.line}", "exec"), {"__name__": "__main__"})
            elif block.runs:
                for line in block.text.replace("\\\n", " ").splitlines():
                    execute(line, stack)


def test_blocks_that_are_not_run_say_so_and_are_few() -> None:
    marked = [f"{page.name}:{block.line}" for page in PAGES for block in blocks(page) if NOT_RUN in block.text]
    assert len(marked) == HOW_MANY_NOT_RUN, marked


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_stand_in_blocks_that_are_run(page: Path) -> None:
    """No command hides in an indented block, or in a fence of another kind."""
    outside = re.sub(r"^```.*?^```$", "", page.read_text("utf-8"), flags=re.DOTALL | re.MULTILINE)
    hidden = re.findall(r"^(?: {4}|\t)(?:\$ )?(?:rpl|pip|make|python\d?) .*", outside, re.MULTILINE)
    assert hidden == []
    unknown = [block.line for block in blocks(page) if block.language not in KNOWN]
    assert unknown == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_cell_files_of_the_pages_are_read(page: Path) -> None:
    for block in blocks(page):
        if block.language == "toml" and block.file is None:
            parse_cell(block.text, f"{page.name}:{block.line}")


def first_half() -> list[Block]:
    page = ROOT / "docs/rpl.md"
    text = page.read_text("utf-8")
    end = text.count("\n", 0, text.index("## How an RPL program behaves"))
    return [block for block in blocks(page) if block.language == "rpl" and block.line < end]


@pytest.mark.parametrize("block", first_half(), ids=lambda block: f"line {block.line}")
def test_the_programs_that_explain_rpl_run_to_their_end(block: Block) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("page.rpl", block.text)], "rpl", diagnostics)
    assert not diagnostics.has_errors
    result = run_program(read.program, "kuka_kr6r900sixx")
    assert result.status == "finished", result.fault


def options() -> set[str]:
    """Every long option of every command."""
    commands = [rpl.get_command(click.Context(rpl), name) for name in COMMANDS]
    given = [param for one in commands if one is not None for param in one.params]
    return {word for one in given for word in (*one.opts, *one.secondary_opts) if "--" in word}


def test_options_of_the_pages_exist_and_every_option_has_its_place() -> None:
    """Some belong to benchmarks (`--lines`, `--into`, `--csv`), some to Git."""
    texts = "\n".join(page.read_text("utf-8") for page in PAGES)
    told = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", texts))
    here = options()
    others = {"--lines", "--into", "--csv", "--global", "--ext-diff", "--no-ext-diff"}
    assert told - here - others == set()
    assert here - told == set()
