"""Which variables any statement of a program may set, whole or in part: one look over all statements, asked by name."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import walk


@dataclass(frozen=True, slots=True)
class Settable:
    """`keys`: variables (`pr4`) and elements (`pr[4]`, by a computed number `pr[]`), folded; `lists`: the variables of
    which elements are set. `anything`: something is called whose statements nobody has read."""

    keys: frozenset[str]
    lists: frozenset[str]
    anything: bool

    def may_set(self, key: str) -> bool:
        """May anything set the variable or element, or a part of it? A key that ends with `[]` is the whole list."""
        name, bracket, _ = key.partition("[")
        if self.anything or key in self.keys or name in self.keys or f"{name}[]" in self.keys:
            return True
        return bracket != "" and key.endswith("[]") and name in self.lists


def settable(program: ir.Program) -> Settable:
    """What the statements of all routines, their triggers and interrupts may set. A routine that is not in the program
    or whose name is computed, an instruction that only the controller knows and text that could not be read may set
    anything."""
    routines = {one.name.lower(): one for module in program.modules for one in module.routines}
    keys: set[str] = set()
    anything = False
    for node in walk(*program.modules):
        match node:
            case ir.CallRoutine(dynamic=computed) if computed is not None:
                anything = True
            case ir.CallRoutine(name=name) | ir.Call(name=name) | ir.TaskControl(op="start", task=name):
                routine = routines.get(name.lower())
                anything = anything or routine is None
                keys.update(_changed(routine, node.arguments))
            case ir.Opaque() | ir.Vendor(effect="unknown"):
                anything = True
            case ir.For(counter=counter):
                keys.add(counter.lower())
            case _:
                keys.update(map(_key, written_places(node)))
    keys.discard("")
    return Settable(frozenset(keys), frozenset(one.partition("[")[0] for one in keys if "[" in one), anything)


def written_places(statement: object) -> Sequence[ir.Expression]:
    """What a statement writes, its calls not looked at. What a procedure gets counts as written."""
    match statement:
        case ir.Assign(target=target):
            return (target,)
        case ir.Do(arguments=values):
            return [value for value in values if value is not None]
        case ir.Move(search=ir.Search(found=found, hit=hit)):
            return [value for value in (found, hit) if value is not None]
        case ir.DefineTrigger(target=target):
            return (target,)
    named = (getattr(statement, part, None) for part in ("answer", "timed_out", "clock"))
    return [value for value in named if isinstance(value, ir.Name | ir.Index | ir.Field)]


def _changed(routine: ir.Routine | None, arguments: Sequence[ir.Argument]) -> Iterable[str]:
    """What a call gives to the routine in a way in which it could be changed."""
    modes = [one.mode for one in routine.parameters] if routine is not None else []
    for at, argument in enumerate(arguments):
        if argument.name is not None or at >= len(modes) or modes[at] != "value":
            yield _key(argument.value)


def _key(place: object) -> str:
    """The variable or element of which the place is the whole or a part; empty for what is no place."""
    index: ir.Index | None = None
    while isinstance(place, ir.Field | ir.Index):
        index = place if isinstance(place, ir.Index) else index
        place = place.base
    if not isinstance(place, ir.Name):
        return ""
    name = place.id.lower()
    if index is None:
        return name
    match index.indices:
        case (ir.IntLiteral(value=value),):
            return f"{name}[{value}]"
    return f"{name}[]"


__all__ = ["Settable", "settable", "written_places"]
