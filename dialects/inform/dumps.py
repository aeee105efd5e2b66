"""Values that a controller keeps, from its files beside the jobs: VAR.DAT (variables), TOOL.CND, UFRAME.CND.

Layouts as in files of controllers in public repositories (lukelalondePZ/Komatsu-Press-Demo and
SinaiAranda/motoman_sda20d_sys: VAR.DAT, TOOL.CND; UFRAME.CND as written by public offline tools):

    //VAR                            //TOOL 1                         //UFRAME 1
    ///SHARE 100,100,100,100,...     ///NAME GRIPPER                  ///NAME TABLE
    ///B                             0.000,0.000,120.000,0,0,0        ////BUSER 500.000,0.000,0.000,0.0,0.0,0.0
    0,2,10,...      (B000 ... by ten)
    ///S            (a text a line)
    ///P
    "UNUSED"
    "PULSE"0,0,TOOL,FORM,USER,0,S,L,U,R,B,T,...
    "RECTAN"0,0,TOOL,FORM,USER,FRAME,X,Y,Z,Rx,Ry,Rz,...

FRAME is 16 base, 17 robot, 18 tool, 19 user, as positions are told over the controller's Ethernet server. M: the signs
of FORM are those of ///RCONF, and USER is the number of the user frame.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin, Source

from . import DUMP_HEAD
from .jobs import POSE, PULSE, Frame, Point
from .syntax import PointLine

BAD_VALUE = code(
    "inform-bad-value",
    Severity.ERROR,
    "this line of the controller's values cannot be read: {text}",
    "take the file from the controller anew",
)
_HEAD = re.compile(r"//(TOOL|UFRAME)[ \t]+(\d+)\s*\Z")
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
_NUMBERS = re.compile(rf"{_NUMBER}(?:\s*,\s*{_NUMBER})*\Z")
_POSITION = re.compile(rf'"(PULSE|RECTAN)"\s*({_NUMBER}(?:\s*,\s*{_NUMBER})*)\Z')
_BUSER = re.compile(r"/+BUSER\s+(.*)\Z")
_FRAMES = {16: "base", 17: "base", 18: "tool", 19: "user"}
_FLAGS = 6


@dataclass(slots=True)
class Dump:
    """What the files say: numbers and texts by (bank, number), positions by number, tools and frames by (word, n)."""

    values: dict[tuple[str, int], ir.Expression] = field(default_factory=dict)
    positions: dict[int, Point] = field(default_factory=dict)
    poses: dict[tuple[str, int], ir.Aggregate] = field(default_factory=dict)


def is_dump(text: str) -> bool:
    """Is the text a file of variables, tools or user frames?"""
    return DUMP_HEAD.match(text[:200]) is not None


def read_dump(source: Source, into: Dump, diagnostics: Diagnostics) -> int:
    """Take over what a file says. Gives the number of values; a line that cannot be read is reported with its place."""
    reader = _Reader(source, into, diagnostics)
    at = 0
    for line in source.text.splitlines(keepends=True):
        reader.line(line.strip("\r\n \t\ufeff"), Origin(source, at, at + len(line.rstrip("\r\n"))))
        at += len(line)
    return reader.count


class _Reader:
    def __init__(self, source: Source, into: Dump, diagnostics: Diagnostics) -> None:
        self.source, self.into, self.diagnostics = source, into, diagnostics
        self.section, self.next = "", 0
        self.count = 0

    def line(self, text: str, origin: Origin) -> None:
        head = _HEAD.match(text)
        if head is not None:
            self.section, self.next = head[1], int(head[2])
        elif text.startswith("///") and not text.startswith("////") and self.section not in ("TOOL", "UFRAME"):
            self.section, self.next = text.split()[0].lstrip("/"), 0
        elif self.section == "S":
            self.into.values["S", self.next] = ir.TextLiteral(text.strip('"'), origin=origin)
            self.next += 1
            self.count += 1
        elif text and not self.value(text, origin):
            self.diagnostics.report(BAD_VALUE, origin, text=text[:60])

    def value(self, text: str, origin: Origin) -> bool:
        """A line of numbers, a position, a tool or a frame; False when it cannot be read."""
        if self.section in ("B", "I", "D", "R"):
            return self.numbers(text, origin)
        if self.section == "P":
            return self.position(text, origin)
        if self.section == "TOOL":
            return self.tool(text, origin)
        if self.section == "UFRAME":
            found = _BUSER.match(text)
            return found is None or self.pose("UF", found[1], origin)
        return True  # numbers of variables, positions of base axes and stations

    def numbers(self, text: str, origin: Origin) -> bool:
        if _NUMBERS.match(text) is None:
            return False
        for given in text.split(","):
            number = float(given)
            if self.section != "R" and number != int(number):
                return False
            literal: ir.Expression = ir.RealLiteral(number, origin=origin)
            if self.section != "R":
                literal = ir.IntLiteral(int(number), origin=origin)
            self.into.values[self.section, self.next] = literal
            self.next += 1
            self.count += 1
        return True

    def position(self, text: str, origin: Origin) -> bool:
        number = self.next
        self.next += 1
        if text == '"UNUSED"':
            return True
        found = _POSITION.match(text)
        fields = [part.strip() for part in found[2].split(",")] if found is not None else []
        whole = [one for one in fields[:6] if one.isdigit()]
        if len(fields) < 12 or len(whole) < 6 or len(fields[3]) < _FLAGS:
            return False
        tool, flags, user, kind, values = int(fields[2]), fields[3], int(fields[4]), int(fields[5]), fields[6:12]
        pulses = text.startswith('"PULSE"')
        if kind not in _FRAMES if not pulses else not all(one.lstrip("+-").isdigit() for one in values):
            return False
        word = "base" if pulses else _FRAMES[kind]
        frame = Frame("user", ir.IntLiteral(user)) if word == "user" else Frame(word)
        literals = tuple(ir.IntLiteral(int(one)) if pulses else ir.RealLiteral(float(one)) for one in values)
        form = tuple(int(sign) for sign in flags[:_FLAGS])
        point = PointLine("P", number, literals, origin)
        self.into.positions[number] = Point(point, PULSE if pulses else POSE, tool, frame, form)
        self.count += 1
        return True

    def tool(self, text: str, origin: Origin) -> bool:
        """The first line of numbers behind the head is the place of the tool; its weight and inertia follow."""
        if text.startswith("///") or ("TL", self.next) in self.into.poses:
            return True
        return self.pose("TL", text, origin)

    def pose(self, word: str, text: str, origin: Origin) -> bool:
        given = text.split(",")
        if _NUMBERS.match(text.strip()) is None or len(given) < 6:
            return False
        x, y, z, rx, ry, rz = (ir.RealLiteral(float(one)) for one in given[:6])
        entries = (("x", x), ("y", y), ("z", z), ("a", rz), ("b", ry), ("c", rx))
        self.into.poses[word, self.next] = ir.Aggregate(entries, origin=origin)
        self.count += 1
        return True


__all__ = ["BAD_VALUE", "Dump", "is_dump", "read_dump"]
