"""Numbers of the target's banks that data of the source says for itself: by its name (`R5`), or by a remark behind it
that is nothing else (`count !R5`), as a translation from there leaves them."""

from __future__ import annotations

import re
from collections.abc import Collection

from rpl import ir

_NUMBER = re.compile(r"(?P<bank>[A-Z]+)0*(?P<number>\d+)")


def said_number(one: ir.Variable, banks: Collection[str]) -> tuple[str, int] | None:
    """The bank and the number; None: it says none."""
    found = _NUMBER.fullmatch(one.name.upper())
    if found is None and one.origin.comments and one.origin.comments[-1].behind:
        found = _NUMBER.fullmatch(one.origin.comments[-1].text.strip())
    return (found["bank"], int(found["number"])) if found and found["bank"] in banks else None
