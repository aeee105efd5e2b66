"""What every RAPID program finds declared: speeds, zones, tool0, wobj0, error numbers, vendor functions.

Sources: reference manual, system data types (speeddata, zonedata, tooldata, wobjdata). Error numbers are names without
published values; the values here only have to differ from each other and from the 1..90 a program may raise.
"""

from __future__ import annotations

from functools import cache

from rpl import ir

from .types import NUM, TYPES
from .vendor import FUNCTION_RESULTS

# name: path mm/s; reorientation is 500 deg/s, external axes 5000 mm/s and 1000 deg/s.
_SPEEDS = (5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800)
_FAST = (1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000)
VMAX_MM_S = 5000.0  # depends on the robot on newer controllers
_ROTARY = (1, 2, 5, 10, 20, 50, 100)  # vrotN: external rotation deg/s
_LINEAR = (10, 20, 50, 100, 200, 500, 1000)  # vlinN: external linear mm/s

# name: path, rotation on the path, external on the path (mm), rotation deg, linear external mm, rotary external deg
_ZONES = """
    z0    0.3   0.3   0.3  0.03   0.3  0.03
    z1      1     1     1   0.1     1   0.1
    z5      5     8     8   0.8     8   0.8
    z10    10    15    15   1.5    15   1.5
    z15    15    23    23   2.3    23   2.3
    z20    20    30    30     3    30     3
    z30    30    45    45   4.5    45   4.5
    z40    40    60    60     6    60     6
    z50    50    75    75   7.5    75   7.5
    z60    60    90    90     9    90     9
    z80    80   120   120    12   120    12
    z100  100   150   150    15   150    15
    z150  150   225   225    23   225    23
    z200  200   300   300    30   300    30
"""

