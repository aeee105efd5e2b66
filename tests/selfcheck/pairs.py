"""The self-checking projects of this folder in every language: which expectations still hold after translation.

    python tests/selfcheck/pairs.py [words of project names] [to:target ...]

Each expectation of a project is a digital output that is on at the end. A guarded stop in what was written would hide
all that follows it, so the run here goes on behind the stops: one refused construct costs its own expectation only.
Without words the whole table is made and written to `pairs.json` beside this file, which the tests compare; with the
word `write` the rows of the pairs that were run are put into it.
"""

from __future__ import annotations

import dataclasses
import json
import re
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from rpl import ir, registry
from rpl.cell import Cell, read_cell
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.errors import RplError
from rpl.ir.walk import rewrite
from rpl.passes.legality import LEFT_OVER
from rpl.project import ReadProgram, read_program, read_sources
from rpl.proof.record import signal_names
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.runtime.trace import RunResult
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes
from rpl.translation import translate_program

HERE = Path(__file__).parent
FILE = HERE / "pairs.json"
KUKA, ABB, FANUC = "kuka_kr6r900sixx", "abb_irb1200_5_90", "fanuc_lrmate200id"
# The times that the expectations name were worked out with constant accelerations, the same for every language.
DRIVEN = "plain"
LIMIT_S = 250.0  # simulated; the longest project ends after 168 s
UR, VIPER, YASKAWA = "ur5e", "adept_viper_s650", "motoman_gp7"


@dataclass(frozen=True)
class Project:
    """A folder of this folder: the arm it was written for, how many expectations it has, and its first routine."""

    robot: str
    count: int
    entry: str | None = None


PROJECTS = {
    "krl_logic": Project(KUKA, 20, "LOGIC"),
    "krl_cell": Project(KUKA, 21, "CELL"),
    "krl_forms": Project(KUKA, 10, "Forms"),
    "krl_more_recipe": Project(KUKA, 24, "RECIPE"),
    "krl_more_process": Project(KUKA, 20, "PROCESS"),
    "rapid_more_frames": Project(ABB, 23),
    "rapid_more_process": Project(ABB, 21),
    "rapid_logic": Project(ABB, 22),
    "rapid_cell": Project(ABB, 21),
    "tp_logic": Project(FANUC, 17, "LOGIC"),
    "tp_cell": Project(FANUC, 17, "STATION"),
    "urscript_logic": Project(UR, 16),
    "urscript_cell": Project(UR, 16),
    "vplus_logic": Project(VIPER, 18, "logic"),
    "vplus_cell": Project(VIPER, 20, "cell"),
    "inform_logic": Project(YASKAWA, 15, "LOGIC"),
    "inform_cell": Project(YASKAWA, 14, "STATION"),
    "tp_forms": Project(FANUC, 10, "CELLMAIN"),
    "rpl_logic": Project(KUKA, 20),
    "rpl_cell": Project(KUKA, 19),
    "urscript_more_frames": Project(UR, 16),
    "urscript_more_backup": Project(UR, 16),
    "vplus_more_station": Project(VIPER, 20, "station"),
    "vplus_more_backup": Project("adept_cobra_s600", 18, "main"),
    "tp_more_frames": Project(FANUC, 20, "FRAMES"),
    "tp_more_backup": Project(FANUC, 18, "FOLGE1"),
    "inform_more_frames": Project(YASKAWA, 19),
    "inform_more_backup": Project("motoman_mh24", 17, "MASTER"),
    "krl_more_rims": Project(KUKA, 20, "RIMTEST"),
    "rapid_more_gauging": Project(ABB, 20),
    "rapid_more_dosing": Project(ABB, 20),
    "tp_more_gauging": Project(FANUC, 20, "FATMAIN"),
    "urscript_more_bolting": Project(UR, 16),
    "urscript_more_washing": Project(UR, 16),
    "vplus_more_bench": Project(VIPER, 20, "bench"),
    "inform_more_deburring": Project("motoman_mh24", 20, "DEBURR"),
    "rpl_more_grinding": Project(KUKA, 20),
    "krl_more_gearbox": Project(KUKA, 20, "GEARCELL"),
    "rapid_more_bonding": Project(ABB, 18),
    "tp_more_packing": Project(FANUC, 20, "PACKER"),
    "urscript_more_screws": Project(UR, 16),
    "vplus_more_sorting": Project(VIPER, 20, "sort.cell"),
    "inform_more_lathe": Project(YASKAWA, 20, "LATHECEL"),
    "rpl_more_foundry": Project("kuka_kr16_2", 20),
    "krl_more_glazing": Project(KUKA, 16, "GLAZING"),
    "rapid_more_castings": Project(ABB, 16),
    "tp_more_bending": Project(FANUC, 16, "BRAKECEL"),
    "urscript_more_pallets": Project(UR, 16),
    "vplus_more_boards": Project(VIPER, 16, "boards"),
    "inform_more_bags": Project(YASKAWA, 16, "BAGMAIN"),
    "rpl_more_measuring": Project(KUKA, 16),
    "rapid_more_coating": Project(ABB, 20),
    "krl_more_sealing": Project(KUKA, 18, "SEALING"),
    "krl_more_press": Project(KUKA, 18, "PRESS"),
    "krl_more_tray": Project(KUKA, 20, "TRAY"),
    "rapid_more_kits": Project(ABB, 22),
    "rapid_more_watch": Project(ABB, 18),
    "rapid_more_shift": Project(ABB, 18),
    "krl_more_shift": Project(KUKA, 18, "SHIFT"),
    "urscript_more_gluing": Project(UR, 16),
    "urscript_more_probing": Project(UR, 16),
    "urscript_more_kitting": Project(UR, 16),
    "vplus_more_dosing": Project(VIPER, 20, "dosing"),
    "vplus_more_fixtures": Project(VIPER, 20, "fixtures"),
    "vplus_more_crates": Project(VIPER, 20, "crates"),
}
TARGETS = list(registry.target_names())


