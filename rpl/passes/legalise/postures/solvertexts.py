"""The inverse kinematics of an arm as routines in RPL, for programs of controllers that cannot be asked for joints.

All solutions of the arm's closed form are worked out; the one with the least travel from the given joints inside of the
limits is taken (travel: the squares of the axes' times at full speed), each axis by the turn that is nearest. The
formulas are those of rpl.emulator.arms, angles in degrees.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.emulator.closedforms import ClosedForm

FIND, NEAR, REACHED = "rpl_find_joints", "rpl_near_joints", "rpl_reached"
FLANGE = "rpl_flange"
_NONE = 100000  # the first axis (deg) where there is no solution

_TURNED = """
FUNCTION rpl_turned(angle: REAL, near: REAL, low: REAL, high: REAL): REAL
    VAR q: REAL
    q = angle
    WHILE q - near > 180
        q = q - 360
    END WHILE
    WHILE near - q > 180
        q = q + 360
    END WHILE
    WHILE q > high + 0.000001
        q = q - 360
    END WHILE
    WHILE q < low - 0.000001
        q = q + 360
    END WHILE
    RETURN q
END FUNCTION
"""
_TRAVEL = """
FUNCTION rpl_travel(q: REAL, near: REAL, high: REAL, speed: REAL): REAL
    IF q > high + 0.000001 THEN RETURN 1000000
    RETURN (q - near) / speed * (q - near) / speed
END FUNCTION
"""
_NEAR_JOINTS = """
FUNCTION rpl_near_joints(f: POSE, n: JOINTS): JOINTS
    VAR q: JOINTS
    q = rpl_find_joints(f, n)
    IF q.j1 > 50000 THEN HALT
    RETURN q
END FUNCTION
"""
_REACHED = """
FUNCTION rpl_reached(f: POSE, n: JOINTS): BOOL
    VAR q: JOINTS
    q = rpl_find_joints(f, n)
    RETURN q.j1 < 50000
END FUNCTION
"""
_HEAD = """
FUNCTION rpl_find_joints(f: POSE, n: JOINTS): JOINTS
    VAR best: JOINTS
    VAR q: JOINTS
    VAR side: INT
    VAR bend: INT
    VAR flip: INT
{reals}
    best = n
    q = n
    best.j1 = {none}
    least = 1000000
    ca = cos(f.a)
    sa = sin(f.a)
    cb = cos(f.b)
    sb = sin(f.b)
    cc = cos(f.c)
    sc = sin(f.c)
    xx = ca * cb
    yx = sa * cb
    zx = 0 - sb
    xy = ca * sb * sc - sa * cc
    yy = sa * sb * sc + ca * cc
    zy = cb * sc
    xz = ca * sb * cc + sa * sc
    yz = sa * sb * cc - ca * sc
    zz = cb * cc
    px = f.x - {end} * xz
    py = f.y - {end} * yz
    pz = f.z - {end} * zz - {up}
    r = px * px + py * py - {aside} * {aside}
    IF r < -0.001 THEN RETURN best
    IF r < 0 THEN r = 0
    r = sqrt(r)
"""
_COMMON = (
    "least travel ca sa cb sb cc sc xx yx zx xy yy zy xz yz zz px py pz r s c1 s1 x y g c2 s2 t1 t2 t3 t4 t5 t6 u v w h"
)
_UR = """
    FOR side = 0 TO 1
        s = 1 - 2 * side
        t1 = atan2(py, px) + atan2({d4}, r * s)
        c1 = cos(t1)
        s1 = sin(t1)
        u = s1 * xx - c1 * yx
        v = s1 * xy - c1 * yy
        w = s1 * xz - c1 * yz
        FOR flip = 0 TO 1
            s = 1 - 2 * flip
            h = sqrt(u * u + v * v)
            IF h < 0.000001 THEN
                t6 = {near6}
                h = 0
            ELSE
                t6 = atan2(0 - s * v, s * u)
                h = cos(t6) * u - sin(t6) * v
            END IF
            t5 = atan2(h, w)
            c6 = cos(t6)
            s6 = sin(t6)
            u6 = c1 * xx + s1 * yx
            v6 = c1 * xy + s1 * yy
            x = c1 * px + s1 * py + {d5} * (u6 * s6 + v6 * c6)
            y = pz + {d5} * (zx * s6 + zy * c6)
            g = cos(t5)
            h = sin(t5)
            t = g * (c6 * u6 - s6 * v6) - h * (c1 * xz + s1 * yz)
            t4 = g * (c6 * zx - s6 * zy) - h * zz
            t = atan2(t4, t)
            g = (x * x + y * y - {squares}) / {product}
            IF abs(g) < 1.000001 THEN
                IF g > 1 THEN g = 1
                IF g < -1 THEN g = -1
                FOR bend = 0 TO 1
                    s = 1 - 2 * bend
                    t3 = atan2(s * sqrt(1 - g * g), g)
                    c2 = {a2} + {a3} * cos(t3)
                    s2 = {a3} * sin(t3)
                    t2 = atan2(y, x) - atan2(s2, c2)
                    t4 = t - t2 - t3
{candidate}
                END FOR
            END IF
        END FOR
    END FOR
    RETURN best
