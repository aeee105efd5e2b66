"""A program in TP's terms to listings: one `.LS` file for each routine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.facts.entries import INITIALISE
from rpl.passes.legalise.facts.motion.externalaxes import leading, used_externals
from rpl.passes.scope import ProgramScope, Scope
from rpl.source import NOWHERE, Origin
from rpl.writing.beside import report_poses
from rpl.writing.ledger import EmissionLedger
from rpl.writing.statements import CannotSayError
from rpl.writing.target import OutputFile, WriteContext
from rpl.writing.templates import Macros, macros_of

from . import tables
from .assignments import Assignments
from .dumps import dump_files
from .expressions import Expressions
from .facts.programs import coordinates, entries_of, monitors_of, quiet_routines, steps_in
from .facts.registers import free_numbers, highest_free_registers, kept_registers
from .facts.wholes import moved_to_only
from .flow import Labels
from .frames import Frames
from .layout import laid_out
from .lines import Line
from .own import MODAL, noted_names
from .positions import Points, point_number
from .posture import assumed_postures, choose_postures, frames_only, moved_to
from .statements import Printer
from .texts import comment, remarks

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel

LOST_DECLARATION = code(
    "tp-lost-declaration", Severity.LOSS, "TP has no place for {name}: {reason}", "it is left as a remark"
)
LOST_ROUTINE = code("tp-lost-routine", Severity.LOSS, "TP cannot say this about {name}: {reason}", "it is left out")
TEXT_CASE = code(
    "tp-text-case", Severity.LOSS, "{name} compares texts; TP takes capital and small letters for the same"
)
ASSUMED = code(
    "tp-posture-assumed",
    Severity.INFO,
    "{point} has no posture in the source; it gets the one that the program begins with",
)
WRONG_FLAGS = code(
    "tp-posture-unreachable",
    Severity.ERROR,
    "the arm does not come to {point} with the posture and the turns that are written: {reason}",
)
SAME_NAME = code(
    "tp-same-name", Severity.ERROR, "two programs would be called {name}", "rename one; TP's programs are all global"
)

_NO_DATE = "DATE 00-01-01  TIME 00:00:00"  # the same text for the same program
# Variables that stand for what the controller has without any declaration, in programs read from listings.
_CONTROLLERS_OWN = ("UTOOL", "UFRAME", "UTOOL_NUM", "UFRAME_NUM", "WAIT_TIMED_OUT", "SKIP_HIT", *MODAL)
_COMPUTED = "?"  # stands for a program whose name a register holds
_MOTION = ("J ", "L ", "C ", "A ")


@dataclass(slots=True)
class Listing:
    """One program before it becomes text."""

    name: str
    lines: list[Line]
    points: Points
    header: Mapping[str, str]
    entry: bool = False


def write(program: ir.Program, context: WriteContext) -> list[OutputFile]:
    """All programs. Raises InternalError when the ledger finds a node that nobody accounted for."""
    ledger = EmissionLedger()
    writer = _Writer(program, context, ledger)
    listings = [listing for module in program.modules for listing in writer.module(module)]
    writer.finish(listings)
    ledger.check(program)
    beside = _beside(listings)
    say = macros_of(__package__, context.templates)
    written = (_file(listing, writer.frames, listing.name in beside, say) for listing in listings)
    return [*written, *dump_files(program, writer.names, writer.frames)]


class _Writer:
    def __init__(self, program: ir.Program, context: WriteContext, ledger: EmissionLedger) -> None:
        self.program, self.context, self.ledger = program, context, ledger
        self.diagnostics = context.diagnostics
        self.scopes = ProgramScope(program)
        self.names = {**_labels_of_registers(program), **context.register_names}
        in_use = {**context.there.numbers, **self.names}
        self.frames = Frames(
            *highest_free_registers(program, in_use),
            kept=kept_registers(program),
            moved_to=moved_to_only(program),
            free=free_numbers(program, in_use, tables.R),
        )
        for module in program.modules:
            for one in module.declarations:
                self.frames.declared(one, self.scopes.module(module))
        self.frames.beside(context.there)
        report_poses(self.frames.poses(), context.there, self.diagnostics)
        self.entries = entries_of(program)
        self.monitors = monitors_of(program)
        self.quiet, self.steady = quiet_routines(program)
        self.taken: set[str] = set()
        self.start: list[tuple[ir.Assign, Scope]] = []  # values of data before the program
        self.from_listings: set[str] = set()  # their points have postures of their own
        self.axes = self.extended = used_externals(program)
        around = context.robot.mechanisms if context.robot is not None else ()
        if any(not one.carries_robot for one in around) or coordinates(program):
            self.extended = leading(context.robot.carrying_axes if context.robot is not None else (), self.axes)

    def module(self, module: ir.Module) -> list[Listing]:
        self.ledger.written(module)
        before: list[Line] = []
        for declaration in module.declarations:
            before.extend(self.module_declaration(declaration, module))
        listings = [self.routine(module, routine) for routine in module.routines]
        if listings and before:
            listings[0].lines[:0] = before
        return listings

    def module_declaration(self, declaration: ir.Declaration, module: ir.Module) -> list[Line]:
        """Registers need no declaration; what is none has no place."""
        match declaration:
            case ir.Variable(name=name) if _is_bank(name):
                self.ledger.merged(declaration)
                return []
            case ir.SignalDeclaration(signal=ir.Signal(kind="flag", index=ir.IntLiteral())):
                self.ledger.merged(declaration)  # the name stands in the brackets
                return []
            case ir.Initialise(assign=ir.Assign(target=ir.Index(base=ir.Name(id="UTOOL" | "UFRAME")))):
                self.ledger.merged(declaration)  # it stands in the dump of frames
                return []
            case ir.Initialise(assign=assign):
                self.start.append((assign, self.scopes.module(module)))
                self.ledger.merged(declaration)
                return []
            case ir.Unread(text="") | ir.ExternalDeclaration():
                self.ledger.merged(declaration)
                return [Line(line) for one in declaration.origin.comments for line in remarks(one.text)]
        name = getattr(declaration, "name", "this declaration")
        self.diagnostics.report(LOST_DECLARATION, declaration.origin, name=name, reason="it has no register")
        self.ledger.reported(declaration)
        return []

    # ---- routines

    def routine(self, module: ir.Module, routine: ir.Routine) -> Listing:
        name = routine.name.upper()
        if name in self.taken:
            self.diagnostics.report(SAME_NAME, routine.origin, name=name)
        self.taken.add(name)
        scope = self.scopes.routine(module, routine)
        points = Points(axes=self.axes, extended=self.extended)
        expressions = Expressions(scope, self.names, limited="PROG" not in dict(module.attributes))
        printer = Printer(expressions, points, self.frames, Labels.of(routine.body), self.ledger, self.diagnostics)
        printer.monitors, printer.quiet, printer.steady = self.monitors, self.quiet, self.steady
        if routine.name.lower() in self.entries and "PROG" not in dict(module.attributes):
            printer.motion.stands, printer.motion.frame = True, "0"  # see standard_frames
        self.ledger.written(routine)
        printer.comments_only(routine.origin)
        named: dict[str, str] = {}
        steps = steps_in(routine.body)
        for declaration in routine.declarations:
            self.declaration(declaration, printer, named, steps)
        expressions.points = named
        printer.begin(routine.body)
        if expressions.texts_compared:
            self.diagnostics.report(TEXT_CASE, _place(routine), name=routine.name)
        self.lost_parts(routine)
        entry = routine.name.lower() in self.entries
        header = self.header(module, routine)
        if "PROG" in dict(module.attributes):
            self.from_listings.add(header.get("PROG", name))
        return Listing(header.get("PROG", name), printer.lines, points, header, entry)

    def header(self, module: ir.Module, routine: ir.Routine) -> dict[str, str]:
        """What the header of its listing said, for the program of a module that was one."""
        return dict(module.attributes) if routine is module.routines[0] else {}

    def declaration(
        self, declaration: ir.Declaration, printer: Printer, named: dict[str, str], steps: set[str]
    ) -> None:
        """Points; other data of a routine have registers by now."""
        try:
            match declaration:
                case ir.Variable(name=name) if point_number(name) is not None:
                    number = printer.points.declare(declaration, printer.expressions.scope, name in steps)
                    named[name] = printer.points.place(number)
                    printer.comments_only(declaration.origin)
                    self.ledger.written(declaration)
                    return
                case ir.VariableRows():
                    printer.points.declare_rows(declaration, printer.expressions.scope)
                    stem, numbers = declaration.stem, declaration.numbers.tolist()
                    named.update((f"{stem}{number}", printer.points.place(number)) for number in numbers)
                    self.ledger.written(declaration)
                    return
                case ir.Variable(name=name) if _is_bank(name):
                    self.ledger.merged(declaration)
                    return
                case ir.Unread(text=""):
                    printer.comments_only(declaration.origin)
                    self.ledger.written(declaration)
                    return
            raise CannotSayError("it has no register")
        except CannotSayError as error:
            shown = getattr(declaration, "name", "this declaration")
            self.diagnostics.report(LOST_DECLARATION, declaration.origin, name=shown, reason=str(error))
            printer.remark(declaration.origin.text or str(shown))
            self.ledger.reported(declaration)

    def lost_parts(self, routine: ir.Routine) -> None:
        """What a program has no place for. The passes before carry over what they can."""
        reasons = [
            *(["an error handler"] if self.ledger.handlers_reported(routine) else []),
            *(["a result"] if routine.returns is not None else []),
        ]
        for reason in reasons:
            self.diagnostics.report(LOST_ROUTINE, routine.origin, name=routine.name, reason=reason)

    # ---- the whole

    def finish(self, listings: list[Listing]) -> None:
        """Constant tools and frames, and tasks that run beside, at the start of each program that may be started."""
        tasks = [task for task in self.program.tasks if task.kind == "background"]
        begin = [Line(f"  RUN {task.entry.upper()}") for task in tasks]
        values = next((one for one in listings if one.name == INITIALISE.upper() and not one.entry), None)
        if values is not None:
            values.lines[:0] = self.first_values(values)
            self.start = []
        for listing in listings:
            if listing.entry:
                head = next((at for at, line in enumerate(listing.lines) if not line.first.startswith("  !")), 0)
                selected, first = self.standard_frames(listing, listings), self.first_values(listing)
                listing.lines[head:head] = [*first, *selected, *begin]
            robot = self.context.robot
            if robot is not None and listing.name not in self.from_listings:
                for reached, reason in choose_postures(listing.points, self.frames, robot):
                    point = f"{listing.name} P[{reached.number}]"
                    self.diagnostics.report(WRONG_FLAGS, reached.origin, point=point, reason=reason)
                self.assumed(listing, listings, robot)
            for task in tasks:
                if task.cyclic and task.entry.upper() == listing.name:
                    _repeat(listing)

    def assumed(self, listing: Listing, listings: list[Listing], robot: RobotModel) -> None:
        """Poses that registers get: their posture is the one the program begins with."""
        first = [
            one.points.found[number]
            for one in sorted(listings, key=lambda one: not one.entry)
            for number in (reached.number for reached in one.points.order)
            if number in one.points.found and one.points.found[number].kind == "joints"
        ]
        moved = moved_to(line for one in listings for line in one.lines)
        bases = frames_only(listing.lines, moved)
        begun = first[0].values if first else ()
        for number in assumed_postures(listing.points, self.frames, robot, begun, bases):
            self.diagnostics.report(ASSUMED, NOWHERE, point=f"{listing.name} P[{number}]")

    def standard_frames(self, listing: Listing, listings: list[Listing]) -> list[Line]:
        """World and flange where a program moves before it selects anything: a controller keeps what was selected
        last, other controllers begin with these."""
        if listing.name in self.from_listings:
            return []
        expressions = Expressions(self.scopes.module(self.program.modules[0]))
        done: list[Line] = []
        for word in ("UFRAME", "UTOOL"):
            if _moves_before(listing, listings, word):
                done.extend(self.frames.select(word, ir.System("null_frame"), expressions)[0])
        return done

    def first_values(self, listing: Listing) -> list[Line]:
        """The values that data have before the program."""
        done: list[Line] = []
        for assign, scope in self.start:
            try:
                done.extend(
                    Assignments(Expressions(scope, self.names), listing.points, self.frames.scratch).lines(assign)
                )
            except CannotSayError as error:
                self.diagnostics.report(LOST_DECLARATION, assign.origin, name="this value", reason=str(error))
                done.append(Line("  PAUSE"))
        return done


def _place(routine: ir.Routine) -> Origin:
    """Of a routine that passes have brought along: where the source first needs it (its statements stand there)."""
    places = (routine.origin, *(statement.origin for statement in routine.body))
    return next((origin for origin in places if origin.source), NOWHERE)


def _moves_before(listing: Listing, listings: list[Listing], word: str) -> bool:
    """Does the program move or look where the robot is, itself or by a call, before it selects such a number?"""
    named = {one.name: one for one in listings}
    asked: set[str] = set()

    def moves(name: str) -> bool | None:
        """None: it neither moves nor selects."""
        if name == _COMPUTED:
            return True
        if name in asked or name not in named:
            return None
        asked.add(name)
        certain = True  # no line before may have jumped over this one
        for line in named[name].lines:
            certain = certain and not _branches(line)
            if line.first.startswith(f"  {word}_NUM=") and (certain or name == listing.name):
                return False
            if _needs_frames(line):
                return True
            found = moves(_called(line)) if "CALL " in line.first else None
            if found or (found is False and certain):
                return found
        return None

    return bool(moves(listing.name))


def _branches(line: Line) -> bool:
    return line.first.lstrip().startswith(("IF ", "SELECT ", "JMP ", "LBL[", "FOR ")) or "LBL[" in line.first


def _called(line: Line) -> str:
    """The program that a line calls, if it does."""
    name = line.first.partition("CALL ")[2].partition("(")[0].strip()
    return _COMPUTED if "[" in name else name


def _needs_frames(line: Line) -> bool:
    return line.first.startswith(_MOTION) or line.first.endswith("=LPOS")


def _repeat(listing: Listing) -> None:
    """A background program that begins again at its end."""
    used = {line.first for line in listing.lines}
    label = next(n for n in range(tables.LAST_LABEL, 0, -1) if not any(f"LBL[{n}" in text for text in used))
    listing.lines.insert(0, Line(f"  LBL[{label}:again]"))
    listing.lines.append(Line(f"  JMP LBL[{label}]"))


def _is_bank(name: str) -> bool:
    upper = name.upper()
    if upper in tables.BANKS or upper in _CONTROLLERS_OWN or upper.startswith("$") or name == tables.TIMED_OUT:
        return True
    bank = upper.rstrip("0123456789")
    return bank != upper and bank in (*tables.BANKS, "UTOOL", "UFRAME")


def _labels_of_registers(program: ir.Program) -> dict[tuple[str, int], str]:
    """Comments of registers that are variables of their own, and those that a listing's reader has kept in remarks."""
    found: dict[tuple[str, int], str] = {}
    for module in program.modules:
        for declaration in module.declarations:
            if isinstance(declaration, ir.Unread) or (isinstance(declaration, ir.Variable) and not declaration.label):
                found.update(noted_names(declaration.origin))
            if isinstance(declaration, ir.Variable) and declaration.label:
                bank = declaration.name.upper().rstrip("0123456789")
                digits = declaration.name[len(bank) :]
                if digits and bank in tables.BANKS:
                    found[bank, int(digits)] = declaration.label
    return found