_ERRORS = """
    ERR_ALRDYCNT ERR_ALRDY_MOVING ERR_AO_LIM ERR_ARGDUPCND ERR_ARGNAME ERR_ARGNOTPER ERR_ARGNOTVAR ERR_ARGVALERR
    ERR_AXIS_ACT ERR_AXIS_IND ERR_AXIS_MOVING ERR_AXIS_PAR ERR_BWDLIMIT ERR_CALLIO_INTER ERR_CALLPROC ERR_CFG_INTERNAL
    ERR_CFG_ILLTYPE ERR_CFG_LIMIT ERR_CFG_NOTFND ERR_CFG_OUTOFBOUNDS ERR_CNTNOTVAR ERR_CNV_NOT_ACT ERR_CNV_CONNECT
    ERR_CNV_DROPPED ERR_COMM_EXT ERR_COMM_INIT ERR_COMM_INIT_FAILED ERR_CONC_MAX ERR_DATA_RECV ERR_DEV_MAXTIME
    ERR_DIPLAG_LIM ERR_DIVZERO ERR_EXECPHR ERR_FILEACC ERR_FILEEXIST ERR_FILEOPEN ERR_FILESIZE ERR_FNCNORET ERR_FRAME
    ERR_GO_LIM ERR_ILLDIM ERR_ILLQUAT ERR_ILLRAISE ERR_INDCNV_ORDER ERR_INOISSAFE ERR_INOMAX ERR_INT_MAXVAL
    ERR_INT_NOTVAL ERR_INVDIM ERR_IODISABLE ERR_IOENABLE ERR_IOERROR ERR_LINKREF ERR_LOADED ERR_LOADID_FATAL
    ERR_LOADID_RETRY ERR_LOADNO_INUSE ERR_LOADNO_NOUSE ERR_MAXINTVAL ERR_MODULE ERR_MOD_NOTLOADED ERR_MSG_PENDING
    ERR_NAME_INVALID ERR_NEGARG ERR_NORUNUNIT ERR_NOTARR ERR_NOTEQDIM ERR_NOTINTVAL ERR_NOTPRES ERR_NOTSAVED
    ERR_NO_ALIASIO_DEF ERR_NO_SGUN ERR_NUM_LIMIT ERR_OUTOFBND ERR_OVERFLOW ERR_OUTSIDE_REACH ERR_PATH ERR_PATHDIST
    ERR_PATH_STOP ERR_PERSSUPSEARCH ERR_PID_MOVESTOP ERR_PID_RAISE_PP ERR_PRGMEMFULL ERR_PROCSIGNAL_OFF
    ERR_PROGSTOP ERR_RANYBIN_CHK ERR_RANYBIN_EOF ERR_RCVDATA ERR_REFUNKDAT ERR_REFUNKFUN ERR_REFUNKPRC ERR_REFUNKTRP
    ERR_RMQ_DIM ERR_RMQ_FULL ERR_RMQ_INVALID ERR_RMQ_INVMSG ERR_RMQ_MSGSIZE ERR_RMQ_NAME ERR_RMQ_NOMSG ERR_RMQ_TIMEOUT
    ERR_RMQ_VALUE ERR_ROBLIMIT ERR_SC_WRITE ERR_SIGSUPSEARCH ERR_SIG_NOT_VALID ERR_SOCK_ADDR_INUSE ERR_SOCK_CLOSED
    ERR_SOCK_IS_BOUND ERR_SOCK_IS_CONN ERR_SOCK_NET_UNREACH ERR_SOCK_NOT_BOUND ERR_SOCK_NOT_CONN ERR_SOCK_NOT_DEF
    ERR_SOCK_NOT_STREAM ERR_SOCK_TIMEOUT ERR_SOCK_UNSPEC ERR_SPEEDLIM_VALUE ERR_SPEED_REFRESH_LIM ERR_STARTMOVE
    ERR_STORE_PROF ERR_STRTOOLNG ERR_SYM_ACCESS ERR_SYNCMOVEOFF ERR_SYNCMOVEON ERR_SYNTAX ERR_TASKNAME ERR_TP_DIBREAK
    ERR_TP_DOBREAK ERR_TP_MAXTIME ERR_TP_NO_CLIENT ERR_TRUSTLEVEL ERR_TXTNOEXIST ERR_UDPUC_COMM ERR_UI_BUTTONS
    ERR_UI_ICON ERR_UI_INITVALUE ERR_UI_MAXMIN ERR_UI_NOTINT ERR_UISHOW_FATAL ERR_UISHOW_FULL ERR_UNIT_PAR ERR_UNKINO
    ERR_UNKPROC ERR_UNLOAD ERR_USE_PROFILE ERR_WAITSYNCTASK ERR_WAIT_MAXTIME ERR_WHLSEARCH ERR_WOBJ_MOVING
    LONG_JMP_ALL_ERR
"""
ERRORS: dict[str, int] = {name: 1001 + index for index, name in enumerate(_ERRORS.split())}

