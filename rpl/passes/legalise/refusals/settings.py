"""Settings of motion that the run decides, where the target's moves have to say what comes of them."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.io.speedshares import REFUSED as SHARE
from rpl.passes.legalise.places.nextmove.nextmove import UNCERTAIN
from rpl.passes.legalise.refusals.rows import PLAINLY, Asked, Found, Refusal
from rpl.passes.legalise.settings.scaledspeeds import COMPUTED

__all__ = ["SETTINGS"]

TURNING = code(
    "turning-speed-lost",
    Severity.LOSS,
    "this move says only how fast the tool turns; the target's moves say no turning speed",
    "give the move the time that the turn takes, or a path speed",
    stops=True,
)


def _turning(move: ir.Move, asked: Asked) -> Found:
    """A move whose one speed is that of its turn, where neither moves nor settings have such a speed."""
    can, speed = asked.can, move.speed
    said = "rotation" in can.settings.speeds or "swivel_speed" in can.system_variables or "SpeedType" in can.types
    if said or can.carries_rules:
        return ()
    if speed is None or speed.rotation is None or any((speed.path, speed.duration, speed.profile)):
        return ()
    return PLAINLY if move.kind in ("linear", "circular") else ()


SETTINGS = (
    Refusal("an override that the run decides, where programs cannot set it", COMPUTED),
    Refusal("a share or a limit of all speeds that the run decides", SHARE),
    Refusal("a setting for the next move where that is not certain, or is in a routine that is called", UNCERTAIN),
    Refusal("a path whose move says only how fast the tool turns", TURNING, (ir.Move,), _turning, left=False),
)
