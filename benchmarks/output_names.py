"""Names in what was written that nobody who knows the source would know: helper names, for `output_measures.py`."""

from __future__ import annotations

import re
from collections.abc import Iterator

from rpl import ir, registry
from rpl.project import ReadProgram
from rpl.translation import Translation

_WORD = re.compile(r"[A-Za-z_$#][\w.$#]*")
_NUMBERED = re.compile(r"([A-Za-z_$]+)(?:\[|#\(|_NUM\s*=\s*)\s*(\d+)")
_BRACKETED = re.compile(r"\[\s*\d+\s*:\s*([^\]]+)\]")
_BANK = re.compile(r"([A-Z]+)0*(\d+)$")
# Languages whose data has numbers: the banks of their variables. The points of a program are not among them.
_BANKS = {
    "tp": frozenset(("R", "PR", "SR", "F", "TIMER")),
    "inform": frozenset(("B", "I", "D", "R", "S", "P", "BP", "EX", "LB", "LI", "LD", "LR", "LS", "LP")),
}
# Routines that every program of the language has.
_PROGRAMS = {"val3": frozenset(("start", "stop")), "rapid": frozenset(("main",))}
# Words that people put before a number of a tool, a frame, a register or a signal that has no name.
_KINDS = frozenset(("t", "w", "tool", "wobj", "base", "frame", "load", "uframe", "utool", "r", "nr", "pr", "p", "j"))
_KINDS |= frozenset(("point", "di", "do", "ai", "ao", "gi", "go", "f", "flag", "timer", "b", "i", "d", "s", "n"))


def squashed(name: str) -> str:
    """The name by its letters and digits alone."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


def known_names(read: ReadProgram, translation: Translation) -> frozenset[str]:
    """What may stand in the output without being a helper, squashed: the words of the source, names beside its numbers,
    what the translation records for one of them, and the kind of a thing with the number that it has in the source."""
    words: set[str] = set()
    for source in read.sources:
        words.update(map(squashed, _WORD.findall(source.text)))
        words.update(map(squashed, _BRACKETED.findall(source.text)))
        words.add(squashed(re.split(r"[\\/]", source.path)[-1].rpartition(".")[0]))
        for word, number in _NUMBERED.findall(source.text):
            words.add(squashed(word) + str(int(number)))
            words.update(kind + str(int(number)) for kind in _KINDS)
    words.update(squashed(new) for old, new in translation.renamed.items() if squashed(old) in words)
    return frozenset(words - {""})


def helper_names(read: ReadProgram, translation: Translation, back: ReadProgram, target: str) -> list[str]:
    """The names that what was written declares and that are none of the known ones, in order. A number of a bank counts
    by the name that the translation records for it. Files, labels, signals, points with numbers of a program, fields
    of records and the controller's own names do not count."""
    known, own = known_names(read, translation), _own_names(target)
    banks, numbers = _BANKS.get(target), translation.registers
    found: dict[str, None] = {}
    for name, is_routine in _declared(back.program):
        shown, numbered = name, _BANK.match(name)
        if banks is not None and not is_routine:
            if numbered is None or numbered[1] not in banks:
                continue
            shown = numbers.get((numbered[1], int(numbered[2])), name)
        if name.lower() in own or squashed(shown) in known or _as_given(squashed(shown), known):
            continue
        found.setdefault(shown)
    return list(found)


def _as_given(name: str, known: frozenset[str]) -> bool:
    """A name of the source behind the letter that people of the brand put before one (`XPick`, `pPick`, `tGun`)."""
    return len(name) > 3 and name[1:] in known


def _own_names(target: str) -> frozenset[str]:
    prelude = registry.dialect(target).prelude()
    names = set(registry.target(target).capabilities().names.predefined | _PROGRAMS.get(target, frozenset()))
    if prelude is not None:
        names.update(one.name.lower() for one in prelude.declarations if isinstance(one, ir.Variable))
        names.update(one.name.lower() for one in prelude.routines)
    return frozenset(names)


def _declared(program: ir.Program) -> Iterator[tuple[str, bool]]:
    """Names that are declared, and whether it is a routine's."""
    for module in program.modules:
        yield from ((name, False) for name in _variables(module.declarations))
        for routine in module.routines:
            yield routine.name, True
            yield from ((one.name, False) for one in routine.parameters)
            yield from ((name, False) for name in _variables(routine.declarations))


def _variables(declarations: tuple[ir.Declaration, ...]) -> Iterator[str]:
    for one in declarations:
        match one:
            case ir.Variable(name=name) | ir.RecordDeclaration(name=name) | ir.EnumDeclaration(name=name):
                yield name


def family(name: str) -> str:
    """The name without its number, under which helpers of one kind are counted together."""
    return re.sub(r"_?\d+$", "", name) or name
