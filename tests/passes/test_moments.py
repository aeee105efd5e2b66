"""From a moment in front of a pass on, its context knows what it knew then."""

from dataclasses import fields, replace

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.moments import Moment, note
from rpl.source import NOWHERE


def test_what_a_pass_found_is_forgotten() -> None:
    target = registry.target("tp").capabilities_under({})
    context = Context("krl", "tp", target, Diagnostics())
    before = {one.name: repr(getattr(context, one.name)) for one in fields(context)}
    moments: list[Moment] = []
    note(moments, 0, ir.Program(()), context)
    context.fresh("one")
    context.register_names["R", 1] = context.register_types["R", 1] = "one"
    context.signal_groups["one"] = ir.Signal("digital_in", ir.IntLiteral(1))
    context.signal_names["digital_in", 1] = "one"
    context.not_reached(replace(NOWHERE), "place", "it is too far")
    context.flanges.append(None)
    moments.pop().restore(context)
    assert {one.name: repr(getattr(context, one.name)) for one in fields(context)} == before
