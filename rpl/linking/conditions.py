"""Conditions that programs wait for: what can make one true."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.ir.walk import children
from rpl.runtime.functions import neutral, system

if TYPE_CHECKING:
    from rpl.linking.symbols import Symbols


def depends_on_time(condition: ir.Expression, linked: Symbols) -> bool:
    """Can the condition become true without anybody doing anything? A cyclic flag is what the program gives it."""
    stack: list[object] = [condition]
    bound = False
    while stack:
        node = stack.pop()
        match node:
            case ir.System(name=name) if name in system.TIME_DEPENDENT:
                return True
            case ir.Builtin(function=function) if function in neutral.TIME_DEPENDENT:
                return True
            case ir.System(name="cyclic_flag") if not bound:
                bound = True
                stack.extend(linked.cyclic)
        stack.extend(children(node))
    return False