def _beside(listings: list[Listing]) -> set[str]:
    """Programs that run beside the one that has the arm, and those that these call."""
    starts = {line.first.removeprefix("  RUN ") for one in listings for line in one.lines if "  RUN " in line.first}
    calls = {one.name: {_called(line) for line in one.lines} for one in listings}
    while more := {name for each in starts for name in calls.get(each, ()) if name} - starts:
        starts |= more
    return starts


def _file(listing: Listing, frames: Frames, beside: bool, say: Macros) -> OutputFile:
    """`beside`: the program must not ask for the arm, which another one has, only to look where it is (M: that it
    may)."""
    _settle(listing.points, frames)
    moves = any(line.first.startswith(_MOTION) or ("PR[" in line.first and not beside) for line in listing.lines)
    header = listing.header
    about = header.get("COMMENT", header.get("comment", "")).strip('"')
    text = say(
        "program",
        name=listing.name,
        kind=header.get("PROG_TYPE", ""),
        comment=comment(about),
        lines=laid_out(listing.lines, say),
        created=header.get("CREATE", _NO_DATE),
        modified=header.get("MODIFIED", _NO_DATE),
        groups=header.get("DEFAULT_GROUP", _mask(listing.points) if moves else "*,*,*,*,*"),
        application=[part.strip() for part in header.get("APPL", "").split(";") if part.strip()],
        positions=list(listing.points.text()),
    )
    return OutputFile(f"{listing.name}.LS", ("\r\n".join(text.splitlines()) + "\r\n").encode("ascii"))


def _mask(points: Points) -> str:
    """The motion groups that a program asks for."""
    return "1,1,*,*,*" if points.axes > points.extended else "1,*,*,*,*"


def _settle(points: Points, frames: Frames) -> None:
    """Where the frame in force is not known at a move but the program has only one, it is that one."""
    frame, tool = frames.only("UFRAME"), frames.only("UTOOL")
    for number, uses in points.frames.items():
        points.frames[number] = {
            (frame if uf == "F" and frame.isdigit() else uf, tool if ut == "F" and tool.isdigit() else ut)
            for uf, ut in uses
        }
