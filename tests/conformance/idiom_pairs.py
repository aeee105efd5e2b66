"""Tasks that samples hold in six languages by hand: what a translation of one version is beside the written one.

    python tests/conformance/idiom_pairs.py         compares with `idiom_pairs.json`, exit status 1 where worse
    python tests/conformance/idiom_pairs.py write   writes it anew
    ... [words of task names] [from:LANGUAGE] [to:TARGET]     some pairs only

Figures of a pair: `length`, code lines of the translation / those of the version by hand (as benchmarks/output_text.py
counts them: no comments, no data). `shown`, the same as a programmer sees them: an inline form of KRL, several lines of
text, is one line on the pendant. `moves`, `points`, `frames`: how many more (or fewer, negative) moves, taught points
and frames the translation declares than the version by hand. `comments`: the share of the source's comments whose
words stand in the translation's comments.
"""

from __future__ import annotations

import json
import re
import sys
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path, PurePosixPath

from written import ROOT, Project, projects

from rpl import ir
from rpl.cell import Cell, read_cell
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.project import ReadProgram, read_program, read_sources
from rpl.source import Source, source_from_bytes
from rpl.translation import translate_program

sys.path.append(str(ROOT / "benchmarks"))

from output_text import LAYOUTS, lines_of

FILE = Path(__file__).parent / "idiom_pairs.json"
LANGUAGES = ("krl", "rapid", "tp", "inform", "urscript", "vplus")
TASKS = ("carton_stacking", "lathe_tending", "gauge_sorting", "press_loading")
_COMMENT = {
    "krl": r";(?!\s*(?:END)?FOLD)",
    "rapid": r"[^!\"]*!",
    "tp": r"\d+:\s*!",
    "inform": "'",
    "urscript": "#",
    "vplus": r"(?:\.PROGRAM[^;]*)?;",
}
_FORM, _FOLD, _ENDFOLD = (re.compile(rf"\s*;{word}", re.IGNORECASE) for word in (r"FOLD\b.*;%\{", "FOLD", "ENDFOLD"))
_POINTS = (ir.PoseType, ir.TargetType, ir.JointsType)

Figures = dict[str, float]
Table = dict[str, dict[str, Figures]]  # task -> "krl -> rapid" -> figures


@cache
def version(task: str, language: str) -> tuple[Project, ReadProgram, Cell]:
    """One version by hand, with its surroundings."""
    project = projects()[f"samples/{language}/{task}"]
    cell = read_cell(str(project.cell)) if project.cell is not None else Cell()
    return project, read_program([project.folder], None, Diagnostics()), cell


def entry_of(project: Project) -> str:
    """The routine that a version begins with."""
    return str(tomllib.loads((project.folder / "expected.toml").read_text("utf-8"))["entry"])


def figures(task: str, source: str, target: str) -> Figures:
    """The figures of one pair."""
    project, read, cell = version(task, source)
    written = translate_program(read, target, project.robot, None, Diagnostics(), given=cell.variables)
    suffixes = LAYOUTS[target].suffixes
    files = [file for file in written.files if PurePosixPath(file.path).suffix.lower() in suffixes]
    sources = [source_from_bytes(file.path, file.data) for file in files]
    theirs = read_sources(sources, target, Diagnostics()).program
    by_hand = version(task, target)[1]
    differences = zip(_counts(theirs), _counts(by_hand.program), strict=True)
    moves, points, frames = (float(one - other) for one, other in differences)
    length = _code(target, sources) / _code(target, by_hand.sources)
    shown = _code(target, _as_shown(target, sources)) / _code(target, _as_shown(target, by_hand.sources))
    kept = _comments(target, sources)
    own = _comments(source, read.sources)
    found = sum(one in "".join(kept) for one in own)
    return {
        "length": round(length, 2),
        "shown": round(shown, 2),
        "moves": moves,
        "points": points,
        "frames": frames,
        "comments": round(found / max(len(own), 1), 2),
    }


