"""Neutral functions that a target lacks, as functions of the program in terms of others: texts in a given order, poses
turned to the axes, the middle of an arc, numbers rounded to a computed count of decimals.

Runs before the passes that find words for products of poses, rotation vectors and texts.
"""

from __future__ import annotations

from typing import TypeGuard

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.helpers import Helpers
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_ROUNDED = {"round": "rpl_round", "trunc": "rpl_cut"}
_HELPERS = {
    "text_order": "rpl_in_order",
    "aligned": "rpl_aligned",
    "arc_middle": "rpl_arc_middle",
}
_TEXTS = {
    # signs of the order in its order, the others behind them by their codes
    "rpl_rank": """
FUNCTION rpl_rank(sign: STRING, order: STRING): INT
    VAR place: INT
    VAR code: INT
    place = text_find(order, 1, sign)
    IF place > 0 THEN RETURN place
    code = character_code(sign)
    RETURN 1000 + code
END FUNCTION
""",
    "rpl_in_order": """
FUNCTION rpl_in_order(one: STRING, other: STRING, order: STRING): BOOL
    VAR i: INT
    VAR size: INT
    VAR first: INT
    VAR second: INT
    VAR sign: STRING
    size = text_length(one)
    IF text_length(other) < size THEN size = text_length(other)
    FOR i = 1 TO size
        sign = text_part(one, i, 1)
        first = rpl_rank(sign, order)
        sign = text_part(other, i, 1)
        second = rpl_rank(sign, order)
        IF first < second THEN RETURN TRUE
        IF first > second THEN RETURN FALSE
    END FOR
    RETURN text_length(one) <= text_length(other)
END FUNCTION
""",
    # turned about the axis across the tool's z and the nearest axis of the frame
    "rpl_aligned": """
FUNCTION rpl_aligned(p: POSE): POSE
    VAR turned, tip, turn: POSE
    VAR zx, zy, zz, gx, gy, gz, ax, ay, az, size, angle: REAL
    turned = p
    turned.x = 0.0
    turned.y = 0.0
    turned.z = 0.0
    tip = turned : {x: 0.0, y: 0.0, z: 1.0, a: 0.0, b: 0.0, c: 0.0}
    zx = tip.x
    zy = tip.y
    zz = tip.z
    gx = 0.0
    gy = 0.0
    gz = 0.0
    IF abs(zx) >= abs(zy) AND abs(zx) >= abs(zz) THEN
        gx = 1.0
        IF zx < 0.0 THEN gx = -1.0
    ELSEIF abs(zy) >= abs(zz) THEN
        gy = 1.0
        IF zy < 0.0 THEN gy = -1.0
    ELSE
        gz = 1.0
        IF zz < 0.0 THEN gz = -1.0
    END IF
    ax = zy * gz - zz * gy
    ay = zz * gx - zx * gz
    az = zx * gy - zy * gx
    size = sqrt(ax * ax + ay * ay + az * az)
    IF size < 0.000001 THEN RETURN p
    angle = atan2(size, zx * gx + zy * gy + zz * gz)
    angle = angle / size
    turn = pose_from_rotation_vector(0.0, 0.0, 0.0, ax * angle, ay * angle, az * angle)
    turned = turn : turned
    turned.x = p.x
    turned.y = p.y
    turned.z = p.z
    RETURN turned
END FUNCTION
""",
    # half the angle between the ends seen from the centre; the middle of the line where there is no circle
    "rpl_arc_middle": """
FUNCTION rpl_arc_middle(other: POSE, first: POSE, last: POSE): POSE
    VAR middle: POSE
    VAR bx, by, bz, cx, cy, cz, nx, ny, nz, square, b2, c2, mx, my, mz, ux, uy, uz, vx, vy, vz: REAL
    VAR size, angle, ahead, across: REAL
    middle = interpolate_pose(first, last, 0.5)
    bx = first.x - other.x
    by = first.y - other.y
    bz = first.z - other.z
    cx = last.x - other.x
    cy = last.y - other.y
    cz = last.z - other.z
    nx = by * cz - bz * cy
    ny = bz * cx - bx * cz
    nz = bx * cy - by * cx
    square = nx * nx + ny * ny + nz * nz
    b2 = bx * bx + by * by + bz * bz
    c2 = cx * cx + cy * cy + cz * cz
    IF square <= 0.000001 * (b2 + c2) THEN RETURN middle
    b2 = b2 / (2.0 * square)
    c2 = c2 / (2.0 * square)
    mx = (ny * bz - nz * by) * c2
    my = (nz * bx - nx * bz) * c2
    mz = (nx * by - ny * bx) * c2
    mx = mx + (cy * nz - cz * ny) * b2
    my = my + (cz * nx - cx * nz) * b2
    mz = mz + (cx * ny - cy * nx) * b2
    ux = bx - mx
    uy = by - my
    uz = bz - mz
    vx = cx - mx
    vy = cy - my
    vz = cz - mz
    size = sqrt(square)
    nx = nx / size
    ny = ny / size
    nz = nz / size
    across = nx * (uy * vz - uz * vy) + ny * (uz * vx - ux * vz)
    across = across + nz * (ux * vy - uy * vx)
    ahead = ux * vx + uy * vy + uz * vz
    angle = atan2(across, ahead)
    IF angle < 0.0 THEN angle = angle + 360.0
    angle = angle / 2.0
    vx = ny * uz - nz * uy
    vy = nz * ux - nx * uz
    vz = nx * uy - ny * ux
    across = sin(angle)
    ahead = cos(angle)
    middle.x = other.x + mx + ux * ahead + vx * across
    middle.y = other.y + my + uy * ahead + vy * across
    middle.z = other.z + mz + uz * ahead + vz * across
    RETURN middle
END FUNCTION
""",
}


@legalising(unless=lambda context: context.capabilities.carries_rules)
def neutral_functions(program: ir.Program, context: Context) -> ir.Program:
    """The program without the functions of this kind that the target has no word for."""
    worker = _Functions(program, context)
    if not any(worker.lacks(node) for node in walk(*program.modules)):
        return program
    return worker.helpers.added_to(worker.program())


class _Functions(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.helpers = Helpers(context, _TEXTS)

    def lacks(self, node: object) -> TypeGuard[ir.Builtin]:
        can = self.context.capabilities
        match node:
            case ir.Builtin(function=("round" | "trunc"), arguments=(_, decimals)):
                return TextRule.COMPUTED_DECIMALS not in can.texts.rules and not isinstance(decimals, ir.IntLiteral)
            case ir.Builtin(function="text_order"):
                return node.function not in can.functions
            case ir.Builtin(function=("aligned" | "arc_middle")):
                return node.function not in can.functions
        return False

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if not self.lacks(done) or not isinstance(expression, ir.Builtin):
            return done
        if done.function in _ROUNDED:
            return self.helpers.call(_ROUNDED[done.function], *done.arguments)
        if done.function == "text_order":
            return self.helpers.call(_HELPERS[done.function], *done.arguments)
        types = [self.type_of(one) for one in expression.arguments]
        poses = [
            ir.Builtin("pose_of", (one,)) if isinstance(type, ir.TargetType) else one
            for one, type in zip(done.arguments, types, strict=True)
        ]
        pose = self.helpers.call(_HELPERS[done.function], *poses)
        if done.function == "aligned" or not isinstance(types[-1], ir.TargetType):
            return pose
        way = ir.Binary(":", pose, ir.Builtin("inverse", (poses[-1],)))
        return ir.Builtin("displaced", (done.arguments[-1], way), origin=done.origin)


__all__ = ["neutral_functions"]