@dataclass(frozen=True)
class Pair:
    """What came of a project in a target. `missed`: expectations that do not hold, the run going on behind guarded
    stops. `losses`: code and reason of each. `end`: how the run ended; `error` when nothing could be run.
    `unexplained`: those missed that the project itself meets without the statements that were lost: their losing is
    not why they are missed."""

    missed: tuple[int, ...]
    losses: tuple[str, ...] = ()
    end: str = "finished"
    unexplained: tuple[int, ...] = ()

    def as_json(self) -> dict[str, object]:
        codes = sorted({loss.split(": ")[1] for loss in self.losses})
        row: dict[str, object] = {"missed": list(self.missed), "codes": codes}
        return row | {"unexplained": list(self.unexplained)} if self.unexplained else row


@lru_cache
def read_project(name: str) -> ReadProgram:
    """The project of the folder, with every file of it that is a program."""
    diagnostics = Diagnostics()
    files = [path for path in sorted((HERE / name).iterdir()) if path.suffix != ".toml"]
    read = read_program(files, diagnostics=diagnostics)
    errors = [item.as_text() for item in diagnostics.of(Severity.ERROR)]
    if errors:
        raise RplError(f"{name}: {errors[0]}")
    return read


def cell_of(name: str) -> Cell | None:
    path = HERE / name / "cell.toml"
    return read_cell(str(path)) if path.exists() else None


def switched_on(result: RunResult) -> set[int]:
    """Numbers of the digital outputs that are on at the end."""
    state: dict[int, bool] = {}
    for event in result.trace:
        if event.kind != "output":
            continue
        kind, index, last, _ = event.port or (None, None, None, None)
        known = [str(name) for name in (event.data.get("signal"), *event.names) if name]
        for key in signal_names(kind, known, index, last):
            if found := re.fullmatch(r"digital_out:(\d+)", key):
                state[int(found[1])] = bool(event.data.get("value"))
    return {number for number, on in state.items() if on}


def behind_stops(program: ir.Program) -> ir.Program:
    """The program without stops, which a self-checking project has none of; without one a controller waits for good."""

    def is_stop(node: object) -> bool:
        match node:
            case ir.Halt() | ir.WaitUntil(condition=ir.BoolLiteral(value=False), timeout=None):
                return True
        return False

    return rewrite(program, lambda node: ir.Nothing() if is_stop(node) else node)


def own_run(name: str) -> tuple[str, set[int]]:
    """How the project ends on its own arm, and the expectations that are met."""
    project, read = PROJECTS[name], read_project(name)
    result = run_program(read.program, project.robot, cell_of(name), project.entry, LIMIT_S, controller=DRIVEN)
    return _end(result), switched_on(result)


