"""RAPID's installed data types as IR types. One table; types that only vendor instructions use are VendorTypes."""

from __future__ import annotations

from rpl import ir
from rpl.words import spelled

from .words import WORDS

NUM = ir.RealType()
SIGNALS = spelled(WORDS.pairs("signal_types"))
_NUMBERS = WORDS.listed("number_types")
# An installed record that is not described here stays a reference to something unknown.
_VENDOR = WORDS.listed("vendor_types")

TYPES: dict[str, ir.Type] = {
    **dict.fromkeys(_NUMBERS, NUM),
    **{name: ir.VendorType("rapid", name) for name in _VENDOR},
    **{name: ir.SignalType(kind) for name, kind in SIGNALS.items()},
    "bool": ir.BoolType(),
    "switch": ir.BoolType(),
    "string": ir.StringType(),
    "pos": ir.VectorType(),
    "orient": ir.RotationType(),
    "pose": ir.PoseType(),
    "confdata": ir.ConfigType("rapid"),
    "extjoint": ir.ExternalType(),
    "robjoint": ir.AxesType(),
    "robtarget": ir.TargetType("rapid"),
    "jointtarget": ir.JointsType(),
    "tooldata": ir.ToolType(),
    "wobjdata": ir.WorkObjectType(),
    "loaddata": ir.LoadType(),
    "speeddata": ir.SpeedType(),
    "zonedata": ir.ZoneType(),
    "clock": ir.ClockType(),
    "intnum": ir.InterruptType(),
    "triggdata": ir.TriggerType(),
}
