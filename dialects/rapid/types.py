"""RAPID's installed data types as IR types. One table; types that only vendor instructions use are VendorTypes."""

from __future__ import annotations

from rpl import ir

from .words import words

NUM = ir.RealType()
SIGNALS = {
    "signaldi": "digital_in",
    "signaldo": "digital_out",
    "signalai": "analog_in",
    "signalao": "analog_out",
    "signalgi": "group_in",
    "signalgo": "group_out",
}
# Aliases of num and byte in the installed types: numbers with a purpose.
_NUMBERS = words(
    """num dnum byte errnum errtype errdomain btnres icondata buttondata tpnum opnum symnum iounit_state tunetype
    paridnum paridvalidnum loadidnum handler_type sensorstate triggmode busstate switchtype opmode runmode dionum
    aiotrigg opcalc"""
)
# Types without components. An installed record that is not described here stays a reference to something unknown.
_VENDOR = words(
    """socketdev socketstatus iodev rawbytes taskid syncident identno wztemporary wzstationary shapedata mecunit
    trapdata corrdescr dir egmident cameradev sensor loadsession rmqmessage
    rmqslot speedlimdata"""
)

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
