"""What KRL's own names mean in neutral terms: `words.toml` as the reader asks it, in small letters, and what only the
reader knows: types, what a controller measures, vendor technology calls.

Sources are the system variable and expert programming manuals unless a row says `M` (from memory, tested
as a hypothesis).
"""

from __future__ import annotations

from rpl import ir
from rpl.registry import words
from rpl.words import lowered

_WORDS = words("krl")

BASIC_TYPES: dict[str, ir.Type] = {
    "int": ir.IntType(),
    "real": ir.RealType(),
    "bool": ir.BoolType(),
    "char": ir.CharType(),
    "frame": ir.PoseType(),
    "pos": ir.TargetType("krl", external=False),
    "e6pos": ir.TargetType("krl"),
    "axis": ir.JointsType(external=False),
    "e6axis": ir.JointsType(),
    "e3pos": ir.TargetType("krl"),  # the same with three external axes; more are zero
    "e3axis": ir.JointsType(),
}

_UNITS = _WORDS.pairs("units")


def _measured(table: dict[str, str]) -> dict[str, tuple[str, str]]:
    """Name in small letters -> neutral variable and KRL's unit ("" when it is the neutral one)."""
    return {name: (neutral, _UNITS.get(neutral, "")) for name, neutral in lowered(table).items()}


SCALARS = _measured(_WORDS.pairs("scalars"))
INDEXED = _measured(_WORDS.pairs("indexed"))
COUNTED = frozenset(name for name, (neutral, _) in (SCALARS | INDEXED).items() if neutral in _WORDS.listed("counted"))
STRUCTURES = {name.lower(): _measured(parts) for name, parts in _WORDS.nested("structures").items()}
# What a controller measures or knows of its arm, with the type of what is read; a cell file can give the values.
MEASURED: dict[str, ir.Type] = {
    **dict.fromkeys(("$softn_end", "$softp_end", "$vel_axis_act", "$torque_axis_act", "$curr_act"), ir.RealType()),
    **dict.fromkeys(("$vel_ma", "$acc_ma", "$vel_axis_ma", "$distance", "$pathtime", "$mot_temp"), ir.RealType()),
    **dict.fromkeys(("$robruntime", "$date", "$interpreter"), ir.IntType()),
    **dict.fromkeys(("$in_home1", "$in_home2", "$in_home3", "$in_home4", "$in_home5"), ir.BoolType()),
}
# A flag is read as a variable of the system.
SIGNALS = {name.lower(): kind for kind, name in _WORDS.pairs("signals").items() if name.lower() not in INDEXED}
GROUP_KINDS = {SIGNALS[name.lower()]: kind for kind, name in _WORDS.pairs("groups").items()}
ALWAYS_TRUE_INPUT, ALWAYS_FALSE_INPUT = 1025, 1026

MODES = {variable: lowered(members) for variable, members in _WORDS.nested("modes").items()}
FUNCTIONS = lowered(_WORDS.pairs("functions"))
TEXT_PROCEDURES = lowered(_WORDS.pairs("text_procedures"))
TEXT_LENGTHS = _WORDS.pairs("text_lengths")
MESSAGES = lowered(_WORDS.pairs("messages"))
# M: $IN_HOME is TRUE while each axis is within so many degrees of $H_POS ($H_POS_TOL as delivered).
HOME_TOLERANCE_DEG = 2
# M: data of KSS 5 has no CIRC_TYP; its BAS leaves $CIRC_TYPE as it is, which is #BASE behind BAS(#INITMOV,0).
# Nor has it an APO_MODE of joint moves: APO_DIST is a percentage there.
USUAL_COMPONENTS: dict[str, dict[str, str]] = {"ldat": {"circ_typ": "BASE"}, "pdat": {"apo_mode": "CPTP"}}

# Calls into technology packages, by how the routine's name begins. Effect: what a run must know of it.
VENDOR_CALLS: tuple[tuple[str, str], ...] = (
    ("on_error_proceed", "none"),
    ("err_clear", "none"),
    ("err_raise", "message"),
    ("set_cd_params", "tuning"),
    ("collmon", "tuning"),
    ("use_cm_pro_values", "tuning"),
    ("delete_backward_buffer", "none"),
    ("cread", "unknown"),
    ("cwrite", "unknown"),
    ("copen", "unknown"),
    ("cclose", "unknown"),
    ("cioctl", "unknown"),
    ("cast_to", "unknown"),
    ("cast_from", "unknown"),
    ("eki_", "unknown"),
    ("rsi_", "unknown"),
    ("st_", "unknown"),
    ("h50", "unknown"),
    ("h70", "unknown"),
    ("a10", "unknown"),
    ("a20", "unknown"),
    ("arc_", "unknown"),
    ("grp", "unknown"),
    ("asyptp", "unknown"),
    ("asycont", "unknown"),
    ("asystop", "unknown"),
)


def vendor_effect(name: str) -> str | None:
    """The declared effect of a technology call by its routine's lower-case name; None when it is none."""
    for beginning, effect in VENDOR_CALLS:
        if name.startswith(beginning):
            return effect
    return None
