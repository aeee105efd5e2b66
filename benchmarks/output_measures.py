"""How much translated programs look like what a programmer of the target writes: lines, names and reports, measured.

    python benchmarks/output_measures.py FOLDER... [--to TARGET...] [--limit SECONDS] [--robot R]
                                           [--json] [--markdown] [--helpers]
                                           [--into PAGE]

A program is a file with its data list; a folder with an `expected.toml` or a VAL3 project is one program. Each is
written in every other language (there) and what was written is read and written in its own language again (back), for
one arm, which also runs the result. What is counted, per program and target:

came back    share of the source's code lines that stand in what came back, as a text, each as often as it does there.
             Layout, capitals (where the language folds them), comments, names beside numbers (`R[1:count]`), zeros
             behind a number and digits behind its third place do not count; nor do data (declarations, lists of points,
             constants stored at the head of a UR program). Numbers of points and registers do.
growth       lines of code and of data that came back / those of the source. Comments and side files do not count.
helpers      names that what was written declares, a move of the source: neither words of the source, nor recorded for
             one (`Translation.renamed`, `registers`), nor the controller's own. Programs without a move are left out.
code         code lines of all program files written / code lines of the source, data apart.
points       taught points (data or numbered points with constant values that a move goes to) of what was written / of
             the source; at most 1.
rules        rules of the target's loader (docs/loading.md) that what was written breaks, each rule once.
reports      reports of the translation there (errors, losses, warnings) / different kinds of them.
seconds      time of the translation there.

--into writes the table, without seconds, between the two marks of a page (docs/output.md).

A program that fails or takes longer than the limit is a row with its reason. Nothing can be won by moving code
elsewhere: a line in a comment, a data list or a side file is one that does not come back, and a program file that is
written beside counts like any other.
"""

from __future__ import annotations

import argparse
import json
import signal
import statistics
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import FrameType

from output_names import family, helper_names
from output_text import LAYOUTS, Lines, lines_of

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import RplError
from rpl.ir.walk import walk
from rpl.project import ReadProgram, check_loading, read_program, read_sources
from rpl.source import source_from_bytes
from rpl.translation import translate_program

# The arm of each language's maker that its programs are measured with.
ARMS = {
    "krl": "kuka_kr10r1100sixx",
    "rapid": "abb_irb1200_5_90",
    "tp": "fanuc_m10ia",
    "inform": "motoman_gp12",
    "urscript": "ur10e",
    "vplus": "adept_viper_s850",
    "val3": "staubli_tx2_60",
    "rpl": "kuka_kr10r1100sixx",
}
_VALUES = (".va", ".cnd")  # values that a controller keeps: read with the program, no lines of it
_LARGEST = 500_000
_WORST = 5
_BEGIN, _END = "<!-- measured -->", "<!-- measured until here -->"
_TOLD = (Severity.ERROR, Severity.LOSS, Severity.WARNING)
_POINTS = (ir.PoseType, ir.TargetType, ir.JointsType)


class OutOfTimeError(RplError):
    """A program took longer than the limit."""


@dataclass(frozen=True, slots=True)
class Row:
    """One program into one target. A figure is None where it makes no sense (no moves, no code, failed)."""

    program: str
    source: str
    target: str
    failed: str = ""
    came_back: float | None = None
    growth: float | None = None
    helpers: float | None = None
    code: float | None = None
    points: float | None = None
    rules: float | None = None
    reports: float | None = None
    seconds: float | None = None
    names: tuple[str, ...] = ()
    broken: tuple[str, ...] = ()
    lost: tuple[str, ...] = field(default=())


# name of the field, its heading, whether more is better
FIGURES = (
    ("came_back", "came back", True),
    ("growth", "growth", False),
    ("helpers", "helpers a move", False),
    ("code", "code out/in", False),
    ("points", "points kept", True),
    ("rules", "rules broken", False),
    ("reports", "reports a kind", False),
    ("seconds", "seconds", False),
)


def programs(folders: Sequence[Path]) -> Iterator[Path]:
    """The programs in the folders: projects whole, other files one by one. A data list comes with its program."""
    for folder in folders:
        if not folder.is_dir() or _is_project(folder):
            yield folder
            continue
        inside = sorted(folder.iterdir())
        yield from programs([one for one in inside if one.is_dir() and not one.name.startswith(".")])
        files = [one for one in inside if one.suffix.lower() in _SUFFIXES and one.stat().st_size <= _LARGEST]
        yield from (one for one in files if not (one.suffix.lower() == ".dat" and _has_program(one)))


_BESIDE = frozenset((".dtx", ".lc", ".re", ".st"))
_SUFFIXES = frozenset(suffix for layout in LAYOUTS.values() for suffix in layout.suffixes) - _BESIDE


def _is_project(folder: Path) -> bool:
    return (folder / "expected.toml").exists() or any(folder.glob("*.pjx"))


