"""A transfer of programs to each maker's virtual controller: what it holds before, what is brought."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Programs:
    """old: files that the controller holds, new: those that are brought (one of them changed, one of them new).
    `below`: where the virtual controller keeps what a client sees at the top."""

    old: Mapping[str, bytes]
    new: Mapping[str, bytes]
    below: str = ""

    @property
    def after(self) -> dict[str, bytes]:
        return {**self.old, **self.new}


def _inform(name: str, seconds: float) -> bytes:
    head = ("/JOB", f"//NAME {name}", "//INST", "///DATE 2024/05/06 09:20", "///ATTR SC,RW", "///GROUP1 RB1")
    return "\r\n".join((*head, "NOP", f"TIMER T={seconds:.2f}", "END", "")).encode()


def _tp(name: str, seconds: float) -> bytes:
    lines = (f"/PROG  {name}", "/ATTR", "/MN", f"   1:  WAIT {seconds:7.2f}(sec) ;", "/POS", "/END", "")
    return "\r\n".join(lines).encode()


def _rapid(name: str, seconds: float) -> bytes:
    lines = (f"MODULE {name}", f"  PROC run{name}()", f"    WaitTime {seconds:g};", "  ENDPROC", "ENDMODULE", "")
    return "\r\n".join(lines).encode()


def _script(name: str, seconds: float) -> bytes:
    return f"def {name.lower()}():\n  sleep({seconds:g})\nend\n".encode()


def _src(name: str, seconds: float) -> bytes:
    return "\r\n".join((f"DEF {name}( )", f"WAIT SEC {seconds:g}", "END", "")).encode()


def _dat(name: str, number: int) -> bytes:
    return "\r\n".join((f"DEFDAT {name}", f"DECL INT COUNT={number}", "ENDDAT", "")).encode()


TRANSFERS = {
    "abb": Programs(
        {"Pick.mod": _rapid("Pick", 1), "Other.mod": _rapid("Other", 2)},
        {"Pick.mod": _rapid("Pick", 3), "Place.mod": _rapid("Place", 1)},
    ),
    "fanuc": Programs(
        {"PICK.LS": _tp("PICK", 1), "OTHER.LS": _tp("OTHER", 2)},
        {"PICK.LS": _tp("PICK", 3), "PLACE.LS": _tp("PLACE", 1)},
    ),
    "kuka": Programs(
        {"pick.src": _src("pick", 1), "pick.dat": _dat("pick", 1)},
        {
            "pick.src": _src("pick", 3),
            "pick.dat": _dat("pick", 3),
            "place.src": _src("place", 1),
            "place.dat": _dat("place", 1),
        },
        "R1/Program/",
    ),
    "ur": Programs(
        {"pick.script": _script("pick", 1), "other.script": _script("other", 2)},
        {"pick.script": _script("pick", 3), "place.script": _script("place", 1)},
    ),
    "yaskawa": Programs(
        {"PICK.JBI": _inform("PICK", 1), "OTHER.JBI": _inform("OTHER", 2)},
        {"PICK.JBI": _inform("PICK", 3), "PLACE.JBI": _inform("PLACE", 1)},
    ),
}
