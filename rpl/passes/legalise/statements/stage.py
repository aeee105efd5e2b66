"""Waits, messages, choices, conditions and calls of built-in things. They stand behind routines, because a handler
that the target lacks becomes choices, and these become chains of conditions.
"""

from __future__ import annotations

from rpl.passes.legalise.control.logic import decide_logic
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.control.structure import structure_of_made_jumps
from rpl.passes.legalise.control.switches import unroll_switches
from rpl.passes.legalise.data.calls import rewrite_calls
from rpl.passes.legalise.data.enums import enums_to_constants
from rpl.passes.legalise.errors.errors import check_errors
from rpl.passes.legalise.io.polling import poll_waits
from rpl.passes.legalise.io.waits import fit_waits
from rpl.passes.legalise.routines.references import references_as_copies
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.texts.dialogs import number_dialogs
from rpl.passes.legalise.texts.messages import message_lines, senders_as_texts, split_messages
from rpl.passes.legalise.texts.shown import values_beside_messages

STAGE = Stage(
    "statements",
    (
        check_errors,
        structure_of_made_jumps,
        fit_waits,
        poll_waits,
        unroll_switches,
        decide_logic,
        number_dialogs,
        message_lines,
        senders_as_texts,
        values_beside_messages,
        rewrite_calls,
        split_messages,
        references_as_copies,
        fit_loops,
        enums_to_constants,
    ),
)