def _code(language: str, sources: Iterable[Source]) -> int:
    found = (lines_of(language, one.path, one.text) for one in sources)
    return sum(len(lines.code) for lines in found if lines is not None)


def _as_shown(language: str, sources: Iterable[Source]) -> list[Source]:
    """The files with one line for each inline form."""
    if language != "krl":
        return list(sources)
    return [replace(one, text="\n".join(_closed(one.text.splitlines()))) for one in sources]


def _closed(lines: list[str]) -> Iterator[str]:
    """The lines with the folds of inline forms closed: what stands on the fold's line is an instruction."""
    inside = 0
    for line in lines:
        if inside:
            inside += bool(_FOLD.match(line)) - bool(_ENDFOLD.match(line))
        elif _FORM.match(line):
            inside = 1
            yield line.partition(";FOLD")[2].partition(";")[0]
        else:
            yield line


def _counts(program: ir.Program) -> tuple[int, int, int]:
    """Moves; points with values that moves name; frames with values that are no such points."""
    moves = [node for node in walk(program) if isinstance(node, ir.Move)]
    named = {one.id.lower() for move in moves for one in walk(move.target, move.via) if isinstance(one, ir.Name)}
    points = frames = 0
    for module in program.modules:
        declared = [*module.declarations, *(one for routine in module.routines for one in routine.declarations)]
        for one in declared:
            if isinstance(one, ir.Variable) and one.initial is not None and isinstance(one.type, _POINTS):
                points += one.name.lower() in named
                frames += one.name.lower() not in named
            elif isinstance(one, ir.Variable) and isinstance(one.type, ir.ToolType | ir.WorkObjectType):
                frames += one.initial is not None
    return len(moves), points, frames


def _comments(language: str, sources: tuple[Source, ...] | list[Source]) -> list[str]:
    """The comments on lines of their own (or behind the head of a routine), each by its letters and digits."""
    begins = re.compile(rf"\s*{_COMMENT[language]}\s*(.*)")
    suffixes = LAYOUTS[language].suffixes
    texts = [one.text for one in sources if PurePosixPath(one.path).suffix.lower() in suffixes]
    found = [match[1] for text in texts for line in text.splitlines() if (match := begins.match(line))]
    return [word for one in found if (word := re.sub(r"[^a-z0-9]", "", one.lower()))]


def worse(old: Figures, new: Figures) -> list[str]:
    """In which figures a pair is worse than recorded: fewer comments, moves and points further from those by hand, or
    more than 2 % longer. Frames are told, but what stands for one differs too much between brands to be held."""
    found = [name for name in ("moves", "points") if abs(new[name]) > abs(old[name])]
    found += [name for name in ("length", "shown") if new[name] > old[name] * 1.02]
    if new["comments"] < old["comments"] - 0.005:
        found.append("comments")
    return [f"{name} {old[name]:g} -> {new[name]:g}" for name in sorted(found)]


def recorded() -> Table:
    found: Table = json.loads(FILE.read_text("utf-8")) if FILE.exists() else {}
    return found


def main(words: list[str]) -> int:
    sources = [word[5:] for word in words if word.startswith("from:")] or list(LANGUAGES)
    targets = [word[3:] for word in words if word.startswith("to:")] or list(LANGUAGES)
    wanted = [word for word in words if word != "write" and ":" not in word]
    table, status = recorded(), 0
    for task in (one for one in TASKS if not wanted or any(word in one for word in wanted)):
        for source, target in ((a, b) for a in sources for b in targets if a != b):
            pair, found = f"{source} -> {target}", figures(task, source, target)
            known = table.setdefault(task, {}).get(pair)
            told = worse(known, found) if known is not None else ["not in the table"]
            status |= bool(told)
            shown = "  ".join(f"{name} {value:g}" for name, value in found.items())
            print(f"{task:16} {pair:20} {shown}  {'; '.join(told)}", flush=True)
            table[task][pair] = found
    if "write" in words:
        FILE.write_text(json.dumps(table, indent=1, sort_keys=True) + "\n", "utf-8")
        return 0
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