_NUMBERS: dict[str, float] = {
    "pi": 3.141592653589793,
    "low": 0,
    "high": 1,
    "edge": 2,
    "WAIT_MAX": 9999999,
    "EOF_NUM": 9998,
    "COMMON_ERR": 0,
    "OP_STATE": 1,
    "SYSTEM_ERR": 2,
    "HARDWARE_ERR": 3,
    "PROGRAM_ERR": 4,
    "MOTION_ERR": 5,
    "OPERATOR_ERR": 6,
    "IO_COM_ERR": 7,
    "USER_DEF_ERR": 8,
    "PROCESS_ERR": 11,
    "TYPE_ALL": 0,
    "TYPE_STATE": 1,
    "TYPE_WARN": 2,
    "TYPE_ERR": 3,
    "TP_LATEST": 1,
    "TP_PROGRAM": 2,
    "TP_SCREENVIEWER": 3,
    "OP_UNDEF": 0,
    "OP_AUTO": 1,
    "OP_MAN_PROG": 2,
    "OP_MAN_TEST": 3,
    "RUN_UNDEF": 0,
    "RUN_CONT_CYCLE": 1,
    "RUN_INSTR_FWD": 2,
    "RUN_INSTR_BWD": 3,
    "RUN_SIM": 4,
    "resUnkwn": 0,
    "resOK": 1,
    "resAbort": 2,
    "resRetry": 3,
    "resIgnore": 4,
    "resCancel": 5,
    "resYes": 6,
    "resNo": 7,
    "btnNone": -1,
    "btnOK": 0,
    "btnAbrtRtryIgn": 1,
    "btnOKCancel": 2,
    "btnRetryCancel": 3,
    "btnYesNo": 4,
    "btnYesNoCancel": 5,
    "iconNone": 0,
    "iconInfo": 1,
    "iconWarning": 2,
    "iconError": 3,
    "LT": -1,
    "EQ": 0,
    "GT": 1,
    "LTEQ": -2,
    "GTEQ": 2,
    "NOTEQ": 3,
    "SOCKET_CREATED": 1,
    "SOCKET_CONNECTED": 2,
    "SOCKET_BOUND": 3,
    "SOCKET_LISTENING": 4,
    "SOCKET_CLOSED": 5,
    "UINT": 1,
    "USINT": 2,
    "UDINT": 3,
    "ULINT": 4,
    "INT": 5,
    "SINT": 6,
    "DINT": 7,
    "LINT": 8,
    "EVENT_NONE": 0,
    "EVENT_POWERON": 1,
    "EVENT_START": 2,
    "EVENT_STOP": 3,
    "EVENT_QSTOP": 4,
    "EVENT_RESTART": 5,
    "EVENT_RESET": 6,
    "EVENT_STEP": 7,
    "inpos": 1,
    "stoptime": 2,
    "fllwtime": 3,
    "HANDLER_NONE": 0,
    "HANDLER_BWD": 1,
    "HANDLER_ERR": 2,
    "HANDLER_UNDO": 3,
    "AIO_ABOVE_HIGH": 1,
    "AIO_BELOW_HIGH": 2,
    "AIO_ABOVE_LOW": 3,
    "AIO_BELOW_LOW": 4,
    "AIO_BETWEEN": 5,
    "AIO_OUTSIDE": 6,
    "AIO_ALWAYS": 7,
    "OpAdd": 1,
    "OpSub": 2,
    "OpMult": 3,
    "OpDiv": 4,
    "OpMod": 5,
}
_UPPER = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
_TEXTS = {
    "stEmpty": "",
    "STR_DIGIT": "0123456789",
    "STR_UPPER": _UPPER,
    "STR_LOWER": _UPPER.lower(),
    "STR_WHITE": " ",
    "diskhome": "HOME:",
    "ERRSTR_TASK": "",
    "ERRSTR_CONTEXT": "",
    "ERRSTR_EMPTY": "",
    "ERRSTR_UNUSED": "",
}


_TEXT = ir.StringType()
_EVENTS: tuple[tuple[str, ir.Type], ...] = (
    ("used", ir.BoolType()),
    ("distance", NUM),
    ("start", ir.BoolType()),
    ("equiplag", NUM),
    ("signalname", _TEXT),
)
_RECORDS: dict[str, tuple[tuple[str, ir.Type], ...]] = {
    "tasks": (("taskname", _TEXT),),
    "listitem": (("image", _TEXT), ("text", _TEXT)),
    "inposdata": (("position", NUM), ("speed", NUM), ("mintime", NUM), ("maxtime", NUM)),
    "stoppointdata": (
        ("type", NUM),
        ("progsynch", ir.BoolType()),
        ("inpos", ir.NamedType("inposdata")),
        ("stoptime", NUM),
        ("followtime", NUM),
        ("signal", _TEXT),
        ("relation", NUM),
        ("checkvalue", NUM),
    ),
    "triggios": (*_EVENTS, ("setvalue", NUM), ("xxx", NUM)),
    "triggiosdnum": (*_EVENTS, ("setdvalue", NUM), ("xxx", NUM)),
    "triggstrgo": (*_EVENTS, ("setvalue", _TEXT), ("xxx", NUM)),
}
_STOP_POINTS = (
    "inpos20",
    "inpos50",
    "inpos100",
    "stoptime0_5",
    "stoptime1_0",
    "stoptime1_5",
    "fllwtime0_5",
    "fllwtime1_0",
)


