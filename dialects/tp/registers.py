"""The registers of a project: which are used, whether a bank is indexed by a computed number, what kind of position
each position register holds, what the arguments of the programs are. Found by a look over all statements before they
are read, because a statement's meaning depends on it.

A bank that is never indexed by a computed number becomes one variable for each register (`R1`, `PR3`); otherwise it is
one array (`R`). Numeric registers start at 0, strings empty, position registers without a value.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import COMMENT, Piece
from rpl.source import Comment, Origin, Source

from . import tables
from .dumps import Dump
from .positions import type_of_kind, value_of
from .split import MACRO, without_notes

MIXED_REGISTER = code(
    "tp-mixed-position-register",
    Severity.WARNING,
    "PR[{number}] holds joints here and a Cartesian position at {other}; it is kept as a Cartesian position",
    "use two position registers",
)
MIXED_ELEMENTS = code(
    "tp-mixed-position-elements",
    Severity.ERROR,
    "PR[{number}] holds joints here and a Cartesian position at {other}; what its elements are depends on the way here",
    "use two position registers",
)
MODULE = "registers"

# A move with nothing in it that a register, frame or program could stand for; most lines of most programs.
_PLAIN_MOVE = re.compile(r"[JL] P\[\d+\] \d+(?:\.\d+)?(?:%|mm/sec|cm/min|deg/sec) ?(?:FINE|CNT ?\d+)\s*")
_REFERENCE = re.compile(r"(?<![\w$.])(R|PR|SR)\s*\[\s*(?:GP\d+\s*:?\s*)?(?:(\d+)\s*(?=[\],]))?", re.IGNORECASE)
_ELEMENT = re.compile(r"(?<![\w$.])PR\s*\[\s*(?:GP1\s*:?\s*)?(\d+)\s*,", re.IGNORECASE)
_ASSIGNED = re.compile(
    r"(?:^|,)\s*PR\s*\[\s*(?:GP1\s*:?\s*)?([^\[\],]*(?:\[[^\]]*\])?)\s*\]\s*=\s*(.*)\Z", re.IGNORECASE
)
_LATCHED = re.compile(r"(?<![\w$.])PR\s*\[\s*(\d+)\s*\]\s*=\s*([LJ]POS)", re.IGNORECASE)
_FRAME_FROM = re.compile(r"^U(?:FRAME|TOOL)\s*\[[^=]*=\s*PR\s*\[\s*(\d+)\s*\]", re.IGNORECASE)
_OPERAND = re.compile(
    r"(?<![\w$.])(LPOS|JPOS|P\s*\[\s*\d+|PR\s*\[\s*(?:GP1\s*:?\s*)?\d+\s*\]|UFRAME|UTOOL)", re.IGNORECASE
)
_CALL = re.compile(r"(?:CALL|RUN)\s+([A-Za-z_\u0080-\uffff][-\w]*)\s*(?:\((.*)\))?", re.IGNORECASE)
_ARGUMENT = re.compile(r"(?<![\w$.])AR\s*\[\s*(\d+)", re.IGNORECASE)
_HANDED_ON = re.compile(r"AR\[(\d+)(?::[^\]]*)?\]", re.IGNORECASE)
_TEXT_ARGUMENT = re.compile(r"AR\s*\[\s*(\d+)\s*\]\s*(?:=|<>)\s*'|'\s*(?:=|<>)\s*AR\s*\[\s*(\d+)", re.IGNORECASE)
_FRAME_NUMBER = re.compile(
    r"^(UFRAME|UTOOL)_NUM\b|(?<![\w$.])(UFRAME|UTOOL)\s*\[|\$MN(UFRAME|UTOOL)(?:NUM|\[1,)", re.IGNORECASE
)


@dataclass(slots=True)
class Facts:
    """What is known of the project before its statements are read."""

    programs: dict[str, str] = field(default_factory=dict)  # upper-case name -> type word of its header
    macros: dict[str, str] = field(default_factory=dict)  # lower-case comment of a macro program -> its name
    used: dict[str, set[int]] = field(default_factory=lambda: {"R": set(), "PR": set(), "SR": set()})
    arrays: set[str] = field(default_factory=set)
    joints: dict[int, Origin] = field(default_factory=dict)  # position registers seen to hold joints
    cartesian: dict[int, Origin] = field(default_factory=dict)
    whole_bank: dict[str, Origin] = field(default_factory=dict)  # evidence from computed numbers, by kind
    elements: set[int] = field(default_factory=set)  # position registers of which an element is used
    fixed: dict[str, int] = field(default_factory=dict)  # frames that are selected for good: no program selects one
    links: set[tuple[int, int]] = field(default_factory=set)
    arguments: dict[str, dict[int, str]] = field(default_factory=dict)
    handed_on: set[tuple[str, int, str, int]] = field(default_factory=set)  # arguments that become another program's
    labels: dict[tuple[str, int], str] = field(default_factory=dict)
    frames: set[str] = field(default_factory=set)  # UFRAME, UTOOL when the project uses them
    numbers_set: set[str] = field(default_factory=set)  # which of their numbers a program sets
    highest_frame: dict[str, int] = field(default_factory=dict)
    wait_timeout: bool = False
    loads: dict[int, dict[str, float]] = field(default_factory=dict)  # payload schedules, as a dump has them
    monitors: dict[str, tuple[int, int]] = field(default_factory=dict)  # program -> first interrupt, how many

    def register_kind(self, number: int | None) -> str:
        """What PR[number] holds; None: any of them, by a computed number."""
        if number is None:
            return "j" if self.joints and not self.cartesian and "p" not in self.whole_bank else "p"
        if number in self.cartesian:
            return "p"
        if number in self.joints:
            return "j"
        return self.register_kind(None) if "PR" in self.arrays else "p"

    def in_array(self, number: int) -> bool:
        """Is PR[number] an element of the bank's array (it is, unless it holds the other kind of position)?"""
        return "PR" in self.arrays and self.register_kind(number) == self.register_kind(None)

    def routine_name(self, name: str) -> str:
        """A called program by the name it has in the IR."""
        return re.sub(r"\W", "_", name)

    def parameter_count(self, program: str) -> int:
        return max(self.arguments.get(program.upper(), {}), default=0)

    def parameter_kind(self, program: str, number: int) -> str:
        return self.arguments.get(program.upper(), {}).get(number, "n")


