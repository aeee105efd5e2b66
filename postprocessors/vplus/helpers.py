"""Programs that a written file brings along for what V+ has no function for."""

from __future__ import annotations

# Head and steps of each, by name.
HELPERS: dict[str, tuple[str, tuple[str, ...]]] = {
    "rpl.upper": (
        ".PROGRAM rpl.upper($text, $result)",
        (
            "; The text in upper case.",
            'CALL rpl.map(($text), "abcdefghijklmnopqrstuvwxyz", "ABCDEFGHIJKLMNOPQRSTUVWXYZ", $result)',
        ),
    ),
    "rpl.lower": (
        ".PROGRAM rpl.lower($text, $result)",
        (
            "; The text in lower case.",
            'CALL rpl.map(($text), "ABCDEFGHIJKLMNOPQRSTUVWXYZ", "abcdefghijklmnopqrstuvwxyz", $result)',
        ),
    ),
    "rpl.map": (
        ".PROGRAM rpl.map($text, $from, $to, $result)",
        (
            "; Each sign that stands in one list becomes the one at its place in the other.",
            "AUTO at, place, $sign",
            '$result = ""',
            "FOR at = 1 TO LEN($text)",
            "    $sign = $MID($text, at, 1)",
            "    place = POS($from, $sign)",
            "    IF place > 0 THEN",
            "        $sign = $MID($to, place, 1)",
            "    END",
            "    $result = $result+$sign",
            "END",
        ),
    ),
    "rpl.power": (
        ".PROGRAM rpl.power(base.of, exponent, result)",
        (
            "; The whole part by products, each binary place behind the point by a square root.",
            "AUTO count, root, rest",
            "rest = ABS(exponent)",
            "result = 1",
            "FOR count = 1 TO INT(rest)",
            "    result = result*base.of",
            "END",
            "rest = FRACT(rest)",
            "root = base.of",
            "WHILE rest > 0 DO",
            "    root = SQRT(root)",
            "    rest = 2*rest",
            "    IF rest >= 1 THEN",
            "        result = result*root",
            "        rest = rest-1",
            "    END",
            "END",
            "IF exponent < 0 THEN",
            "    result = 1/result",
            "END",
        ),
    ),
    "rpl.angle": (
        ".PROGRAM rpl.angle(place, number, angle)",
        (
            "; An angle about z (1), new y (2) or new x (3). Where the second is 90 or -90",
            "; degrees the third is 0 and the first has all of the turn.",
            "AUTO level, xx, xy, xz, yx, yy, yz",
            "xx = DX(place:TRANS(1))-DX(place)",
            "xy = DY(place:TRANS(1))-DY(place)",
            "xz = DZ(place:TRANS(1))-DZ(place)",
            "yx = DX(place:TRANS(0,1))-DX(place)",
            "yy = DY(place:TRANS(0,1))-DY(place)",
            "yz = DZ(place:TRANS(0,1))-DZ(place)",
            "level = SQRT(SQR(xx)+SQR(xy))",
            "IF number == 2 THEN",
            "    angle = ATAN2(-xz, level)",
            "ELSE",
            "    IF level < 0.00001 THEN",
            "        angle = 0",
            "        IF number == 1 THEN",
            "            angle = ATAN2(-yx, yy)",
            "        END",
            "    ELSE",
            "        angle = ATAN2(xy, xx)",
            "        IF number == 3 THEN",
            "            angle = ATAN2(yz, DZ(place:TRANS(0,0,1))-DZ(place))",
            "        END",
            "    END",
            "END",
        ),
    ),
    "rpl.later": (
        ".PROGRAM rpl.later(number, seconds)",
        (
            "; Switches a signal when the time is over.",
            "WAIT.EVENT , seconds",
            "SIGNAL number",
        ),
    ),
}
_NEEDS = {"rpl.upper": "rpl.map", "rpl.lower": "rpl.map"}


def with_needed(names: set[str]) -> list[str]:
    """The programs and those that they call."""
    return sorted(names | {_NEEDS[name] for name in names if name in _NEEDS})
