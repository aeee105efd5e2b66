"""Operands with their meaning: final names of numbered variables, conditions, values with units, frames, tools.

A bank is one array variable (`B`, index base 0) where anything in the project computes an index into it, else each used
element is a variable of its own (`B000`). Global banks live in module `registers`, local ones in their job.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import cast

from rpl import ir
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.passes.rewrite import rewrite_parts
from rpl.reading.shapes import StatementError
from rpl.source import Origin

from . import tables
from .jobs import Frame, Job
from .kinds import BASE, DIFFERENT, DIFFERENT_TOOL, JOINTS, MIXED, TARGET, Flow, Kind, Project, State, key_of
from .signals import is_digital
from .syntax import Bracket, Formula, Group, Numbered, Operand, Relation, Word, value_of

MIXED_POSITION = code(
    "inform-mixed-position",
    Severity.ERROR,
    "{name} may hold pulses ({pulses}) or a pose ({pose}) here; it is taken as a pose",
    "use two position variables",
)
UNIFIED = code(
    "inform-pulses-as-pose",
    Severity.INFO,
    "{name} holds pulses or a pose, or poses in several frames, depending on the way the program comes;"
    " it is stored as a pose in the base frame",
)
MIXED_FRAME = code(
    "inform-mixed-frame",
    Severity.WARNING,
    "a position may come with different {what} here; the base frame and the job's tool are taken",
)
MASTER = code(
    "inform-tool-frame",
    Severity.WARNING,
    "positions in the frame of a tool or of a master tool are not known here; the base frame is taken",
)
SIGNED = {"<>": "<>", "=": "=", "<": "<", ">": ">", "<=": "<=", ">=": ">="}
TYPES: dict[str, ir.Type] = {
    "B": ir.IntType(),
    "I": ir.IntType(),
    "D": ir.IntType(),
    "R": ir.RealType(),
    "S": ir.StringType(),
    "P": ir.TargetType("inform"),
    "BP": ir.ExternalType(),
    "EX": ir.ExternalType(),
    "M": ir.IntType(),
}
LAST_INDEX = {"P": 127, "BP": 127, "EX": 127, "M": 999, "UF": tables.USER_FRAMES, "TL": tables.TOOLS}


def plain_bank(bank: str) -> str:
    """The kind of a bank: that of LB is B."""
    return bank[1:] if bank.startswith("L") and len(bank) > 1 else bank


@dataclass(slots=True)
class Used:
    """What a job or the whole project uses, to be declared: variable name -> its type and where it was met first."""

    scalars: dict[str, tuple[ir.Type, Origin]] = field(default_factory=dict)
    arrays: dict[str, tuple[ir.Type, int, Origin]] = field(default_factory=dict)

    def scalar(self, name: str, type: ir.Type, origin: Origin) -> None:
        self.scalars.setdefault(name, (type, origin))

    def array(self, name: str, type: ir.Type, last: int, origin: Origin) -> None:
        known = self.arrays.get(name)
        if known is None or known[1] < last:
            self.arrays[name] = (type, last, origin if known is None else known[2])


@dataclass(slots=True)
class Shared:
    """What the lowering of all jobs shares."""

    project: Project
    used: Used
    diagnostics: Diagnostics
    shifts: bool = False  # somewhere in the project positions are shifted
    shifts_in_tool: bool = False  # somewhere in the axes of the tool
    parallel: dict[str, list[str]] = field(default_factory=dict)  # sub task -> jobs, from PSTART


class Operands:
    """Operands of one job."""

    def __init__(self, shared: Shared, job: Job, flow: Flow) -> None:
        self.shared, self.job, self.flow = shared, job, flow
        self.diagnostics = shared.diagnostics
        self.used = Used()
        self.origin = job.origin
        self.state: State = {}
        self.reported: set[str] = set()

    # ---- variables

    def value(self, operand: Operand) -> ir.Expression:
        """An operand as a number, text or signal."""
        if isinstance(operand, Formula):
            return self.final(operand.value)
        if isinstance(operand, Numbered) and operand.word in ("MREG", "M"):
            return self.register(operand)
        match operand:
            case Word(text=text) if text in ("ON", "OFF"):
                return ir.BoolLiteral(text == "ON", origin=self.origin)
            case Word(text=text) if tables.FLAG.fullmatch(text):
                return self.flag(text)
            case Word(text=text) if found := tables.TIMER.fullmatch(text):
                shown = ir.Magnitude(self.timer("timer", found[1]), tables.TIMER_UNIT, origin=self.origin)
                return ir.Convert("trunc", shown, origin=self.origin)
            case Word(text=text) if found := tables.TIMER_FLAG.fullmatch(text):
                return self.timer("timer_positive", found[1])
            case Group(values=(value,)):
                return self.final(value)
        return self.final(value_of(operand))

    def timer(self, what: str, number: str) -> ir.System:
        """Timer TM000 is the first one."""
        return ir.System(what, (ir.IntLiteral(int(number) + 1),), origin=self.origin)

    def flag(self, name: str) -> ir.Expression:
        """`FL0010`: a flag of newer controllers, common to all jobs."""
        name = f"FL{int(name[2:]):04d}"
        self.shared.used.scalar(name, ir.BoolType(), self.origin)
        return ir.Name(name, origin=self.origin)

    def register(self, register: Numbered) -> ir.Expression:
        """A variable of its own where no job computes the number of one."""
        number = register.number
        if isinstance(number, ir.IntLiteral) and not {"MREG", "M"} & self.shared.project.indirect:
            self.shared.used.scalar(f"MREG{number.value:03d}", ir.IntType(), self.origin)
            return ir.Name(f"MREG{number.value:03d}", origin=self.origin)
        self.shared.used.array("MREG", ir.IntType(), LAST_INDEX["M"], self.origin)
        return ir.Index(ir.Name("MREG", origin=self.origin), (self.final(register.number),), origin=self.origin)

    def final(self, expression: ir.Expression, form: str = TARGET) -> ir.Expression:
        """The expression with every numbered variable under its own name."""
        if isinstance(expression, ir.Index) and isinstance(expression.base, ir.Name):
            return self.variable(expression, form)
        return rewrite_parts(expression, self.final)

    def variable(self, index: ir.Index, form: str = TARGET) -> ir.Expression:
        bank = cast(ir.Name, index.base).id
        number = index.indices[0]
        if bank.endswith("[]"):
            return self.array_element(index)
        kind = plain_bank(bank)
        if kind in ("C", "BC", "EC", "RC"):
            raise StatementError("a taught point stands where a variable is needed", 0)
        used = self.used if bank != kind else self.shared.used
        type: ir.Type = TYPES[kind]
        if kind == "P":
            type = ir.JointsType() if form == JOINTS else TYPES["P"]
        suffix = self.suffix(index, form) if kind == "P" else ""
        if bank in self.flow.indirect or not isinstance(number, ir.IntLiteral):
            last = number.value if isinstance(number, ir.IntLiteral) else 0
            used.array(bank + suffix, type, max(last, LAST_INDEX.get(kind, tables.LAST_VARIABLE)), index.origin)
            place = self.final(number)
            return ir.Index(ir.Name(bank + suffix, origin=index.origin), (place,), origin=index.origin)
        name = f"{bank}{number.value:03d}{suffix}"
        used.scalar(name, type, index.origin)
        return ir.Name(name, origin=index.origin)

    def suffix(self, index: ir.Index, form: str) -> str:
        """A variable that holds pulses here and a pose there has a second name for its pulses."""
        key = key_of(index)
        if form != JOINTS or key is None:
            return ""
        home = self.job.name if key[0].startswith("L") else ""
        forms = self.shared.project.forms
        if key[0] in self.flow.indirect or key[1] is None:  # one array: does any of it hold a pose?
            both = any(TARGET in found for (at, (bank, _)), found in forms.items() if (at, bank) == (home, key[0]))
            return "_PULSES" if both else ""
        return "_PULSES" if TARGET in forms.get((home, key), {}) else ""

    def array_element(self, index: ir.Index) -> ir.Expression:
        """`B000[2]`: a user array of its own name."""
        name = cast(ir.Name, index.base).id[:-2]
        bank = name.rstrip("0123456789")
        used = self.used if bank.startswith("L") and len(bank) > 1 else self.shared.used
        used.array(f"{name}_ARRAY", TYPES[plain_bank(bank)], 99, index.origin)
        indices = tuple(self.final(each) for each in index.indices)
        if len(indices) > 1:
            raise StatementError("arrays of more than one dimension are not read", 0)
        return ir.Index(ir.Name(f"{name}_ARRAY", origin=index.origin), indices, origin=index.origin)

    def whole(self, expression: ir.Expression) -> bool:
        """Is it a variable or number of a whole-number type?"""
        match expression:
            case ir.IntLiteral():
                return True
            case ir.Index(base=ir.Name(id=bank)):
                return plain_bank(bank.rstrip("[]").rstrip("0123456789") or bank) in ("B", "I", "D")
        return False

    # ---- positions

    def is_position(self, operand: Operand) -> bool:
        return (
            isinstance(operand, ir.Index)
            and isinstance(operand.base, ir.Name)
            and plain_bank(operand.base.id) in ("P", "BP", "EX")
        )

    def kind(self, operand: Operand) -> Kind:
        """What a position holds here; a pose where nobody has said anything else."""
        kind = self.flow.kind(operand, self.state)
        if kind.form == MIXED:
            self.mixed(operand)
        if kind.form not in (JOINTS, TARGET):
            kind = replace(kind, form=TARGET, frame=BASE)
        return kind

    def mixed(self, operand: Operand) -> None:
        key = key_of(operand)
        home = self.job.name if key is not None and key[0].startswith("L") else ""
        forms = self.shared.project.forms.get((home, key), {}) if key is not None else {}
        name = self.spelled(operand)
        places = {form: f"line {origin.line} of {origin.file}" for form, origin in forms.items()}
        pulses, pose = (places.get(form, "from another job") for form in (JOINTS, TARGET))
        self.report_once(MIXED_POSITION, f"mixed {name}", name=name, pulses=pulses, pose=pose)

    def spelled(self, operand: Operand) -> str:
        match operand:
            case ir.Index(base=ir.Name(id=bank), indices=(ir.IntLiteral(value=number),)):
                return f"{bank}{number:03d}"
            case ir.Index(base=ir.Name(id=bank)):
                return f"{bank}[...]"
        return "the position"

    def position(self, operand: Operand) -> tuple[ir.Expression, Kind]:
        """A position variable, and what it holds."""
        if not self.is_position(operand):
            raise StatementError("a position variable is needed here", 0)
        index = cast(ir.Index, operand)
        if plain_bank(cast(ir.Name, index.base).id) != "P":
            return self.variable(index), Kind("external")
        kind = self.kind(index)
        return self.variable(index, kind.form), kind

    def tool(self, number: ir.Expression | None) -> ir.Expression:
        """TL#(n); without a number the job's own tool."""
        if number == DIFFERENT_TOOL:
            self.report_once(MIXED_FRAME, "tools", what="tools")
            number = None
        return self.numbered_frame("TL", ir.IntLiteral(self.job.tool) if number is None else self.final(number))

    def user_frame(self, number: ir.Expression) -> ir.Expression:
        return self.numbered_frame("UF", self.final(number))

    def numbered_frame(self, word: str, number: ir.Expression) -> ir.Expression:
        """A tool or user frame: a variable of its own, or an element of an array where a number is computed."""
        used = self.shared.used
        if isinstance(number, ir.IntLiteral) and word not in self.shared.project.indirect:
            used.scalar(f"{word}{number.value}", ir.PoseType(), self.origin)
            return ir.Name(f"{word}{number.value}", origin=self.origin)
        used.array(word, ir.PoseType(), LAST_INDEX[word], self.origin)
        return ir.Index(ir.Name(word, origin=self.origin), (number,), origin=self.origin)

    def frame(self, frame: Frame) -> ir.Expression:
        """The frame as an expression in the robot's base."""
        if frame.kind == "user" and frame.number is not None:
            return self.user_frame(frame.number)
        if frame == DIFFERENT:
            self.report_once(MIXED_FRAME, "frames", what="frames")
        elif frame.kind not in ("base", "user"):
            self.report_once(MASTER, "master")
        return ir.System("null_frame", origin=self.origin)

    # ---- conditions

    def condition(self, items: tuple[Operand, ...]) -> ir.Expression:
        """`a=b ANDEXP c=d OREXP e=f`, with brackets. M: and binds more tightly than or."""
        groups: list[list[ir.Expression]] = [[]]
        for item in items:
            match item:
                case Word(text=text) if text in tables.AND_WORDS:
                    continue
                case Word(text=text) if text in tables.OR_WORDS:
                    groups.append([])
                case Relation():
                    groups[-1].append(self.comparison(item))
                case Bracket(items=inner):
                    groups[-1].append(self.condition(inner))
                case _:
                    raise StatementError("a comparison is needed here", 0)
        if not all(groups):
            raise StatementError("a comparison is needed here", 0)
        return self.chain("or", [self.chain("and", group) for group in groups])

    def chain(self, op: str, parts: list[ir.Expression]) -> ir.Expression:
        done = parts[0]
        for part in parts[1:]:
            done = ir.Binary(op, done, part, origin=self.origin)
        return done

    def comparison(self, relation: Relation) -> ir.Expression:
        """One comparison; a single signal compared with ON or OFF is the signal itself."""
        left, right, op = self.value(relation.left), self.value(relation.right), SIGNED[relation.op]
        timer = isinstance(left, ir.Convert)
        if is_digital(left) or (isinstance(relation.left, Word) and not timer):
            if isinstance(right, ir.BoolLiteral) and op in ("=", "<>"):
                wanted = right.value == (op == "=")
                return left if wanted else ir.Unary("not", left, origin=self.origin)
            if not isinstance(right, ir.BoolLiteral) and not is_digital(right):
                right = self.lowest_bit(right)
        return ir.Binary(op, left, right, origin=self.origin)

    def lowest_bit(self, value: ir.Expression) -> ir.Expression:
        """M: a byte that stands for a signal's state means it by its lowest bit."""
        if isinstance(value, ir.IntLiteral):
            return ir.BoolLiteral(bool(value.value & 1), origin=self.origin)
        bit = ir.Binary("mod", value, ir.IntLiteral(2), origin=self.origin)
        return ir.Binary("<>", bit, ir.IntLiteral(0), origin=self.origin)

    # ---- values with a unit

    def tagged(self, tag: str, operand: Operand) -> ir.Expression:
        """A tag's value in its unit: written out as it is, from a variable in the tag's parts of the unit."""
        value = self.value(operand)
        part = tables.VARIABLE_UNITS.get(tag, 1.0)
        if isinstance(value, ir.IntLiteral | ir.RealLiteral) or part == 1.0:
            return value
        divisor = ir.RealLiteral(round(1.0 / part, 9))
        return ir.Binary("/", ir.Convert("real", value, origin=self.origin), divisor, origin=self.origin)

    def seconds(self, operand: Operand) -> ir.Expression:
        return self.tagged("T", operand)

    # ---- reports

    def report_once(self, what: Code, key: str, /, **arguments: object) -> None:
        """One report of a kind about one thing of this job."""
        if key not in self.reported:
            self.reported.add(key)
            self.diagnostics.report(what, self.origin, **arguments)


def tags_of(items: tuple[Operand, ...]) -> Iterator[tuple[str, Relation]]:
    """The `TAG=value` among operands."""
    for item in items:
        if isinstance(item, Relation) and isinstance(item.left, Word) and item.op == "=":
            yield item.left.text, item
