"""What analog outputs tell: `get_standard_analog_out` gives volts or amperes where the program says which.

Such a level is written as the plain call; where no program says it, the share of the range is read.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.kinds import walk_for
from rpl.writing.target import WriteContext

_SAYS = "set_analog_outputdomain("


def output_levels(program: ir.Program, context: WriteContext) -> ir.Program:
    """The program with levels of outputs as the controller's own values."""
    said = (
        node.text
        for node in walk_for({"Vendor"}, program)
        if isinstance(node, ir.Vendor) and node.dialect == "urscript"
    )
    if not any(text.startswith(_SAYS) for text in said):
        return program
    return rewrite(program, _level)


def _level(node: object) -> object:
    match node:
        case ir.Binary("*", ir.Signal("analog_out", ir.IntLiteral(value=number)), ir.RealLiteral(10.0)):
            return _read(number)
        case ir.Binary(
            "+",
            ir.Binary("*", ir.Signal("analog_out", ir.IntLiteral(value=number)), ir.RealLiteral(0.016)),
            ir.RealLiteral(0.004),
        ):
            return _read(number)
    return node


def _read(number: int) -> ir.VendorValue:
    return ir.VendorValue("urscript", f"get_standard_analog_out({number - 1})", ir.RealType())


__all__ = ["output_levels"]