# ---- the look over the project


def survey(facts: Facts, program: str, pieces: Iterable[Piece], points: dict[int, str], source: Source) -> None:
    """Note what the statements of one program use. `points`: kinds of its positions."""
    mine = facts.arguments.setdefault(program.upper(), {})
    for piece in pieces:
        if piece.kind == COMMENT or piece.text.startswith(("/", MACRO)):
            continue
        text = piece.text
        if _PLAIN_MOVE.fullmatch(text):
            continue
        origin = Origin(source, piece.start, piece.end)
        for match in _REFERENCE.finditer(text):
            bank = match[1].upper()
            if match[2] is None:
                facts.arrays.add(bank)
            elif bank != "R" or int(match[2]) <= tables.LOCAL_REGISTERS:
                facts.used[bank].add(int(match[2]))
        facts.elements.update(int(number) for number in _ELEMENT.findall(text))
        for number in _ARGUMENT.findall(text):
            mine.setdefault(int(number), "n")
        for one, other in _TEXT_ARGUMENT.findall(text):
            mine[int(one or other)] = "t"
        _positions(facts, text, points, origin)
        _calls(facts, program, text)
        _frames(facts, text)
        _labels(facts, source.text[piece.start : piece.end])
        if "WAITTMOUT" in text.upper() or "TIMEOUT" in text.upper():
            facts.wait_timeout = True


def _positions(facts: Facts, text: str, points: dict[int, str], origin: Origin) -> None:
    for number, word in _LATCHED.findall(text):
        known = facts.joints if word.upper() == "JPOS" else facts.cartesian
        known.setdefault(int(number), origin)
    framed = _FRAME_FROM.match(text)
    if framed:
        facts.cartesian.setdefault(int(framed[1]), origin)
    assigned = _ASSIGNED.search(text)
    if assigned is None:
        return
    index, value = assigned[1].strip(), assigned[2]
    for operand in _OPERAND.findall(value):
        word = "".join(operand.upper().split())
        number = re.search(r"\d+", word)
        if word.startswith("PR[") and number:
            if index.isdigit():
                facts.links.add((int(index), int(number[0])))
            continue
        is_joint_point = word.startswith("P[") and number is not None and points.get(int(number[0])) == "j"
        kind = "j" if word == "JPOS" or is_joint_point else "p"
        if index.isdigit():
            (facts.joints if kind == "j" else facts.cartesian).setdefault(int(index), origin)
        else:
            facts.whole_bank.setdefault(kind, origin)


def _calls(facts: Facts, program: str, text: str) -> None:
    for name, given in _CALL.findall(text):
        kinds = facts.arguments.setdefault(name.upper(), {})
        for number, argument in enumerate(split_arguments(given), 1):
            is_text = argument.startswith("'") or argument.upper().startswith("SR[")
            if is_text:
                kinds[number] = "t"
            elif argument:
                kinds.setdefault(number, "n")
            own = _HANDED_ON.fullmatch(argument.strip())
            if own is not None:
                facts.handed_on.add((program.upper(), int(own[1]), name.upper(), number))


