"""What all commands print the same way: JSON documents, diagnostics, options, and waiting on a terminal."""

from __future__ import annotations

import json
import math
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.core import ParameterSource

from rpl.cli.files import write_files
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.errors import UsageError
from rpl.grouping import told
from rpl.showing import printable, printable_lines
from rpl.source import LARGEST_FILE, Source, source_from_bytes
from rpl.tomlfile import FARTHEST

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.project import ReadProgram

Decorated = TypeVar("Decorated", bound=Callable[..., Any])
_PATIENCE_S = 0.7
STANDARD_INPUT = "-"
# JSON leaves these signs as they are: DEL, and the controls that terminals know besides those of ASCII.
_STEERING = {sign: f"\\u{sign:04x}" for sign in range(0x7F, 0xA0)}

_VERBOSE = "rpl.verbose"


def _keep_verbose(context: click.Context, option: click.Parameter, value: bool) -> None:
    context.meta[_VERBOSE] = value


json_option = click.option("--json", "as_json", is_flag=True, help="One JSON document on stdout and nothing else.")
from_option = click.option("--from", "dialect", metavar="D", help="Language of the source; else seen from its content.")
robot_option = click.option("--robot", metavar="R", help="Arm the program was written for: a name or a .toml file.")
accept_option = click.option("--accept", "accepted", multiple=True, metavar="CODE", help="Acknowledge a report's code.")
verbose_option = click.option(
    "--verbose", is_flag=True, expose_value=False, callback=_keep_verbose, help="Each report on a line of its own."
)
paths_argument = click.argument("paths", nargs=-1, required=True, metavar="PATH...")


def print_json(document: object) -> None:
    """One JSON document on one line. Numbers that JSON lacks become null."""
    click.echo(json_text(document))


def json_text(document: object) -> str:
    """The same as a text; signs that would steer a terminal are escaped in it."""
    return json.dumps(plain(document), ensure_ascii=False, allow_nan=False).translate(_STEERING)


def say(text: str = "", err: bool = False) -> None:
    """Lines for people. What programs, names and messages hold steers no terminal: it is shown as escapes."""
    click.echo(printable_lines(text), err=err)


def print_text(text: str) -> None:
    """The text of a file on stdout: as it is, but on a terminal without signs that would steer it."""
    click.echo(printable_lines(text) if sys.stdout.isatty() else text, nl=False, color=True)


def plain(value: object) -> object:
    """The value with tuples as lists and what JSON has no number for as null."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def print_diagnostics(items: Iterable[Diagnostic], least: Severity = Severity.INFO) -> None:
    """Reports on stderr from this severity on: one line per kind, the worst first; with --verbose one line each."""
    context = click.get_current_context(silent=True)
    verbose = context is not None and bool(context.meta.get(_VERBOSE))
    for text in told((item for item in items if item.severity >= least), verbose, followed_options()):
        click.echo(printable(" ".join(text.splitlines())), err=True)


def followed_options() -> frozenset[str]:
    """The options that the user gave: nobody is told to give them. An arm is the target's too."""
    context = click.get_current_context(silent=True)
    if context is None:
        return frozenset()
    given = {
        name
        for option in context.command.params
        if option.name is not None and context.get_parameter_source(option.name) == ParameterSource.COMMANDLINE
        for name in option.opts
    }
    return frozenset(given | ({"--to-robot"} if "--robot" in given else set()))


def collector(accepted: Sequence[str] = ()) -> Diagnostics:
    """A collector that has acknowledged these codes."""
    return Diagnostics(accepted=frozenset(accepted))


def robot_named(name: str | None) -> RobotModel | None:
    """The robot of that name. Raises UsageError when there is none."""
    if name is None:
        return None
    from rpl.emulator.model import load_robot

    return load_robot(name)


