"""Puts instructions in a row: labels, jumps that cost nothing, and which statement each instruction belongs to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from rpl.errors import InternalError
from rpl.runtime.code import Code, Instruction
from rpl.source import NOWHERE, Origin

# Makes an instruction once its own place and that of the next instruction are known.
Make = Callable[[int, int], Instruction]


@dataclass(slots=True, eq=False)
class Label:
    """A place in the row; set when it is reached."""

    position: int | None = None
    pc: int = -9


@dataclass(slots=True, eq=False)
class _Item:
    make: Make | None  # None: a jump to `label`, which takes no instruction
    label: Label | None
    scope: _Scope


@dataclass(slots=True, eq=False)
class _Scope:
    """A statement: where its instructions start, where those of the next statement do."""

    origin: Origin
    start: Label = field(default_factory=Label)
    end: Label = field(default_factory=Label)


class Assembler:
    """Collects instructions and gives them their places. `label.pc` may be used inside instructions that run later."""

    def __init__(self) -> None:
        self.items: list[_Item] = []
        self.labels: list[Label] = []
        self.scope = _Scope(NOWHERE)

    def emit(self, make: Make) -> None:
        self.items.append(_Item(make, None, self.scope))

    def jump(self, label: Label) -> None:
        self.items.append(_Item(None, label, self.scope))

    def place(self, label: Label) -> None:
        """The label stands here."""
        label.position = len(self.items)
        self.labels.append(label)

    def begin(self, origin: Origin) -> _Scope:
        """Start a statement; gives the one around it, for `end`."""
        outer = self.scope
        self.scope = _Scope(origin)
        self.place(self.scope.start)
        return outer

    def end(self, outer: _Scope) -> None:
        self.place(self.scope.end)
        self.scope = outer

    def here(self) -> int:
        return len(self.items)

    def assemble(self, code: Code) -> None:
        """Fill the code with the instructions in their final order."""
        self.place(self.scope.end)
        numbers: list[int] = []
        count = 0
        for item in self.items:
            numbers.append(count)
            count += item.make is not None
        numbers.append(count)
        for label in self.labels:
            label.pc = self._resolve(label, numbers)
        for position, item in enumerate(self.items):
            if item.make is None:
                continue
            following = self._follow(position + 1, numbers)
            code.instructions.append(item.make(numbers[position], following))
            code.origins.append(item.scope.origin)
            code.statements.append((item.scope.start.pc, item.scope.end.pc))

    def _resolve(self, label: Label, numbers: list[int]) -> int:
        if label.position is None:
            raise InternalError("a jump goes to a label that was never placed")
        return self._follow(label.position, numbers)

    def _follow(self, position: int, numbers: list[int]) -> int:
        """The instruction that runs when control reaches a position: jumps are followed."""
        for _ in range(len(self.items) + 1):
            if position >= len(self.items):
                return numbers[-1]
            item = self.items[position]
            if item.make is not None:
                return numbers[position]
            target = item.label
            if target is None or target.position is None:
                raise InternalError("a jump goes to a label that was never placed")
            position = target.position
        raise InternalError("jumps go round in a circle without an instruction")