def split_arguments(text: str) -> list[str]:
    """The arguments of a call, by the commas outside of brackets and texts."""
    if not text.strip():
        return []
    parts, depth, quoted, begin = [], 0, False, 0
    for at, sign in enumerate(text):
        if sign == "'":
            quoted = not quoted
        elif quoted:
            continue
        elif sign in "([":
            depth += 1
        elif sign in ")]":
            depth -= 1
            if depth < 0:
                text = text[:at]
                break
        elif sign == "," and depth == 0:
            parts.append(text[begin:at].strip())
            begin = at + 1
    parts.append(text[begin:].strip())
    return parts


def _frames(facts: Facts, text: str) -> None:
    for number_of, indexed, system in _FRAME_NUMBER.findall(text):
        name = (number_of or indexed or system).upper()
        facts.frames.add(name)
        if number_of:
            facts.numbers_set.add(name)
    for name, number in re.findall(r"(UFRAME|UTOOL)\s*(?:_NUM\s*=|\[1\s*,|\[)\s*(\d+)", text.upper()):
        facts.highest_frame[name] = max(facts.highest_frame.get(name, 0), int(number))


def _labels(facts: Facts, text: str) -> None:
    if text.lstrip().startswith(("!", "//")):
        return
    for note in without_notes(text)[1]:
        if note.text and note.bank in ("R", "PR", "SR", "I", *tables.NUMBERED_SIGNALS, *tables.NAMED_SIGNALS):
            facts.labels.setdefault(("R" if note.bank == "I" else note.bank, note.number), note.text)


def conclude(facts: Facts, dump: Dump, diagnostics: Diagnostics) -> None:
    """Spread what is known of position registers along assignments; report registers that hold both kinds."""
    facts.loads = dump.loads
    for number, (position, origin) in dump.positions.items():
        if number in facts.used["PR"] or "PR" in facts.arrays:
            known = facts.joints if position.kind == "j" else facts.cartesian
            if number not in facts.joints and number not in facts.cartesian:
                known[number] = origin
    for _ in range(len(facts.links) + 1):
        before = len(facts.joints) + len(facts.cartesian)
        for known in (facts.cartesian, facts.joints):
            for one, other in facts.links:
                for given, taken in ((one, other), (other, one)):
                    if given in known and taken not in facts.joints and taken not in facts.cartesian:
                        known[taken] = known[given]
        if len(facts.joints) + len(facts.cartesian) == before:
            break
    _spread_texts(facts)
    for number in sorted(facts.joints.keys() & facts.cartesian.keys()):
        elsewhere = facts.cartesian[number]
        place = f"{elsewhere.file}:{elsewhere.line}"
        what = MIXED_ELEMENTS if number in facts.elements else MIXED_REGISTER
        diagnostics.report(what, facts.joints[number], number=number, other=place)
    for bank, usual in (("UFRAME", 0), ("UTOOL", 1)):
        active = dump.active.get(f"{bank}_NUM", usual)
        if bank not in facts.numbers_set and (bank, active) in dump.frames:
            facts.fixed[bank] = active
    facts.labels = {**dump.labels, **facts.labels}


def _spread_texts(facts: Facts) -> None:
    """An argument that is handed on is a text in both programs or in none."""
    changed = True
    while changed:
        changed = False
        for caller, own, callee, given in facts.handed_on:
            kinds = facts.arguments.setdefault(caller, {}), facts.arguments.setdefault(callee, {})
            if (kinds[0].get(own) == "t") != (kinds[1].get(given) == "t"):
                kinds[0][own] = kinds[1][given] = "t"
                changed = True


# ---- declarations


def declarations(facts: Facts, dump: Dump) -> tuple[ir.Declaration, ...]:
    """The variables that stand for the registers and frames of the project."""
    made: list[ir.Declaration] = []
    for bank in ("R", "SR", "PR"):
        made.extend(_bank(bank, facts, dump))
    for bank in ("UFRAME", "UTOOL"):
        if bank in facts.frames or any(name == bank for name, _ in dump.frames):
            made.extend(_frame_bank(bank, facts, dump))
    if facts.wait_timeout:
        value = ir.IntLiteral(tables.WAIT_TIMEOUT_DEFAULT)
        made.append(_global(tables.WAIT_TIMEOUT, ir.IntType(), value))
    made.extend(_named_flags(facts))
    if said := _notes(facts, *tables.NUMBERED_SIGNALS, *tables.NAMED_SIGNALS):
        made.append(ir.Unread("", origin=Origin(comments=said)))
    return tuple(made)


def _global(name: str, type: ir.Type, initial: ir.Expression | None, label: str = "") -> ir.Variable:
    return ir.Variable(name, type, initial, "persistent", "global", label)


