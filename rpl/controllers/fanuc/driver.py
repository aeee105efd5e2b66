"""MAPPDK (TCP 18735): the socket of a KAREL program that users load for fanucpy and its like; a line of text each way.

`movej:0025:0100:000:0:6:+000010.000000...` is a joint move (the fourth field: 1 for a straight line), `movep` one to
X Y Z W P R, `0:` begins an answer that all is well, `1:` one that it is not. After fanucpy 0.1.14, which reads whatever
comes in one piece: answers have no line end.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from rpl.controllers.fanuc.listing import listing_of
from rpl.controllers.fanuc.motion import carried_out, target_text
from rpl.controllers.fanuc.snpx import position_of
from rpl.controllers.fanuc.values import Values
from rpl.controllers.virtual.store import NotDoneError
from rpl.controllers.virtual.transcript import Kind

PROGRAM = "MAPPDK_MOVE"
_KINDS: dict[str, Kind] = {
    "movej": "start",
    "movep": "start",
    "mappdkcall": "start",
    "setrdo": "set",
    "setdout": "set",
    "setsysvar": "set",
}
_PORTS = {"rdo": "RO", "dout": "DO"}


class Driver:
    """One connection."""

    def __init__(self, values: Values) -> None:
        self.values, self.cabinet = values, values.cabinet

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.cabinet.told("mappdk", "connect", "connected", counts=False)
        writer.write(b"0:success")
        await writer.drain()
        while line := await reader.readline():
            word, *fields = line.decode("latin-1").strip().split(":")
            kind = _KINDS.get(word, "look")
            self.cabinet.told("mappdk", kind, line.decode("latin-1").strip(), counts=kind != "look")
            if self.cabinet.faults.delay_s:
                await asyncio.sleep(self.cabinet.faults.delay_s)
            try:
                answer = f"0:{await self._done(word, fields)}"
            except (NotDoneError, ValueError, IndexError):
                answer = "1:position-is-not-reachable" if word.startswith("move") else "1:failed"
            if kind != "look":
                self.cabinet.after()
            writer.write(answer.encode("latin-1"))
            await writer.drain()

    async def _done(self, word: str, fields: Sequence[str]) -> str:
        """What stands behind `0:`. Raises NotDoneError, ValueError, IndexError."""
        if word in ("movej", "movep"):
            await self._moved(word, fields)
            return "success"
        if word == "mappdkcall":
            await carried_out(self.cabinet, PROGRAM, listing_of(f"CALL {fields[0]}", "", PROGRAM), calls=True)
            return "success"
        if word in ("curpos", "curjpos"):
            here = position_of(self.values.place())
            shown = (
                zip("xyzwpr", here.xyzwpr, strict=True) if word == "curpos" else zip("j" * 6, here.joints, strict=False)
            )
            return ",".join(f"{name}={value:.3f}" for name, value in shown)
        if word == "ins_pwr":
            return "0.0"
        if word == "setsysvar":
            self.values.system[fields[0].upper()] = float(fields[1] == "T")
            return "success"
        name = f"{_PORTS.get(word[3:], '')}[{int(fields[0])}]"
        if word[:3] == "set" and word[3:] in _PORTS:
            self.cabinet.set_signal(name, fields[1] == "true")
            return "success"
        if word[:3] == "get" and word[3:] in _PORTS:
            return str(int(bool(self.cabinet.signal(name))))
        raise ValueError(word)

    async def _moved(self, word: str, fields: Sequence[str]) -> None:
        speed, corner, straight = int(fields[0]), int(fields[2]), fields[3] == "1"
        numbers = [float(value) for value in fields[5 : 5 + int(fields[4])]]
        if len(numbers) != 6:
            raise ValueError(len(numbers))
        here = dict(zip(("Flip", "Left", "Up", "Front", "Turn4", "Turn5", "Turn6"), self._posture(), strict=True))
        packet = (
            {"JointAngle": {f"J{number}": value for number, value in enumerate(numbers, 1)}}
            if word == "movej"
            else {"Position": dict(zip("XYZWPR", numbers, strict=True)), "Configuration": here}
        )
        ending = f"CNT{corner}" if corner else "FINE"
        move = f"{'L' if straight else 'J'} P[1] {max(speed, 1)}{'mm/sec' if straight else '%'} {ending}"
        body = f"UFRAME_NUM=0 ;\n   2:  UTOOL_NUM=1 ;\n   3:{move}"
        await carried_out(self.cabinet, PROGRAM, listing_of(body, target_text(packet, 0, 1), PROGRAM))

    def _posture(self) -> tuple[int, ...]:
        """A place is reached in the posture that the arm has."""
        return position_of(self.values.place()).posture
