"""Where the robot rests anyway, stopping it says nothing, and it does not move: through calls, loops and jumps."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.paths.atrest import at_rest
from rpl.project import read_sources
from rpl.registry import target
from rpl.source import source_from_text

FINE, CORNER = "MOVE LINEAR TO high SPEED 100 mm/s FINE", "MOVE LINEAR TO high SPEED 100 mm/s BLEND 20 mm"
CASES = {
    "behind a move that stops": (f"{FINE}\nSTOP MOTION", True),
    "behind a corner": (f"{CORNER}\nSTOP MOTION", False),
    "behind a routine that stops": ("stops()\nSTOP MOTION", True),
    "behind a routine with a corner at its end": ("passes()\nSTOP MOTION", False),
    "in a loop that ends with a corner": (f"{FINE}\nFOR i = 1 TO 3\nSTOP MOTION\n{CORNER}\nEND FOR", False),
    "in a loop that ends with a stop": (f"FOR i = 1 TO 3\nSTOP MOTION\n{CORNER}\n{FINE}\nEND FOR", True),
    "behind one branch with a corner": (f"IF n > 1 THEN\n{CORNER}\nELSE\n{FINE}\nEND IF\nSTOP MOTION", False),
    "behind two branches that stop": (f"IF n > 1 THEN\n{FINE}\nELSE\n{FINE}\nEND IF\nSTOP MOTION", True),
    "at a label that is come to from a corner": (
        f"{FINE}\nLABEL again\nSTOP MOTION\n{CORNER}\nn = n + 1\nGOTO again",
        False,
    ),
}
MODULE = f"""VAR n: INT = 0
VAR i: INT = 0
VAR high: TARGET = {{x: 500, y: 50, z: 400, a: 0, b: 180, c: 0}}

PROCEDURE main()
%s
END PROCEDURE

PROCEDURE stops()
    {CORNER}
    {FINE}
END PROCEDURE

PROCEDURE passes()
    {FINE}
    {CORNER}
END PROCEDURE
"""


@pytest.mark.parametrize("name", CASES)
def test_stops_that_say_nothing(name: str) -> None:
    lines, rests = CASES[name]
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("t.rpl", MODULE % lines)], "rpl", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    done = at_rest(program, Context("rpl", "krl", target("krl").capabilities, Diagnostics()))
    stops = [node for node in walk(*done.modules) if isinstance(node, ir.StopMotion)]
    assert (not stops) is rests