def _has_program(data: Path) -> bool:
    return any(data.with_suffix(suffix).exists() for suffix in (".src", ".SRC", ".sub", ".SUB"))


def measured(path: Path, targets: Sequence[str], robot: str | None, limit: float) -> list[Row]:
    """The rows of one program; none for what is no program of any language."""
    signal.signal(signal.SIGALRM, _stop)
    shown = "/".join(path.parts[-3:])
    signal.setitimer(signal.ITIMER_REAL, limit)
    try:
        read = read_program([path], None, Diagnostics())
    except (RplError, RecursionError) as error:
        return [Row(shown, "?", "?", f"not read: {error}"[:120])]
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    if not read.files or not any(module.routines for module in read.reduced.modules):
        return []
    source = read.dialects[0]
    return [_limited(shown, read, target, robot or ARMS[source], limit) for target in targets if target != source]


def _stop(_number: int, _frame: FrameType | None) -> None:
    raise OutOfTimeError("took too long")


def _limited(shown: str, read: ReadProgram, target: str, robot: str, limit: float) -> Row:
    source = read.dialects[0]
    signal.setitimer(signal.ITIMER_REAL, limit)
    try:
        return _row(shown, read, target, robot)
    except Exception as error:  # noqa: BLE001 (whatever a program brings about is a row, not the end of the run)
        return Row(shown, source, target, f"{type(error).__name__}: {error}"[:160])
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def _is_read(target: str, path: str, text: str) -> bool:
    return lines_of(target, path, text) is not None or path.lower().endswith(_VALUES)


def _row(shown: str, read: ReadProgram, target: str, robot: str) -> Row:
    source, diagnostics = read.dialects[0], Diagnostics()
    began = time.perf_counter()
    there = translate_program(read, target, robot, None, diagnostics)
    seconds = time.perf_counter() - began
    sources = [source_from_bytes(file.path, file.data) for file in there.files]
    program = [one for one in sources if _is_read(target, one.path, one.text)]
    again = read_sources(program, target, Diagnostics())
    back = translate_program(again, source, robot, None, Diagnostics())
    before = _lines(source, [(one.path, one.text) for one in read.sources])
    after = _lines(source, [(file.path, source_from_bytes(file.path, file.data).text) for file in back.files])
    between = _lines(target, [(one.path, one.text) for one in sources])
    names = helper_names(read, there, again, target)
    broken = _broken(again)
    moves = _moves(read.program)
    told = [item.code.name for item in diagnostics if item.severity in _TOLD]
    here, kept = Counter(before.code), Counter(after.code)
    points = len(_taught(read.program))
    return Row(
        shown,
        source,
        target,
        came_back=_share((here & kept).total(), len(before.code)),
        growth=_share(len(after.code) + len(after.data), len(before.code) + len(before.data)),
        helpers=_share(len(names), moves),
        code=_share(len(between.code), len(before.code)),
        points=_share(min(points, len(_taught(again.program))), points),
        rules=len(broken),
        reports=_share(len(told), len(set(told))),
        seconds=seconds,
        names=tuple(names),
        broken=broken,
        lost=tuple((here - kept).elements())[:40],
    )


def _broken(written: ReadProgram) -> tuple[str, ...]:
    """The loading rules that what was written breaks."""
    found = Diagnostics()
    check_loading(written, found)
    return tuple(sorted({item.code.name for item in found}))


def _share(part: float, whole: float) -> float | None:
    return part / whole if whole else None


def _lines(language: str, files: Sequence[tuple[str, str]]) -> Lines:
    found = [lines for path, text in files if (lines := lines_of(language, path, text)) is not None]
    code = tuple(line for one in found for line in one.code)
    return Lines(code, tuple(line for one in found for line in one.data))


def _moves(program: ir.Program) -> int:
    return sum(isinstance(node, ir.Move) for node in walk(program))


def _taught(program: ir.Program) -> set[tuple[str, str]]:
    """Data that moves go to, by (routine or module, name), where it is declared with a value that is no calculation."""
    found: set[tuple[str, str]] = set()
    for module in program.modules:
        shared = _points(module.declarations)
        for routine in module.routines:
            own = _points(routine.declarations)
            for node in walk(routine):
                if isinstance(node, ir.Move):
                    used = {one.id.lower() for one in walk(node.target, node.via) if isinstance(one, ir.Name)}
                    found |= {(routine.name.lower(), name) for name in used & own}
                    found |= {(module.name.lower(), name) for name in used & shared - own}
    return found


def _points(declarations: Sequence[ir.Declaration]) -> set[str]:
    found = (one for one in declarations if isinstance(one, ir.Variable) and isinstance(one.type, _POINTS))
    return {one.name.lower() for one in found if one.initial is not None}