def arm_of(read: ReadProgram) -> str | None:
    """The robot file of the arm that the files of a backup name, which is said; None: they name none of ours."""
    from rpl.inventory.robots import arm_of as found_in

    found = found_in(read)
    if found is None:
        return None
    say(f"rpl: the arm is {found.robot}: {found.file} calls it {found.called}; --robot names another", err=True)
    return found.robot


def robots_exist(*names: str | None) -> None:
    """Arms are asked for before anything is read: what is unknown or not installed is said at once."""
    for name in names:
        robot_named(name)


def opened(paths: Sequence[str]) -> list[str | Source]:
    """The paths, `-` as what standard input gives. Raises UsageError when it is asked for twice."""
    if list(paths).count(STANDARD_INPUT) > 1:
        raise UsageError("- (standard input) can be given once only")
    return [_standard_input() if path == STANDARD_INPUT else path for path in paths]


def _standard_input() -> Source:
    data = sys.stdin.buffer.read(LARGEST_FILE + 1)
    if len(data) > LARGEST_FILE:
        raise UsageError(f"standard input is larger than {LARGEST_FILE // 2**20} MiB")
    return source_from_bytes("stdin", data)


def read_paths(paths: Sequence[str], dialect: str | None, diagnostics: Diagnostics) -> ReadProgram:
    """The program in these paths (`-`: standard input). Raises UsageError, behind the reports, when there is none."""
    from rpl.project import read_program

    language = dialect_exists(dialect)
    with waiting("reading"):
        read = read_program(opened(paths), language, diagnostics)
    if not read.files:
        print_diagnostics(diagnostics)
        raise UsageError("no robot program was found; name the language with --from if there is one")
    return read


def dialect_exists(name: str | None) -> str | None:
    """The name of the dialect that this word asks for. Raises UsageError when there is none."""
    from rpl import registry

    return registry.dialect_called(name).name if name is not None else None


def numbers(text: str, what: str, count: int | None = None) -> list[float]:
    """Numbers separated by commas or blanks. Raises UsageError that names what is wrong."""
    values = []
    for part in text.replace(",", " ").split():
        try:
            value = float(part)
        except ValueError:
            raise UsageError(f"{what}: {part!r} is not a number; write them like 0,-90,90,0,0,0") from None
        if not math.isfinite(value):
            raise UsageError(f"{what}: {part!r} is not a finite number")
        if abs(value) > FARTHEST:
            raise UsageError(f"{what}: {part!r} is beyond {FARTHEST:,.0f}")
        values.append(value)
    if count is not None and len(values) != count:
        raise UsageError(f"{what}: {count} numbers are needed, {len(values)} are given")
    return values


def write_file(path: Path, data: bytes) -> None:
    """Write a file and the folders above it, whole or not at all. Raises UsageError when it is somebody else's (see
    rpl.cli.files), or when the system refuses."""
    write_files({path: data})


@contextmanager
def waiting(text: str) -> Iterator[None]:
    """Shows on a terminal, after a moment, that work goes on. Elsewhere it costs and prints nothing. Ctrl-C tells
    which work it ended."""
    try:
        with _shown(text):
            yield
    except KeyboardInterrupt as stopped:
        stopped.add_note(f"while {text}")
        raise


@contextmanager
def _shown(text: str) -> Iterator[None]:
    if not sys.stderr.isatty():
        yield
        return
    done = threading.Event()
    thread = threading.Thread(target=_show, args=(text, done), daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


def _show(text: str, done: threading.Event) -> None:
    if done.wait(_PATIENCE_S):
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        progress.add_task(text, total=None)
        done.wait()


@contextmanager
def counting(text: str, total: int) -> Iterator[Callable[[int, str], None]]:
    """Shows on a terminal how many of `total` are done, as the given function is told, with a word about the last."""
    if not sys.stderr.isatty():
        yield lambda done, last: None
        return
    from rich.console import Console
    from rich.markup import escape
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        shown = progress.add_task(text, total=total)

        def tell(done: int, last: str) -> None:
            progress.update(shown, completed=done, description=f"{text} {escape(printable(last))}")

        yield tell
