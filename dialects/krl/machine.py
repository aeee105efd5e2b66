"""The arm that an archive is of, as its machine data name it.

Seen in archives of KRC2 and KRC4: `$TRAFONAME[]="#KR120R2700 EXTRA HA C4 FLR"` in $machine.dat, `$MODEL_NAME[]` in
$robcor.dat.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rpl.registry import Aside
from rpl.source import Source

_NAME = re.compile(r'^\s*\$(?:TRAFONAME|MODEL_NAME)\[\]\s*=\s*"#?([^"\n]+)"', re.IGNORECASE | re.MULTILINE)


def arms(sources: Sequence[Source]) -> Iterator[tuple[str, str]]:
    """The names of the arm, with the file that says each."""
    for source in sources:
        if source.path.lower().endswith((".dat", ".src")):
            yield from ((found[1].strip(), source.path) for found in _NAME.finditer(source.text) if found[1].strip())


def is_backup(names: frozenset[str]) -> bool:
    """An archive of the controller has `am.ini` beside the folder KRC, and programs in KRC/R1; people keep R1 alone."""
    return "am.ini" in names or "krc/r1/" in names or "r1/program/" in names


def aside(source: Source) -> Aside | None:
    """What an archive says of itself."""
    return Aside("what an archive says of itself") if source.path.lower().endswith("/am.ini") else None