def _named_flags(facts: Facts) -> Iterable[ir.SignalDeclaration]:
    """Flags whose comment is a word that no other one has (`F[3:part_ready]`): the controller's own names for them."""
    labels = {number: text.strip() for (bank, number), text in facts.labels.items() if bank == "F"}
    for number, text in sorted(labels.items()):
        alone = sum(other.lower() == text.lower() for other in labels.values()) == 1
        if alone and re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", text):
            yield ir.SignalDeclaration(text, ir.Signal("flag", ir.IntLiteral(number)), "global")


def _notes(facts: Facts, *banks: str) -> tuple[Comment, ...]:
    """`DI[3] door closed`: what the listings' brackets say of signals, and of registers that are one array."""
    said = ((bank, number, text) for (bank, number), text in facts.labels.items() if bank in banks)
    return tuple(Comment(f"{bank}[{number}] {text}") for bank, number, text in sorted(said))


def _bank(bank: str, facts: Facts, dump: Dump) -> Iterable[ir.Declaration]:
    numbers = sorted(facts.used[bank])
    if bank in facts.arrays:
        yield from _array(bank, max([tables.LAST_NUMBER[bank], *numbers]), facts, dump)
        numbers = [number for number in numbers if bank == "PR" and not facts.in_array(number)]
    for number in numbers:
        label = facts.labels.get((bank, number), "")
        type, value = _one(bank, number, facts, dump)
        yield _global(f"{bank}{number}", type, value, label)


def _array(bank: str, last: int, facts: Facts, dump: Dump) -> Iterable[ir.Declaration]:
    """A whole bank as an array, with all its values."""
    type, bound = _element_type(bank, facts), (ir.IntLiteral(last),)
    values = []
    for number in range(1, last + 1):
        value = _one(bank, number, facts, dump)[1] if bank != "PR" or facts.in_array(number) else None
        values.append((None, value or _kept(bank, number, facts, type)))
    whole = _global(bank, ir.ArrayType(type, bound), ir.Aggregate(tuple(values)))
    yield replace(whole, origin=Origin(comments=_notes(facts, bank)))


def _element_type(bank: str, facts: Facts) -> ir.Type:
    simple: dict[str, ir.Type] = {"R": tables.NUMBER, "SR": ir.StringType()}
    return simple.get(bank) or type_of_kind(facts.register_kind(None))


def _one(bank: str, number: int, facts: Facts, dump: Dump) -> tuple[ir.Type, ir.Expression | None]:
    match bank:
        case "R":
            given = dump.numbers.get(number)
            if given is None:
                return tables.NUMBER, _kept(bank, number, facts, tables.NUMBER)
            value, is_whole, origin = given
            if is_whole:
                return tables.NUMBER, ir.IntLiteral(int(value), origin=origin)
            return tables.NUMBER, ir.RealLiteral(value, origin=origin)
        case "SR":
            text = dump.texts.get(number)
            if text is None:
                return ir.StringType(), _kept(bank, number, facts, ir.StringType())
            return ir.StringType(), ir.TextLiteral(text[0])
    kind = facts.register_kind(number)
    dumped = dump.positions.get(number)
    place = value_of(*dumped) if dumped is not None and dumped[0].kind == kind else None
    return type_of_kind(kind), place or _kept(bank, number, facts, type_of_kind(kind))


def _kept(bank: str, number: int, facts: Facts, type: ir.Type) -> ir.VendorValue:
    """The value that the controller keeps and no dump gives; on a new one it is 0, the empty text, or no place."""
    label = facts.labels.get((bank, number), "")
    return ir.VendorValue("tp", f"{bank}[{number}:{label}]" if label else f"{bank}[{number}]", type)


def _frame_bank(bank: str, facts: Facts, dump: Dump) -> Iterable[ir.Variable]:
    last = max(tables.FRAMES[bank], facts.highest_frame.get(bank, 0))
    values: list[tuple[str | None, ir.Expression]] = []
    for number in range(last + 1):
        dumped = dump.frames.get((bank, number))
        if dumped is None and number > 0:
            values.append((None, ir.VendorValue("tp", f"{bank}[{number}]", ir.PoseType())))
            continue
        if dumped is not None and number > 0:
            position, origin = dumped
            numbers = [position.groups[1].values.get(name) or 0.0 for name in "XYZWPR"]
        else:
            numbers, origin = [0.0] * 6, Origin()
        entries = tuple(
            (name, ir.RealLiteral(float(value), origin=origin))
            for name, value in zip(("x", "y", "z", "c", "b", "a"), numbers, strict=True)
        )
        values.append((None, ir.Aggregate(entries, origin=origin)))
    array = ir.ArrayType(ir.PoseType(), (ir.IntLiteral(last),), 0)
    yield _global(bank, array, ir.Aggregate(tuple(values)))
    active = dump.active.get(f"{bank}_NUM", 0 if bank == "UFRAME" else 1)
    yield _global(f"{bank}_NUM", ir.IntType(), ir.IntLiteral(active))
