"""Result types of operators, conversions and built-in functions, and which types clash.

Pure tables and functions of types alone: nothing here looks at an expression or a scope.
"""

from __future__ import annotations

from rpl import ir

INT, REAL, BOOL, CHAR, TEXT = ir.IntType(), ir.RealType(), ir.BoolType(), ir.CharType(), ir.StringType()
ORDERED = frozenset(("=", "<>", "<", ">", "<=", ">="))
LOGIC = frozenset(("and", "or", "xor", "cand", "cor"))
BITS = frozenset(("band", "bor", "bxor", "div", "mod"))
# By the letters of ir.FUNCTIONS and ir.SYSTEM_VARIABLES.
KIND_TYPES: dict[str, ir.Type] = {
    "n": REAL,
    "i": INT,
    "b": BOOL,
    "t": TEXT,
    "c": CHAR,
    "v": ir.VectorType(),
    "r": ir.RotationType(),
    "j": ir.JointsType(),
    "J": ir.JointsType(),
    "P": ir.PoseType(),
    "T": ir.ToolType(),
    "W": ir.WorkObjectType(),
    "L": ir.LoadType(),
}
CONVERTED: dict[str, ir.Type] = {
    "real": REAL,
    "round_half_away": INT,
    "trunc": INT,
    "bit": INT,
    "truth": BOOL,
    "code": INT,
    "char": CHAR,
    "minus_bit": INT,
    "floor": INT,
}
_TEXTS = (ir.StringType, ir.CharType)


def quotient(left: ir.Type | None, right: ir.Type | None) -> tuple[str, ir.Type | None]:
    """What a division by the operands' types is, and its type."""
    if isinstance(left, ir.IntType) and isinstance(right, ir.IntType):
        return "div", INT
    if isinstance(left, ir.RealType) or isinstance(right, ir.RealType):
        return "/", REAL
    return "quo", None


def arithmetic(op: str, left: ir.Type | None, right: ir.Type | None, text_plus: bool) -> tuple[str, ir.Type | None]:
    """The neutral operator that `op` means between these types, and its type."""
    if op == "&" or (op == "+" and text_plus and (isinstance(left, _TEXTS) or isinstance(right, _TEXTS))):
        return "&", TEXT
    if op == "*" and isinstance(left, ir.VectorType) and isinstance(right, ir.VectorType):
        return "@", left
    if op == "*" and isinstance(left, ir.RotationType):
        return ":", left
    for type in (left, right):
        if isinstance(type, ir.VectorType):
            return op, type
    if op in ("/", "**"):
        return op, REAL
    if left is None or right is None:
        return op, None
    if isinstance(left, ir.IntType) and isinstance(right, ir.IntType):
        return op, INT
    return op, REAL


def pose_result(function: str, types: list[ir.Type | None], notation: str) -> ir.Type | None:
    """Poses keep the kind of what they are made from; positions of the robot are targets."""
    if function in ("current_target", "joints_to_target"):
        return ir.TargetType(notation)
    if function == "compose":
        return types[-1] if types else None
    return ir.PoseType()


def system_type(name: str, notation: str) -> ir.Type | None:
    """Type of a neutral system variable; the robot's own positions are targets of the notation."""
    row = ir.SYSTEM_VARIABLES.get(name)
    if row is None:
        return None
    if row.type == "P" and row.access == "r" and name.endswith("_pose"):
        return ir.TargetType(notation)
    return KIND_TYPES.get(row.type)


def has_components(type: ir.Type | None) -> bool:
    """Can an aggregate be written for the type?"""
    return isinstance(type, ir.NamedType | ir.ArrayType) or type.__class__ in ir.POSITIONAL


NUMBERS = frozenset((ir.IntLiteral, ir.RealLiteral))


def is_number(expression: ir.Expression) -> bool:
    """Is it a number that is written out, with or without a minus?"""
    if isinstance(expression, ir.Unary) and expression.op == "-":
        expression = expression.operand
    return expression.__class__ in NUMBERS


def clash(wanted: ir.Type, found: ir.Type, exact: bool = False) -> bool:
    """Certainly incompatible: a text, number or BOOL where another of these is needed. `exact`: of the built-in types
    with components each is one of its own, and so is each declared record (which the scope has resolved)."""
    one, other = _kind(wanted, exact), _kind(found, exact)
    return one is not None and other is not None and one != other


def _kind(type: ir.Type, exact: bool) -> str | None:
    """One word for all types that fit each other; None where nothing is known of the type."""
    if exact and (type.__class__ in ir.POSITIONAL or isinstance(type, ir.ClockType | ir.TriggerType)):
        return type.__class__.__name__
    if exact and isinstance(type, ir.NamedType):
        return f"record {type.name.lower()}"
    return _CLASHING.get(type.__class__)


_CLASHING: dict[type, str] = {
    ir.IntType: "number",
    ir.RealType: "number",
    ir.StringType: "text",
    ir.CharType: "text",
    ir.BoolType: "bool",
}


def sign(expression: ir.Expression, type: ir.Type | None) -> ir.Type | None:
    """A text that is written out and of one sign is a character, where characters are numbers too."""
    return CHAR if isinstance(expression, ir.TextLiteral) and len(expression.value) == 1 else type
