"""The names that a source gives its signals, for runs of what was written in a language that only numbers them.

A translation that numbers named signals says which number each got; cell files and the comparison of two runs need that
to know one physical signal in both.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace

from rpl import ir, registry
from rpl.cell import Cell
from rpl.ir.analog import AnalogSetting
from rpl.ir.walk import walk
from rpl.linking import link
from rpl.passes.analog import AnalogRanges, analog_ranges
from rpl.proof.record import bits_of, group_key
from rpl.runtime.signals import joined_name, name_of_bits, usual_key
from rpl.runtime.values import SignalRef

_WIRING = "signal_names"


# Name, kind, number (or first bit), last bit of a group.
Named = tuple[str, str, int, int | None]


def with_signal_names(program: ir.Program, written: ir.Program) -> ir.Program:
    """The program as it was read back, with the signals that the written one declares, as far as it lacks them."""
    return with_names(program, names_lacking(program, written))


def names_lacking(program: ir.Program, written: ir.Program) -> tuple[Named, ...]:
    """The signals that the written program declares and the one that was read back does not, each name once."""
    known = {name for module in program.modules for name in _declared(module)}
    found: dict[str, Named] = {}
    for module in written.modules:
        for name, one in _declared(module).items():
            match one.signal:
                case ir.Signal(kind=kind, index=ir.IntLiteral(value=first), last=None) if name not in known:
                    found[name] = (one.name, kind, first, None)
                case ir.Signal(kind=kind, index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last)) if (
                    name not in known
                ):
                    found[name] = (one.name, kind, first, last)
    return tuple(found.values())


def with_names(program: ir.Program, names: Iterable[Named]) -> ir.Program:
    """The program with these signals besides."""
    signals = []
    for name, kind, first, last in names:
        end = ir.IntLiteral(last) if last is not None else None
        signals.append(ir.SignalDeclaration(name, ir.Signal(kind, ir.IntLiteral(first), end), scope="global"))
    if not signals or not program.modules:
        return program
    home = program.modules[0]
    wiring = ir.Module(_WIRING, home.dialect, tuple(signals), task=home.task, public=True)
    return replace(program, modules=(*program.modules, wiring))


def _declared(module: ir.Module) -> dict[str, ir.SignalDeclaration]:
    return {one.name.lower(): one for one in module.declarations if isinstance(one, ir.SignalDeclaration)}


Wired = dict[tuple[str, int], tuple[str, int, int]]


def wired_groups(program: ir.Program) -> Wired:
    """Groups that have a number of their own in another language (GO[2]) -> the name, first and last bit that the
    program declares for it."""
    found: Wired = {}
    for module in program.modules:
        for name, one in _declared(module).items():
            key = usual_key(name)
            match one.signal:
                case ir.Signal(index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last)) if key is not None:
                    if key[0].startswith("group"):
                        found[key] = (name, first, last)
    return found


def _named_groups(program: ir.Program) -> dict[str, str]:
    """Groups of bits that a language without numbers of signals names by them: `group_in:9-16` -> `gi9_16`."""
    written = (node for node in walk(*program.modules) if isinstance(node, ir.Signal | ir.Name))
    names = (node.name if isinstance(node, ir.Signal) else node.id for node in written)
    return {key: name for name in names if name and (key := group_key(name)) is not None}


def wired_bits(program: ir.Program) -> dict[str, str]:
    """By the name of a group, and by the number that it has elsewhere: the bits that the program declares for it
    (`gojob` -> `group_out:33-40`)."""
    named = {f"{kind}:{number}": f"{kind}:{a}-{b}" for (kind, number), (_, a, b) in wired_groups(program).items()}
    for module in program.modules:
        for name, one in _declared(module).items():
            match one.signal:
                case ir.Signal(kind=kind, index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last)):
                    named[name] = f"{bits_of(kind)}:{first}-{last}"
    return named


_ELEMENT = re.compile(r"(\w+)\[(\d+)\](.*)", re.DOTALL)


def _in_bases_of(cell: Cell, first: ir.Program, second: ir.Program) -> Cell:
    """The cell whose values for elements of arrays count from where the second program's arrays begin."""
    bases, others = _bases(first), _bases(second)
    changed: dict[str, object] = {}
    for path, value in cell.variables.items():
        found = _ELEMENT.fullmatch(path)
        name = found[1].lower() if found is not None else ""
        if found is not None and name in bases and name in others:
            (base, size), (other, count) = bases[name], others[name]
            first_left_out = int(base == 0 and count == size - 1)  # nothing uses it (passes.legalise.arrays)
            left_out_there = int(other == 0 and size == count - 1)  # a language whose arrays begin at 0 has it anyway
            path = f"{found[1]}[{int(found[2]) - base - first_left_out + other + left_out_there}]{found[3]}"
        changed[path] = value
    return replace(cell, variables=changed)


def _bases(program: ir.Program) -> dict[str, tuple[int, int]]:
    """Where the program's arrays of one dimension begin, and how many elements they have."""
    found: dict[str, tuple[int, int]] = {}
    for module in program.modules:
        for one in module.declarations:
            match one:
                case ir.Variable(name=name, type=ir.ArrayType(base=base, dimensions=(ir.IntLiteral(value=last),))):
                    found[name.lower()] = (base, last - base + 1)
    return found


def with_ranges_said(cell: Cell | None, first: ir.Program, second: ir.Program) -> Cell | None:
    """The cell with what the first program's files say of the analogue signals of a language that both are in: it is
    the same controller."""
    shared = {module.dialect for module in first.modules} & {module.dialect for module in second.modules}
    said = tuple(
        AnalogSetting(one, ports.name, ports.range)
        for one in sorted(shared)
        for ports in registry.dialect(one).analog_said(first)
        if ports.name and ports.range is not None
    )
    if not said:
        return cell
    return replace(cell if cell is not None else Cell(), analog=(*(cell.analog if cell is not None else ()), *said))


