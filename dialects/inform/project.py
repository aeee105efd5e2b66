"""All jobs of a project to modules: a job is a module with one routine of its name; `registers` has the global data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from typing import cast

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.reading.shapes import ShapeParser
from rpl.registry import ReadResult
from rpl.source import Origin, Source

from . import tables
from .control import START, Control
from .dumps import Dump, is_dump, read_dump
from .jobs import Frame, Job, JobReader, Point, commands
from .kinds import JOINTS, Kind, Project, frame_of, kind_of_point, settle
from .operands import TYPES, Shared, Used, plain_bank
from .points import external_variable, value_of_point
from .pulsebanks import without_pulse_banks
from .split import SHAPE, SLOTS, split
from .syntax import Command, Numbered, build, lower

TWICE = code("inform-job-twice", Severity.WARNING, "job {name} is read twice; calls go to the first one")
OTHER_VALUE = code(
    "inform-other-value",
    Severity.INFO,
    "{name} has another value here than in the job read before; the first one is kept",
)
NOT_GIVEN = code(
    "inform-not-given",
    Severity.INFO,
    "{what} set at the controller, not in a job; taken as identity here",
    "give them in the cell file, for example {name} = {{ x = 0.0, y = 0.0, z = 120.0, a = 0.0, b = 0.0, c = 0.0 }}",
)
REGISTERS = "registers"
_KEPT = frozenset(("B", "I", "D", "R", "S", "P", "TL", "UF"))
_IDENTITY = ir.Aggregate(tuple((name, ir.RealLiteral(0.0)) for name in ("x", "y", "z", "a", "b", "c")))


@cache
def _parser() -> ShapeParser:
    return ShapeParser("inform.lark", SHAPE, SLOTS)


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """Read all files of one project together."""
    jobs: dict[str, Job] = {}
    further: list[Job] = []
    home: dict[int, int] = {}
    reports: list[FileReport] = []
    dump = Dump()
    for number, source in enumerate(sources):
        if is_dump(source.text):
            reports.append(FileReport(source.path, "inform", read_dump(source, dump, diagnostics), 0))
            continue
        done = assemble(source, "inform", split(source), _parser(), lower, build, diagnostics)
        reports.append(done.report)
        for job in JobReader(source, diagnostics).read(done.items):
            home[id(job)] = number
            if job.name.upper() in jobs:
                diagnostics.report(TWICE, job.origin, name=job.name)
                further.append(job)
            else:
                jobs[job.name.upper()] = job
    _with_positions(jobs, dump)
    modules = _Lowering(jobs, dump, diagnostics)
    for job in (*jobs.values(), *further):
        unread = modules.job(job)
        report = reports[home[id(job)]]
        texts = (*report.unread, *unread)
        reports[home[id(job)]] = replace(report, opaque=report.opaque + len(unread), unread=texts)
    return ReadResult(modules.program(), tuple(reports))


def _with_positions(jobs: dict[str, Job], dump: Dump) -> None:
    """Position variables of the controller that jobs use and none has the value of: the first job has it then."""
    mentioned: set[int] = set()
    every = False
    for job in jobs.values():
        for _, nodes in job.mentions():
            for node in nodes:
                if isinstance(node, ir.Index) and isinstance(node.base, ir.Name) and node.base.id in ("P", "P[]"):
                    index = node.indices[0]
                    every = every or not isinstance(index, ir.IntLiteral)
                    mentioned |= {index.value} if isinstance(index, ir.IntLiteral) else set()
    known = {number for job in jobs.values() for bank, number in job.points if bank == "P"}
    for number, point in dump.positions.items():
        if jobs and number not in known and (every or number in mentioned):
            next(iter(jobs.values())).points["P", number] = point


def _indirect(job: Job, local: bool) -> frozenset[str]:
    """Banks into which the job computes an index; TL and UF among the global ones."""
    found: set[str] = set()
    for _, nodes in job.mentions():
        for node in nodes:
            if isinstance(node, Numbered) and not local and not isinstance(node.number, ir.IntLiteral):
                found.add(node.word)
            if not isinstance(node, ir.Index) or isinstance(node.indices[0], ir.IntLiteral):
                continue
            bank = cast(ir.Name, node.base).id
            if not bank.endswith("[]") and (bank != plain_bank(bank)) == local:
                found.add(bank)
    return frozenset(found)


class _Lowering:
    """Gives the jobs their meaning, one after the other, and collects what they use together."""

    def __init__(self, jobs: dict[str, Job], dump: Dump, diagnostics: Diagnostics) -> None:
        self.jobs, self.dump, self.diagnostics = jobs, dump, diagnostics
        shared_banks: frozenset[str] = frozenset().union(*(_indirect(job, False) for job in jobs.values()))
        self.project = Project(jobs, shared_banks)
        self.flows = settle(self.project, {name: _indirect(job, True) for name, job in jobs.items()})
        self.shared = Shared(self.project, Used(), diagnostics)
        self.shared.shifts_in_tool = any(_in_tool(command) for job in jobs.values() for command in commands(job.body))
        self.modules: list[ir.Module] = []
        self.parallel()

    def parallel(self) -> None:
        """Which job runs in which sub task, before PWAIT is met."""
        for job in self.jobs.values():
            for command in commands(job.body):
                if command.word == "PSTART":
                    control = Control(self.shared, job, self.flows[job.name.upper()])
                    control.origin = command.origin
                    control.on_pstart(command)

    def job(self, job: Job) -> tuple[str, ...]:
        """Add the module of a job; gives the texts that could not be read."""
        key = job.name.upper()
        flow = self.flows[key]
        if self.jobs[key] is not job:
            flow = settle(Project({key: job}, self.project.indirect), {key: _indirect(job, True)})[key]
        control = Control(self.shared, job, flow)
        body = control.body(job.body)
        if body and isinstance(body[-1], ir.Return):  # END
            last = body[-1]
            body = body[:-1] + ((ir.Nothing(origin=last.origin),) if last.origin.comments else ())
        if control.restarts:
            body = (ir.Label(START, origin=replace(job.origin, comments=())), *body)
        origin = replace(job.origin, comments=())
        declarations: list[ir.Declaration] = list(control.points.declarations())
        declarations.extend(_declared(control.used, "variable", "routine"))
        routine = ir.Routine(
            job.name, "procedure", self.parameters(job), None, tuple(declarations), body, scope="global", origin=origin
        )
        top: tuple[ir.Declaration, ...] = ()
        if job.comments:
            top = (ir.Unread("", origin=replace(origin, comments=tuple(job.comments))),)
        self.modules.append(ir.Module(job.name, "inform", top, (routine,), tuple(job.header), origin=origin))
        if not control.unread:
            return ()
        return tuple(node.text for node in walk(body) if isinstance(node, ir.Opaque))

    def parameters(self, job: Job) -> tuple[ir.Parameter, ...]:
        """What GETARG takes, by the number of the argument."""
        types: dict[int, ir.Type] = {}
        for command in commands(job.body):
            if command.word != "GETARG" or len(command.items) < 2:
                continue
            target, source = command.items[:2]
            if isinstance(source, Numbered) and isinstance(source.number, ir.IntLiteral):
                types[source.number.value] = self.parameter_type(job, source.number.value, target)
        last = max(types, default=0)
        return tuple(ir.Parameter(f"IARG{n}", types.get(n, ir.IntType()), "value") for n in range(1, last + 1))

    def parameter_type(self, job: Job, number: int, target: object) -> ir.Type:
        bank = ""
        if isinstance(target, ir.Index) and isinstance(target.base, ir.Name):
            bank = plain_bank(target.base.id.rstrip("[]").rstrip("0123456789") or target.base.id)
        if bank == "P":
            kind = self.project.arguments.get((job.name.upper(), number), Kind())
            return ir.JointsType() if kind.form == JOINTS else TYPES["P"]
        return TYPES.get(bank, ir.IntType())

    def program(self) -> ir.Program:
        """All modules, with the global variables in front."""
        used = self.shared.used
        values = self.saved_values()
        declarations: list[ir.Declaration] = []
        for variable in _declared(used, "persistent", "global"):
            found = values.get(variable.name)
            if found is not None:
                variable = replace(variable, type=found[0], initial=found[1])
            else:
                variable = replace(variable, initial=self.kept(variable))
            declarations.append(variable)
        declarations.extend(self.saved_elements())
        declarations.extend(self.direct_inputs())
        modules = tuple(self.modules)
        self.tell_what_is_not_given(modules)
        if declarations:
            modules = (ir.Module(REGISTERS, "inform", tuple(declarations)), *modules)
        return without_pulse_banks(ir.Program(modules))

    def kept(self, variable: ir.Variable) -> ir.Expression | None:
        """The value that the controller keeps: from its files, else it is named for who can give it."""
        bank, number = variable.name.rstrip("0123456789"), variable.name[len(variable.name.rstrip("0123456789")) :]
        if bank not in _KEPT:
            return _IDENTITY if isinstance(variable.type, ir.PoseType) else None  # of the reader: the shift, flags
        if number:
            return self.kept_one(bank, int(number), variable.type)
        if not isinstance(variable.type, ir.ArrayType) or not isinstance(variable.type.dimensions[0], ir.IntLiteral):
            return None
        last, element = variable.type.dimensions[0].value, variable.type.element
        return ir.Aggregate(tuple((None, self.kept_one(bank, number, element)) for number in range(last + 1)))

    def kept_one(self, bank: str, number: int, type: ir.Type) -> ir.Expression:
        if bank in ("TL", "UF"):
            # M: tool 0 is the flange until somebody fills it in, and there is no user frame 0.
            unknown = _IDENTITY if number == 0 else ir.VendorValue("inform", f"{bank}#({number})", type)
            return self.dump.poses.get((bank, number), unknown)
        found = self.dump.values.get((bank, number))
        return found if found is not None else ir.VendorValue("inform", f"{bank}{number:03d}", type)

    def tell_what_is_not_given(self, modules: tuple[ir.Module, ...]) -> None:
        """Tools and user frames that moves use and no SETTOOL or MFRAME of the project sets."""
        used = self.shared.used
        targets = [node.target for node in walk(*modules) if isinstance(node, ir.Assign)]
        names = {target.id for target in targets if isinstance(target, ir.Name)}
        bases = [target.base for target in targets if isinstance(target, ir.Index)]
        names |= {base.id for base in bases if isinstance(base, ir.Name)}
        for bank, what in (("TL", "tool"), ("UF", "user frame")):
            given = [(key, place) for key, (_, place) in used.scalars.items() if key[:2] == bank and key[2:].isdigit()]
            given.extend((key, place) for key, (_, _, place) in used.arrays.items() if key == bank)
            known = {f"{word}{number}" for word, number in self.dump.poses} | {word for word, _ in self.dump.poses}
            unset = [(key, place) for key, place in given if key not in names and key not in known]
            if unset:
                listed = ", ".join(f"{bank}#({key[2:] or 'n'})" for key, _ in sorted(unset, key=lambda one: one[0]))
                words = f"{what} {listed} is" if len(unset) == 1 else f"{what}s {listed} are"
                self.diagnostics.report(NOT_GIVEN, unset[0][1], what=words, name=f"{bank}{unset[0][0][2:] or 1}")

    def direct_inputs(self) -> list[ir.Declaration]:
        """Names RIN1 ... of the direct inputs in use, so that a cell file can name them."""
        found: dict[int, ir.Signal] = {}
        for job in self.jobs.values():
            for _, nodes in job.mentions():
                for node in nodes:
                    if isinstance(node, ir.Signal) and isinstance(node.index, ir.IntLiteral):
                        found.setdefault(node.index.value - tables.DIRECT_INPUTS, node)
        return [
            ir.SignalDeclaration(f"RIN{number}", signal, scope="global", origin=_place(signal.origin))
            for number, signal in sorted(found.items())
            if number > 0 and signal.kind == "digital_in"
        ]

    def saved(self) -> Iterator[tuple[str, int, Point]]:
        """The saved value of each global position variable, the first one that is read."""
        known: dict[tuple[str, int], Point] = {}
        for job in self.jobs.values():
            for (bank, number), point in job.points.items():
                if bank not in ("P", "BP", "EX"):
                    continue
                before = known.setdefault((bank, number), point)
                if before is point:
                    yield bank, number, point
                elif (before.form, before.line.values) != (point.form, point.line.values):
                    self.diagnostics.report(OTHER_VALUE, point.line.origin, name=f"{bank}{number:03d}")

    def saved_values(self) -> dict[str, tuple[ir.Type, ir.Expression]]:
        found: dict[str, tuple[ir.Type, ir.Expression]] = {}
        for bank, number, point in self.saved():
            if bank in self.project.indirect:
                continue
            name = f"{bank}{number:03d}"
            if bank != "P":
                type: ir.Type = ir.ExternalType()
                value = external_variable(point)
            else:
                name, type, value = *self.typed(name, bank, number, point), value_of_point(point)
            found[name] = (type, value)
            self.shared.used.scalar(name, type, point.line.origin)
        return found

    def typed(self, name: str, bank: str, number: int | None, point: Point) -> tuple[str, ir.Type]:
        """Name and type of a saved position: pulses have a second name where the variable also holds a pose."""
        kind = kind_of_point(point.form, point.frame, point.tool, point.line.origin)
        if kind.form != JOINTS:
            return name, TYPES["P"]
        forms = {
            form
            for (home, key), found in self.project.forms.items()
            if home == "" and key[0] == bank and number in (None, key[1])
            for form in found
        }
        return (f"{name}_PULSES" if len(forms) > 1 else name), ir.JointsType()

    def saved_elements(self) -> list[ir.Declaration]:
        """First values of elements of banks that are arrays."""
        found: list[ir.Declaration] = []
        for bank, number, point in self.saved():
            if bank not in self.project.indirect:
                continue
            origin = point.line.origin
            name = bank
            value = external_variable(point)
            if bank == "P":
                name, type = self.typed(bank, bank, None, point)
                value = value_of_point(point)
                self.shared.used.array(name, type, number, origin)
            place = ir.Index(ir.Name(name, origin=origin), (ir.IntLiteral(number),), origin=origin)
            found.append(ir.Initialise(ir.Assign(place, value, origin=origin), origin=origin))
        return found


def _in_tool(command: Command) -> bool:
    """Does it shift positions in the axes of the tool?"""
    return command.word == "SFTON" and any(frame_of(item) == Frame("tool") for item in command.items)


def _declared(used: Used, storage: str, scope: str) -> list[ir.Variable]:
    """Declarations of what is used, in order."""
    found = [
        ir.Variable(name, type, None, storage, scope, origin=_place(origin))
        for name, (type, origin) in sorted(used.scalars.items())
    ]
    for name, (type, last, origin) in sorted(used.arrays.items()):
        array = ir.ArrayType(type, (ir.IntLiteral(last),), base=0)
        found.append(ir.Variable(name, array, None, storage, scope, origin=_place(origin)))
    return found


def _place(origin: Origin) -> Origin:
    return replace(origin, comments=())
