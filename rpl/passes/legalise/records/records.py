"""Tools, work objects, loads, speeds, zones and the like as records, for targets without these types.

Components keep their names, so that field access is unchanged; vectors and rotations inside are poses.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir, registry
from rpl.passes.legalise.context import Context

RECORDS: dict[type, str] = {
    ir.ToolType: "tool",
    ir.WorkObjectType: "workobject",
    ir.LoadType: "load",
    ir.SpeedType: "speed",
    ir.ZoneType: "zone",
    ir.ExternalType: "external",
    ir.ConfigType: "configuration",
}


_TEXT = 32  # characters of a name inside of a record


@dataclass(slots=True)
class Records:
    """The records asked for so far."""

    context: Context
    names: dict[type, str] = field(default_factory=dict)
    made: list[ir.RecordDeclaration] = field(default_factory=list)

    def type(self, type: ir.Type) -> ir.NamedType:
        """The record that stands for a built-in type."""
        kind = type.__class__
        if kind not in self.names:
            name = self.context.fresh(f"rpl_{RECORDS[kind]}")
            self.names[kind] = name
            if isinstance(type, ir.ConfigType):
                fields = tuple((one, self.inner(ir.RealType())) for one in _flags(type))
            else:
                fields = tuple((one, self.inner(inner)) for one, inner in ir.COMPONENTS[kind].items())
            self.made.append(ir.RecordDeclaration(name, fields, scope="global"))
        return ir.NamedType(self.names[kind])

    def inner(self, type: ir.Type) -> ir.Type:
        if isinstance(type, ir.VectorType | ir.RotationType):
            return ir.PoseType()
        if isinstance(type, ir.StringType):
            return ir.StringType(ir.IntLiteral(_TEXT))
        return self.type(type) if type.__class__ in RECORDS else type

    def word(self, type: ir.Type) -> str | None:
        """The record's name for an aggregate of a built-in type that became one."""
        lacks = type.__class__.__name__ not in self.context.capabilities.types
        return self.type(type).name if type.__class__ in RECORDS and lacks else None

    def declarations(self) -> tuple[ir.Declaration, ...]:
        """In an order in which each knows what it contains."""
        return tuple(self.made)


def _flags(type: ir.ConfigType) -> tuple[str, ...]:
    return registry.dialect(type.notation).notation_fields