def kept_names(
    renamed: Mapping[str, str], registers: Mapping[tuple[str, int], str], program: ir.Program
) -> dict[str, str]:
    """By the folded name of a variable, or of an element, in the source: what it is called in the written program,
    where a translation has renamed it or given it a number (Translation.renamed, registers)."""
    known = {
        one.name.lower(): one.name
        for module in program.modules
        for one in module.declarations
        if isinstance(one, ir.Variable)
    }
    found = {name.lower(): known[other.lower()] for name, other in renamed.items() if other.lower() in known}
    for (bank, number), name in registers.items():
        for text in (f"{bank}{number}", f"{bank}{number:03d}"):
            if text.lower() in known:
                found[name.lower()] = known[text.lower()]
        if bank.lower() in known:
            found[name.lower()] = f"{known[bank.lower()]}[{number}]"
    return found


def turned(kept: Mapping[str, str]) -> dict[str, tuple[str, ...]]:
    """By the folded name in the written program: the names of the source that became it."""
    found: dict[str, tuple[str, ...]] = {}
    for name, other in kept.items():
        found[other.lower()] = (*found.get(other.lower(), ()), name)
    return found


def _in_names_of(cell: Cell, kept: Mapping[str, str], first: ir.Program, second: ir.Program) -> Cell:
    """The cell whose variables have the second program's names, and numbers for members of enumerations that it only
    knows as numbers."""
    numbers = _numbered_members(first, second)
    changed: dict[str, object] = {}
    for path, value in cell.variables.items():
        name, bracket, rest = path.partition("[")
        path = kept.get(path.lower(), kept.get(name.lower(), name) + bracket + rest)
        changed[path] = numbers.get(value.lower(), value) if isinstance(value, str) else value
    return replace(cell, variables=changed)


def _numbered_members(first: ir.Program, second: ir.Program) -> dict[str, object]:
    """Members of enumerations of the first program that the second one declares as numbers."""
    members, theirs = (
        {
            member.lower()
            for module in program.modules
            for one in module.declarations
            if isinstance(one, ir.EnumDeclaration)
            for member in one.members
        }
        for program in (first, second)
    )
    found: dict[str, object] = {}
    for module in second.modules:
        for one in module.declarations:
            match one:
                case ir.Variable(name=name, initial=ir.IntLiteral(value=value) | ir.RealLiteral(value=value)):
                    if name.lower() in members - theirs:
                        found[name.lower()] = value
    return found


def in_words_of(cell: Cell, first: ir.Program, second: ir.Program, kept: Mapping[str, str] | None = None) -> Cell:
    """The cell for a run of the second program, when it was written for the first: signals that the first one's
    language spells by number (V+ 1001, URScript digital_in[0]) as the second one's language spells the same signal.
    Names that the first program declares stay: the translation keeps them; `kept`: but these (kept_names)."""
    ours, theirs = ({module.dialect for module in one.modules} for one in (first, second))
    if ours == theirs or not ours or len(theirs) != 1:
        return cell
    if cell.variables:
        cell = _in_names_of(_in_bases_of(cell, first, second), kept or {}, first, second)
    if not (cell.inputs or cell.reactions or cell.layout):
        return cell
    known, spell = link(first).alias, registry.dialect(*theirs).signal_name
    declared = {name for module in first.modules for name in _declared(module)}
    numbered = {name for module in second.modules for name in _declared(module)}
    groups, own_groups = wired_groups(second), _named_groups(second)

    def named(signal: str) -> str:
        whole = joined_name(signal)
        if whole is not None and whole.lower() in numbered:  # RIN#(1), kept as RIN1, which has a number now
            return whole
        port = known(signal) if signal.lower() not in declared else None
        if port is None or port.name is not None or port.number is None:
            return signal
        if port.last is not None:  # bits in a row, which keep their numbers
            return own_groups.get(name_of_bits(port), name_of_bits(port))
        if (port.kind, port.number) in groups:
            return groups[port.kind, port.number][0]
        return spell(port.kind, port.number)

    def level(signal: str, value: object) -> object:
        return _converted(signal, known(signal), value, here, there)

    here = analog_ranges(first, min(ours), cell.analog) if len(ours) == 1 else None
    there = analog_ranges(second, min(theirs), cell.analog)
    return replace(
        cell,
        inputs=tuple(replace(one, signal=named(one.signal), value=level(one.signal, one.value)) for one in cell.inputs),
        reactions=tuple(
            replace(
                one,
                when=named(one.when),
                value=level(one.when, one.value),
                signal=named(one.signal),
                result=level(one.signal, one.result),
            )
            for one in cell.reactions
        ),
        layout=cell.layout.spelled(named),
    )


def _converted(
    signal: str, port: SignalRef | None, value: object, here: AnalogRanges | None, there: AnalogRanges
) -> object:
    """A value of an analogue signal as the second language counts it; as it is where that is not known."""
    if here is None or isinstance(value, bool) or not isinstance(value, int | float):
        return value
    kind, number = (port.kind, port.number) if port is not None else usual_key(signal) or ("", None)
    if not kind.startswith("analog"):
        return value
    names = {signal} | ({port.name} if port is not None and port.name else set())
    one, other = here.of(kind, number, names), there.of(kind, number, names)
    if one is None or other is None or one.unit != other.unit or one == other:
        return value
    return other.number(one.level(value))
