"""Names, numbers and homes of data; what nothing uses is left out. Numbers are given when nothing has a name to add."""

from __future__ import annotations

from rpl.passes.legalise.errors.bookkeeping import without_bookkeeping
from rpl.passes.legalise.stages import Clause, Stage, again
from rpl.passes.legalise.storage.aheadreadings import ahead_readings
from rpl.passes.legalise.storage.labelled import labels_as_remarks
from rpl.passes.legalise.storage.madeplaces import place_made_statements
from rpl.passes.legalise.storage.modulepoints import points_of_modules
from rpl.passes.legalise.storage.numbered import number_data
from rpl.passes.legalise.storage.saidtwice import said_once
from rpl.passes.legalise.storage.sharing import share_temporaries
from rpl.passes.legalise.storage.spelling import one_spelling
from rpl.passes.legalise.storage.unreadflags import unread_flags
from rpl.passes.legalise.storage.unused import drop_idle_data, drop_unused

STAGE = Stage(
    "storage",
    (
        ahead_readings,
        said_once,
        unread_flags,
        again(without_bookkeeping, "errors and conditions of handlers are settled behind it"),
        drop_unused,
        points_of_modules,
        labels_as_remarks,
        one_spelling,
        share_temporaries,
        drop_idle_data,
        number_data,
        place_made_statements,
    ),
    Clause(further=frozenset(("datum without a number", "name in another spelling"))),
)