def _literal(number: float) -> ir.Expression:
    whole = isinstance(number, int) or number.is_integer()
    size: ir.Expression = ir.IntLiteral(int(abs(number))) if whole else ir.RealLiteral(abs(number))
    return ir.Unary("-", size) if number < 0 else size


def _list(*values: float | ir.Expression) -> ir.Aggregate:
    entries = (value if not isinstance(value, int | float) else _literal(value) for value in values)
    return ir.Aggregate(tuple((None, entry) for entry in entries))


def _constant(name: str, type: ir.Type, value: ir.Expression, storage: str = "constant") -> ir.Variable:
    return ir.Variable(name, type, value, storage, "global")


def _speeds() -> list[ir.Variable]:
    rows = [(f"v{path}", float(path), 500.0, 5000.0, 1000.0) for path in (*_SPEEDS, *_FAST)]
    rows.append(("vmax", VMAX_MM_S, 500.0, 5000.0, 1000.0))
    rows.extend((f"vrot{turn}", 0.0, 0.0, 0.0, float(turn)) for turn in _ROTARY)
    rows.extend((f"vlin{way}", 0.0, 0.0, float(way), 0.0) for way in _LINEAR)
    return [_constant(name, ir.SpeedType(), _list(*values)) for name, *values in rows]


def _zones() -> list[ir.Variable]:
    zone = ir.ZoneType()
    made = [_constant("fine", zone, _list(ir.BoolLiteral(True), 0, 0, 0, 0, 0, 0))]
    for row in _ZONES.strip().splitlines():
        name, *sizes = row.split()
        made.append(_constant(name, zone, _list(ir.BoolLiteral(False), *map(float, sizes))))
    return made


def _frames() -> list[ir.Variable]:
    true, false = ir.BoolLiteral(True), ir.BoolLiteral(False)
    origin, straight = _list(0, 0, 0), _list(1, 0, 0, 0)
    pose = _list(origin, straight)
    load = _list(0.001, _list(0, 0, 0.001), straight, 0, 0, 0)
    return [
        _constant("tool0", ir.ToolType(), _list(true, pose, load), "persistent"),
        _constant("wobj0", ir.WorkObjectType(), _list(false, true, ir.TextLiteral(""), pose, pose), "persistent"),
        _constant("load0", ir.LoadType(), load, "persistent"),
    ]


def _functions() -> tuple[ir.Routine, ...]:
    """Vendor functions as predefined routines that take anything; a run that reaches one has to be told its result."""
    made = []
    for name, result in FUNCTION_RESULTS.items():
        body = (ir.Vendor("rapid", f"{name}(...)", "unknown"),)
        made.append(ir.Routine(name, "function", (), TYPES[result], (), body, scope="global", open_ended=True))
    return tuple(made)


@cache
def prelude() -> ir.Module:
    """The predefined data and routines as a module."""
    declarations: tuple[ir.Declaration, ...] = (
        *_speeds(),
        *_zones(),
        *_frames(),
        *(_constant(name, NUM, _literal(value)) for name, value in _NUMBERS.items()),
        *(_constant(name, ir.StringType(), ir.TextLiteral(text)) for name, text in _TEXTS.items()),
        *(_constant(name, NUM, ir.IntLiteral(number)) for name, number in ERRORS.items()),
        *(ir.RecordDeclaration(name, fields, "global") for name, fields in _RECORDS.items()),
        *(ir.Variable(name, ir.NamedType("stoppointdata"), None, "constant", "global") for name in _STOP_POINTS),
    )
    return ir.Module("rapid_prelude", "rapid", declarations, _functions())


PREDEFINED_NAMES = frozenset(
    declaration.name.lower() for declaration in prelude().declarations if isinstance(declaration, ir.Variable)
)
