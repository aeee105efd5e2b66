"""A program in INFORM's terms to jobs: one `.JBI` file for each routine."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.motion.externalaxes import leading, used_externals
from rpl.passes.legalise.facts.motion.pulsecounts import assumed
from rpl.passes.legalise.facts.usage import doing
from rpl.source import NOWHERE
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile, WriteContext
from rpl.writing.templates import macros_of

from . import tables
from .assignments import Assignments
from .cell import Cell
from .conditionfiles import condition_files
from .facts.positions import counts_joints, filled, goes_round_corners, goes_to_joints
from .facts.tasks import jobs_beside, started_first, sub_tasks
from .job import Job, winding
from .labels import Labels
from .motion import Motion, joined_shifts
from .operands import Registers, element, numbered, selected
from .places import WORLD, Constants, Position
from .positions import Positions
from .statements import Printer
from .texts import remarks
from .unchanged import unchanged

LOST_DECLARATION = code(
    "inform-lost-declaration", Severity.LOSS, "INFORM has no place for {name}: {reason}", "it is left as a remark"
)
LOST_ROUTINE = code("inform-lost-routine", Severity.LOSS, "INFORM cannot say this about {name}: {reason}")
SAME_NAME = code("inform-same-name", Severity.ERROR, "two jobs would be called {name}", "rename one; jobs are global")
MANY_TASKS = code(
    "inform-many-tasks",
    Severity.LOSS,
    "{count} jobs would run beside the program; a controller has {most} sub tasks",
    "begin some of them from one job, or watch fewer conditions",
)
TOOL_OF_PLACE = code(
    "inform-tool-of-place",
    Severity.WARNING,
    "{name} asks where the tool is and does not drive: tool {tool} is taken, which most of the moves are driven with",
)
COPIES = code(
    "inform-taught-copies",
    Severity.WARNING,
    "the value of {name} stands in several places that {job} uses: {places}",
    "teach all of them anew, or what is computed from one stays behind the others",
)
LONG_NAME = code(
    "inform-long-name", Severity.ERROR, "{name}: a job's name has at most {most} characters", "rename the routine"
)

_BANKS = (*tables.BANKS, tables.TL, tables.UF)
_MOVING = (ir.Move, ir.MoveExternal, ir.Spline, ir.Vendor, ir.Opaque)


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """All jobs. Raises InternalError when the ledger finds a node that nobody accounted for."""
    same = unchanged(program, context)
    if same is not None and not context.templates:
        return same
    ledger = EmissionLedger()
    writer = _Writer(program, context, ledger)
    jobs = [job for module in program.modules for job in writer.module(module)]
    writer.finish(jobs)
    ledger.check(program)
    say = macros_of(__package__, context.templates)
    files = [OutputFile(f"{job.name}.JBI", job.text(say).encode("ascii")) for job in jobs]
    return [*files, *condition_files(writer.cell, writer.constants.names)]


class _Writer:
    def __init__(self, program: ir.Program, context: WriteContext, ledger: EmissionLedger) -> None:
        self.program, self.context, self.ledger = program, context, ledger
        self.diagnostics = context.diagnostics
        self.registers = Registers.of(program, (*context.register_names, *context.there.numbers))
        self.cell = Cell(self.registers, there=context.there)
        self.choose_axes()
        self.entries = started_first(program)
        self.constants = Constants.of(program, self.entries)
        self.cell.give(self.constants.values)
        self.constants.names = {f"{bank}{number}": name for (bank, number), name in context.register_names.items()}
        self.tasks = sub_tasks(program)
        self.jobs = {
            routine.name.lower(): routine.name.upper() for module in program.modules for routine in module.routines
        }
        self.taken: set[str] = set()
        self.start: list[ir.Assign] = []  # values of data before the program
        self.tools: dict[int, int] = {}  # id of a routine -> the tool of its positions in variables
        self.choose_tools()
        self.beside = jobs_beside(program)
        self.corners = goes_round_corners(program)
        self.moving = doing(program, lambda node: isinstance(node, _MOVING))
        robot = context.robot
        self.counting = counts_joints(program) or (winding(robot) and goes_to_joints(program, self.constants))
        if self.counting and robot is not None and robot.pulses_per_degree is None and robot.pulse_scale is not None:
            assumed(robot, self.diagnostics)

    def choose_axes(self) -> None:
        """How many external axes there are, and how many of them carry the robot: these come first in a job."""
        robot, count = self.context.robot, used_externals(self.program)
        self.cell.external = count
        self.cell.bases = leading(robot.carrying_axes, count) if robot is not None else 0
        if robot is not None and not robot.counts_pulses and count:
            assumed(robot, self.diagnostics)

    def choose_tools(self) -> None:
        """The tool that positions in variables are driven to with, in each job and in most of them."""
        everywhere: Counter[int] = Counter()
        driven: Counter[int] = Counter()
        standing: list[ir.Routine] = []
        for module in self.program.modules:
            for routine in module.routines:
                constants = self.constants.routine(routine)
                computed: Counter[int] = Counter()
                all_moves: Counter[int] = Counter()
                for node in walk(routine.body):
                    if isinstance(node, ir.Move):
                        tool = self.tool(node, constants)
                        all_moves[tool] += 1
                        frame = None if node.frame is None else constants.known(node.frame)
                        if constants.known(node.target) is None or (node.frame is not None and frame is None):
                            computed[tool] += 1
                everywhere.update(computed)
                most = (computed or all_moves).most_common(1)
                self.tools[id(routine)] = most[0][0] if most else 0
                driven.update(all_moves)
                if not most and any(map(_place_of_tool, walk(routine.body))):
                    standing.append(routine)
        self.cell.several_tools = len(driven) > 1
        if everywhere:
            self.cell.tool_of_variables = everywhere.most_common(1)[0][0]
        self.stand(standing, driven)

    def stand(self, routines: list[ir.Routine], driven: Counter[int]) -> None:
        """Jobs that do not drive and ask where the tool is: it is the tool that the others drive with."""
        tools = Counter({tool: count for tool, count in driven.items() if tool}) or driven
        if not tools:
            return
        for routine in routines:
            self.tools[id(routine)] = tools.most_common(1)[0][0]
            if len(tools) > 1:
                self.diagnostics.report(TOOL_OF_PLACE, routine.origin, name=routine.name, tool=self.tools[id(routine)])

    def tool(self, move: ir.Move, constants: Constants) -> int:
        if move.tool is None:
            return 0
        known = constants.known(move.tool)
        try:
            if known is not None:
                return self.cell.tool(known.values, move.tool)
            place = element(move.tool)
            return 0 if place is None else self.cell.tool_in(place)
        except CannotSayError:
            return 0

    # ---- modules and routines

    def module(self, module: ir.Module) -> list[Job]:
        self.ledger.written(module)
        head: list[str] = []
        for declaration in module.declarations:
            head.extend(self.declaration(declaration))
        jobs = [self.routine(module, routine) for routine in module.routines]
        if jobs:
            jobs[0].lines[:0] = head
        return jobs

    def declaration(self, declaration: ir.Declaration) -> Iterator[str]:
        """Numbered variables need no declaration; what is none has no place."""
        match declaration:
            case ir.Variable(name=name) if numbered(ir.Name(name)) is not None or name in _BANKS:
                self.ledger.merged(declaration)
                return
            case ir.Initialise(assign=assign) if selected(assign.target) is not None:
                self.ledger.merged(declaration)
                return
            case ir.Initialise(assign=assign):
                self.start.append(assign)
                self.ledger.merged(declaration)
                return
            case ir.Unread(text="") | ir.ExternalDeclaration():
                self.ledger.merged(declaration)
                for one in declaration.origin.comments:
                    yield from remarks(one.text)
                return
        shown = getattr(declaration, "name", "this declaration")
        self.diagnostics.report(LOST_DECLARATION, declaration.origin, name=shown, reason="it has no number")
        self.ledger.reported(declaration)
        yield from remarks(declaration.origin.text or str(shown))

    def routine(self, module: ir.Module, routine: ir.Routine) -> Job:
        name = routine.name.upper()
        if name in self.taken:
            self.diagnostics.report(SAME_NAME, routine.origin, name=name)
        if len(name) > tables.LONGEST_NAME:
            self.diagnostics.report(LONG_NAME, routine.origin, name=name, most=tables.LONGEST_NAME)
        self.taken.add(name)
        job = Job(name, self.cell, self.context.robot, self.tools[id(routine)], self.counting)
        self.registers.jobs = self.beside.get(routine.name.lower(), "")
        printer = self.printer(routine, job)
        self.ledger.written(routine)
        printer.comments_only(routine.origin)
        for declaration in routine.declarations:
            if isinstance(declaration, ir.Variable) and declaration.name in printer.motion.names:
                self.ledger.merged(declaration)
                printer.comments_only(declaration.origin)
            else:
                printer.lines.extend(self.declaration(declaration))
        printer.body(routine.body, last=True)
        self.lost_parts(routine)
        job.lines, job.entry = job.in_steps(joined_shifts(printer.lines)), routine.name.lower() in self.entries
        return job

    def printer(self, routine: ir.Routine, job: Job) -> Printer:
        constants = self.constants.routine(routine)
        positions = Positions(self.registers, job, constants)
        assignments = Assignments(self.registers, positions)
        positions.counted = assignments.counted
        motion = Motion(positions, assignments.number, self.diagnostics)
        motion.names = {name: int(name[1:]) for name in constants.points if name[:1] == "C" and name[1:].isdigit()}
        motion.corners = self.corners and not self.registers.jobs
        labels = Labels.of(routine.body)
        tasks, moving, alone = self.tasks, self.moving, self.context.left_alone
        return Printer(assignments, motion, labels, self.jobs, tasks, moving, alone, self.ledger, self.diagnostics)

    def lost_parts(self, routine: ir.Routine) -> None:
        """What a job has no place for. The passes before carry over what they can."""
        reasons = [
            *(["an error handler"] if self.ledger.handlers_reported(routine) else []),
            *(["a result"] if routine.returns is not None else []),
            *(["parameters"] if routine.parameters else []),
        ]
        for reason in reasons:
            self.diagnostics.report(LOST_ROUTINE, routine.origin, name=routine.name, reason=reason)

    # ---- the whole

    def finish(self, jobs: list[Job]) -> None:
        """First values, and tasks that run beside, at the start of each job that may be started."""
        for (job_name, name), places in sorted(self.cell.copies.items()):
            if len(places) > 1:
                shown = ", ".join(sorted(places))
                self.diagnostics.report(COPIES, NOWHERE, name=name, job=job_name, places=shown)
        background = [task for task in self.program.tasks if task.kind == "background"]
        count = len(background) + len(self.tasks)
        if count > tables.MOST_SUBTASKS:
            self.diagnostics.report(MANY_TASKS, NOWHERE, count=count, most=tables.MOST_SUBTASKS)
        first = {job.name: self.first_values(job) for job in jobs if job.entry}
        for job in jobs:
            if not job.entry:
                continue
            at = next((n for n, line in enumerate(job.lines) if not line.startswith("'")), len(job.lines))
            begin = first[job.name]
            for n, task in enumerate(background, len(self.tasks) + 1):
                begin.append(f"PSTART JOB:{self.jobs.get(task.entry.lower(), task.entry.upper())} SUB{n}")
            job.lines[at:at] = begin
        for task in background:
            for job in jobs:
                if task.cyclic and job.name == task.entry.upper():
                    job.lines = ["*AGAIN", *job.lines, "JUMP *AGAIN"]

    def first_values(self, job: Job) -> list[str]:
        """The values that data have before the program."""
        positions = Positions(self.registers, job, self.constants)
        assignments = Assignments(self.registers, positions)
        positions.counted = assignments.counted
        done = []
        for number in filled(self.program):
            begin = Position("joints" if number in self.constants.joints else "pose", WORLD)
            if begin.kind == "pose" or job.scale is not None:
                done.append(f"SET P{number:03d} {positions.kept(begin)}")
        for assign in self.start:
            self.registers.begin()
            try:
                done.extend(assignments.assign(assign))
            except CannotSayError as error:
                self.diagnostics.report(LOST_DECLARATION, assign.origin, name="this value", reason=str(error))
                done.append("PAUSE")
        return done


def _place_of_tool(node: object) -> bool:
    """Does it ask where the tool is that is in use?"""
    match node:
        case ir.System(name="actual_pose") | ir.Builtin(function="current_target"):
            return True
    return False