END FUNCTION
"""
_OPW = """
    FOR side = 0 TO 1
        s = 1 - 2 * side
        IF px * px + py * py < 0.000001 THEN
            t1 = {near1} + 180 * side
        ELSE
            t1 = atan2(py, px) - atan2({b}, r * s)
        END IF
        x = s * r - {a1}
        c1 = cos(t1)
        s1 = sin(t1)
        g = (x * x + pz * pz - {squares}) / {product}
        IF abs(g) < 1.000001 THEN
            IF g > 1 THEN g = 1
            IF g < -1 THEN g = -1
            FOR bend = 0 TO 1
                s = 1 - 2 * bend
                h = s * sqrt(1 - g * g)
                t2 = atan2(x, pz) - atan2({forearm} * h, {c2} + {forearm} * g)
                t3 = atan2(h, g) - {psi}
                c2 = cos(t2 + t3)
                s2 = sin(t2 + t3)
                w = c1 * xz + s1 * yz
                u = c2 * w - s2 * zz
                w = s2 * w + c2 * zz
                v = c1 * yz - s1 * xz
                t4 = {near4}
                IF sqrt(u * u + v * v) > 0.000001 THEN t4 = atan2(v, u)
                h = cos(t4)
                y = sin(t4)
                t5 = atan2(h * u + y * v, w)
                u = c2 * (c1 * xx + s1 * yx) - s2 * zx
                u = h * (c1 * yx - s1 * xx) - y * u
                v = c2 * (c1 * xy + s1 * yy) - s2 * zy
                v = h * (c1 * yy - s1 * xy) - y * v
                t6 = atan2(u, v)
                FOR flip = 0 TO 1
{candidate}
                    t4 = t4 + 180
                    t5 = 0 - t5
                    t6 = t6 + 180
                END FOR
            END FOR
        END IF
    END FOR
    RETURN best
END FUNCTION
"""
_FLANGE = """
FUNCTION rpl_flange(q: JOINTS): POSE
    VAR f: POSE
{reals}
    t1 = {near1}
    t2 = {near2}
    t3 = {near3}
    t4 = {near4}
    t5 = {near5}
    t6 = {near6}
    c1 = cos(t1)
    s1 = sin(t1)
    c4 = cos(t4)
    s4 = sin(t4)
    c5 = cos(t5)
    s5 = sin(t5)
    c6 = cos(t6)
    s6 = sin(t6)
{chain}
    f.b = atan2(0 - zx, sqrt(xx * xx + yx * yx))
    IF sqrt(xx * xx + yx * yx) > 0.000001 THEN
        f.a = atan2(yx, xx)
        f.c = atan2(zy, zz)
    ELSE
        f.a = atan2(0 - xy, yy)
        f.c = 0
    END IF
    RETURN f
END FUNCTION
"""
_UR_CHAIN = """
    c = cos(t2 + t3 + t4)
    s = sin(t2 + t3 + t4)
    u = c5 * c1 * c + s5 * s1
    v = c5 * s1 * c - s5 * c1
    w = c5 * s
    x = 0 - c1 * s
    y = 0 - s1 * s
    xz = c5 * s1 - s5 * c1 * c
    yz = 0 - s5 * s1 * c - c5 * c1
    zz = 0 - s5 * s
    xx = c6 * u + s6 * x
    yx = c6 * v + s6 * y
    zx = c6 * w + s6 * c
    xy = c6 * x - s6 * u
    yy = c6 * y - s6 * v
    zy = c6 * c - s6 * w
    r = {a2} * cos(t2) + {a3} * cos(t2 + t3)
    f.x = c1 * r + {d4} * s1 - {d5} * x + {d6} * xz
    f.y = s1 * r - {d4} * c1 - {d5} * y + {d6} * yz
    r = {a2} * sin(t2) + {a3} * sin(t2 + t3)
    f.z = {d1} + r - {d5} * c + {d6} * zz