def run(paths: Sequence[Path], targets: Sequence[str], robot: str | None, limit: float) -> list[Row]:
    """All rows, in the order of the programs; two processes, with a line of progress on a terminal."""
    rows: dict[int, list[Row]] = {}
    with ProcessPoolExecutor(2) as pool:
        jobs = {pool.submit(measured, path, targets, robot, limit): at for at, path in enumerate(paths)}
        for done, job in enumerate(as_completed(jobs), 1):
            rows[jobs[job]] = job.result()
            if sys.stderr.isatty():
                print(f"\r{done} of {len(jobs)} programs, {paths[jobs[job]]}"[:110].ljust(110), end="", file=sys.stderr)
    return [row for at in sorted(rows) for row in rows[at]]


def summary(rows: Sequence[Row], figure: str) -> tuple[float, float, int] | None:
    """Median, mean and how many rows have the figure."""
    values = [value for row in rows if (value := getattr(row, figure)) is not None]
    return (statistics.median(values), statistics.fmean(values), len(values)) if values else None


def table(rows: Sequence[Row], figures: Sequence[tuple[str, str, bool]] = FIGURES) -> list[str]:
    """Markdown: one line for each source and target, then all together. A figure is `median; mean`."""
    heads = ["from", "to", "programs", *(title for _, title, _ in figures)]
    lines = [f"| {' | '.join(heads)} |", "|---|---|" + "---:|" * (len(heads) - 2)]
    pairs = sorted({(row.source, row.target) for row in rows})
    for source, target in [*pairs, ("all", "all")]:
        own = [row for row in rows if source == "all" or (row.source, row.target) == (source, target)]
        cells = [_cell(summary(own, name)) for name, _, _ in figures]
        failed = sum(bool(row.failed) for row in own)
        count = f"{len(own)}" + (f" ({failed} failed)" if failed else "")
        lines.append(f"| {source} | {target} | {count} | {' | '.join(cells)} |")
    return lines


def _cell(found: tuple[float, float, int] | None) -> str:
    return "-" if found is None else f"{found[0]:.2f}; {found[1]:.2f}"


def helpers(rows: Sequence[Row], most: int = 20) -> list[str]:
    """The most frequent helper names by source and target, numbers apart, with how many programs have them."""
    lines = []
    for source, target in sorted({(row.source, row.target) for row in rows}):
        counts: Counter[str] = Counter()
        spread: Counter[str] = Counter()
        for row in rows:
            if (row.source, row.target) == (source, target):
                counts.update(map(family, row.names))
                spread.update(set(map(family, row.names)))
        named = ", ".join(f"{name} {times} ({spread[name]})" for name, times in counts.most_common(most))
        if named:
            lines.append(f"{source} -> {target}: {named}")
    return lines


def worst(rows: Sequence[Row]) -> list[str]:
    """The programs with the worst figure of each kind, and those that failed."""
    lines = []
    for name, title, more in FIGURES:
        having = [(value, row) for row in rows if (value := getattr(row, name)) is not None]
        having.sort(key=lambda one: one[0], reverse=not more)
        for value, row in having[:_WORST]:
            lines.append(f"{title} {value:.2f}: {row.program} ({row.source} -> {row.target})")
    lines += [f"{', '.join(row.broken)}: {row.program} ({row.source} -> {row.target})" for row in rows if row.broken]
    lines += [f"failed: {row.program} ({row.source} -> {row.target}): {row.failed}" for row in rows if row.failed]
    return lines


def put_into(page: Path, rows: Sequence[Row]) -> None:
    """The table between the marks of a page. Figures that change with the machine's load stay out."""
    before, begin, rest = page.read_text("utf-8").partition(_BEGIN)
    _, end, after = rest.partition(_END)
    if not end:
        raise SystemExit(f"{page} has not the marks {_BEGIN} and {_END}")
    shown = "\n".join(table(rows, [one for one in FIGURES if one[0] != "seconds"]))
    page.write_text(f"{before}{begin}\n\n{shown}\n\n{end}{after}", "utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--to", nargs="+", choices=registry.target_names(), default=list(registry.target_names()))
    parser.add_argument("--robot", help="arm for all programs; else one of each language's maker")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for one program into one target")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--markdown", action="store_true", help="the table alone")
    parser.add_argument("--helpers", action="store_true", help="also the most frequent helper names")
    parser.add_argument("--into", type=Path, metavar="PAGE", help="also put the table between the marks of this page")
    options = parser.parse_args()
    rows = run(list(programs(options.folders)), options.to, options.robot, options.limit)
    if options.into is not None:
        put_into(options.into, rows)
    if options.json:
        print(json.dumps([asdict(row) for row in rows], indent=1))
        return
    print(*table(rows), sep="\n")
    if options.helpers:
        print("", *helpers(rows), sep="\n")
    if not options.markdown:
        print("", *worst(rows), sep="\n")


if __name__ == "__main__":
    main()
