"""Settings of motion that the run decides, where the target's moves have to say what comes of them."""

from __future__ import annotations

from rpl.passes.legalise.io.speedshares import REFUSED as SHARE
from rpl.passes.legalise.places.nextmove.nextmove import UNCERTAIN
from rpl.passes.legalise.refusals.rows import Refusal
from rpl.passes.legalise.settings.scaledspeeds import COMPUTED

__all__ = ["SETTINGS"]

SETTINGS = (
    Refusal("an override that the run decides, where programs cannot set it", COMPUTED),
    Refusal("a share or a limit of all speeds that the run decides", SHARE),
    Refusal("a setting for the next move where that is not certain, or is in a routine that is called", UNCERTAIN),
)