def pair_of(name: str, target: str) -> Pair:
    """Translate, read back, run in the same surroundings."""
    project, read = PROJECTS[name], read_project(name)
    everything = tuple(range(1, project.count + 1))
    diagnostics = Diagnostics()
    try:
        cell = cell_of(name)
        given, levels = (cell.variables, cell.analog) if cell is not None else ({}, ())
        translation = translate_program(read, target, project.robot, None, diagnostics, given=given, analog=levels)
        again = Diagnostics()
        back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
        if again.has_errors:
            return Pair(everything, end=f"error: {again.of(Severity.ERROR)[0].as_text()}")
        named = behind_stops(with_signal_names(back.program, translation.program))
        theirs = in_words_of(cell, read.program, named) if cell is not None else None
        entry = entry_name(read.program, project.entry)
        begins = named.entry or translation.renamed.get(entry, entry) if entry else None
        result = run_program(named, project.robot, theirs, begins, LIMIT_S, controller=DRIVEN)
    except RplError as error:
        return Pair(everything, end=f"error: {type(error).__name__}: {error}")
    on = switched_on(result)
    told = [item for item in diagnostics if item.severity == Severity.LOSS or item.code is LEFT_OVER]
    losses = sorted(set(map(_told, told)))
    missed = tuple(number for number in everything if number not in on)
    end = _end(result)
    asked = missed and end == "finished"  # a fault ends the run in front of what follows
    unexplained = tuple(sorted(met_without(name, told).intersection(missed))) if asked else ()
    return Pair(missed, tuple(losses), end, unexplained)


def met_without(name: str, told: list[Diagnostic]) -> set[int]:
    """The expectations that the project meets on its own arm without the statements where losses are told."""
    project, read = PROJECTS[name], read_project(name)
    lost = {(item.origin.file, item.origin.line) for item in told}
    left = without_lines(read.program, lost)
    try:
        result = run_program(left, project.robot, cell_of(name), project.entry, LIMIT_S, controller=DRIVEN)
    except RplError:
        return set()
    return switched_on(result)


def without_lines(program: ir.Program, lines: set[tuple[str, int]]) -> ir.Program:
    """The program without the statements of routines that begin in these lines of files, and without those around which
    cannot be without them (a trigger without its action)."""
    gone = ir.Nothing()

    def change(node: object) -> object:
        if not isinstance(node, ir.Statement):
            return node
        inside = (getattr(node, field.name) for field in dataclasses.fields(node))
        return gone if (node.origin.file, node.origin.line) in lines or any(one is gone for one in inside) else node

    modules = (
        dataclasses.replace(module, routines=tuple(rewrite(routine, change) for routine in module.routines))
        for module in program.modules
    )
    return dataclasses.replace(program, modules=tuple(modules))


def _end(result: RunResult) -> str:
    return result.status if result.fault is None else f"{result.status}: {result.fault.code}: {result.fault.message}"


def _told(item: Diagnostic) -> str:
    return f"{item.origin.line}: {item.code.name}: {item.message}"


def recorded() -> dict[str, dict[str, dict[str, object]]]:
    """project -> target -> what came of it, as it was found last."""
    if not FILE.exists():
        return {}
    found: dict[str, dict[str, dict[str, object]]] = json.loads(FILE.read_text("utf-8"))
    return found


def _pair(names: tuple[str, str]) -> Pair:
    return pair_of(*names)


def _shown(name: str, target: str, pair: Pair) -> Iterator[str]:
    count = PROJECTS[name].count
    silent = "  SILENT" if pair.missed and not pair.losses else ""
    missed = f"; missed {' '.join(map(str, pair.missed))}" if pair.missed else ""
    missed += f"; UNEXPLAINED {' '.join(map(str, pair.unexplained))}" if pair.unexplained else ""
    yield f"{name} -> {target}: {count - len(pair.missed)} of {count}{missed}; {pair.end[:200]}{silent}"
    yield from (f"    {loss[:220]}" for loss in pair.losses)


def main(words: list[str]) -> None:
    targets = [word.removeprefix("to:") for word in words if word.startswith("to:")] or TARGETS
    wanted = [word for word in words if not word.startswith("to:") and word != "write"]
    names = [name for name in PROJECTS if not wanted or any(word in name for word in wanted)]
    pairs = [(name, target) for name in names for target in targets]
    table: dict[str, dict[str, Pair]] = {}
    with ProcessPoolExecutor(2) as pool:
        for (name, target), pair in zip(pairs, pool.map(_pair, pairs), strict=True):
            table.setdefault(name, {})[target] = pair
            print(*_shown(name, target, pair), sep="\n", flush=True)
    width = max(map(len, targets)) + 2
    print("\n" + " " * 16 + "".join(f"{target:>{width}}" for target in targets))
    for name, found in table.items():
        met = [f"{PROJECTS[name].count - len(found[t].missed)}/{PROJECTS[name].count}" for t in targets]
        print(f"{name:<16}" + "".join(f"{text:>{width}}" for text in met))
    if not words or "write" in words:
        rows = recorded() if words else {}
        for name, found in table.items():
            rows.setdefault(name, {}).update({target: pair.as_json() for target, pair in found.items()})
        FILE.write_text(json.dumps(rows, indent=1, sort_keys=True) + "\n", "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