"""
_OPW_CHAIN = """
    c = cos(t2 + t3)
    s = sin(t2 + t3)
    u = c4 * c1 * c - s4 * s1
    v = c4 * s1 * c + s4 * c1
    w = 0 - c4 * s
    x = 0 - s4 * c1 * c - c4 * s1
    y = c4 * c1 - s4 * s1 * c
    zy = s4 * s
    xz = s5 * u + c5 * c1 * s
    yz = s5 * v + c5 * s1 * s
    zz = s5 * w + c5 * c
    u = c5 * u - s5 * c1 * s
    v = c5 * v - s5 * s1 * s
    w = c5 * w - s5 * c
    xx = c6 * u + s6 * x
    yx = c6 * v + s6 * y
    zx = c6 * w + s6 * zy
    xy = c6 * x - s6 * u
    yy = c6 * y - s6 * v
    zy = c6 * zy - s6 * w
    r = {a1} + {c2} * sin(t2) + {a2} * c + {c3} * s
    f.x = c1 * r - {b} * s1 + {c4} * xz
    f.y = s1 * r + {b} * c1 + {c4} * yz
    r = {c1} + {c2} * cos(t2) - {a2} * s + {c3} * c
    f.z = r + {c4} * zz
"""
_OF_PLACE = "t1 t2 t3 t4 t5 t6 c s r c1 s1 c4 s4 c5 s5 c6 s6 u v w x y xx yx zx xy yy zy xz yz zz"


def solver_texts(form: ClosedForm) -> dict[str, str]:
    """The routines of an arm: the joints of a flange pose near joints, whether there are any, the flange of joints."""
    names, lengths = dict(form.lengths), form.lengths
    if form.build == "ur":
        second, third = lengths["a2"], lengths["a3"]
        names |= {"end": lengths["d6"], "up": lengths["d1"], "aside": lengths["d4"]}
        more, text, indent = "c6 s6 u6 v6 t", _UR, 20
    else:
        second, third = lengths["c2"], math.hypot(lengths["a2"], lengths["c3"])
        names |= {"end": lengths["c4"], "up": lengths["c1"], "aside": lengths["b"], "forearm": third}
        names["psi"] = math.degrees(math.atan2(lengths["a2"], lengths["c3"]))
        more, text, indent = "", _OPW, 20
    names |= {"squares": second * second + third * third, "product": 2 * second * third}
    shown = {name: _number(value) for name, value in names.items()}
    shown |= {f"near{axis}": _near(form, axis - 1) for axis in range(1, 7)}
    shown |= {
        "candidate": "\n".join(" " * indent + line for line in _candidate(form)),
        "none": str(_NONE),
        "reals": "\n".join(f"    VAR {name}: REAL" for name in f"{_COMMON} {more}".split()),
    }
    chain = (_UR_CHAIN if form.build == "ur" else _OPW_CHAIN).strip("\n").format(**shown)
    angles = {f"near{axis}": _near(form, axis - 1, "q") for axis in range(1, 7)}
    reals = "\n".join(f"    VAR {name}: REAL" for name in _OF_PLACE.split())
    return {
        "rpl_turned": _TURNED,
        "rpl_travel": _TRAVEL,
        FIND: (_HEAD + text).format(**shown),
        NEAR: _NEAR_JOINTS,
        REACHED: _REACHED,
        FLANGE: _FLANGE.format(reals=reals, chain=chain, **angles),
    }


def _candidate(form: ClosedForm) -> list[str]:
    """Lines that turn t1 .. t6 into pendant joints near n, and keep them where they are the best so far."""
    lines = []
    for axis, (low, high) in enumerate(form.limits):
        row, at = form.factors[axis], axis + 1
        angle = f"t{at}" if form.offsets[axis] == 0 else f"(t{at} + {_number(form.offsets[axis])})"
        for other, factor in enumerate(row):
            if other != axis and factor != 0:
                angle = f"({angle} - {_number(factor)} * q.j{other + 1})"
        if row[axis] != 1:
            angle = f"0 - {angle}" if row[axis] == -1 else f"{angle} / {_number(row[axis])}"
        lines.append(f"q.j{at} = rpl_turned({angle}, n.j{at}, {_number(low)}, {_number(high)})")
    lines.append("travel = 0")
    for axis, (_, high) in enumerate(form.limits):
        at = axis + 1
        lines.append(f"travel = travel + rpl_travel(q.j{at}, n.j{at}, {_number(high)}, {_number(form.speeds[axis])})")
    return [*lines, "IF travel < least THEN", "    best = q", "    least = travel", "END IF"]


def _near(form: ClosedForm, axis: int, joints: str = "n") -> str:
    """The arm's own angle at given joints."""
    terms = [f"{_number(factor)} * {joints}.j{at + 1}" for at, factor in enumerate(form.factors[axis]) if factor != 0]
    return f"({' + '.join(terms)} - {_number(form.offsets[axis])})"


def _number(value: float) -> str:
    """A number as RPL writes it, a negative one in brackets."""
    text = f"{round(value, 9) + 0.0:.9f}".rstrip("0")
    text = text + "0" if text.endswith(".") else text
    return f"({text})" if value < 0 else text


__all__ = ["FIND", "FLANGE", "NEAR", "REACHED", "solver_texts"]
