"""Waits, pulses, messages, choices, conditions and calls of built-in things. They stand behind routines, because a
handler that the target lacks becomes choices, and these become chains of conditions.
"""

from __future__ import annotations

from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.stages import Clause, Stage, again
from rpl.passes.legalise.statements.calls import rewrite_calls
from rpl.passes.legalise.statements.enums import enums_to_constants
from rpl.passes.legalise.statements.errors import check_errors
from rpl.passes.legalise.statements.lateflags import late_flags
from rpl.passes.legalise.statements.logic import decide_logic
from rpl.passes.legalise.statements.messages import message_lines, senders_as_texts, split_messages
from rpl.passes.legalise.statements.polling import poll_waits
from rpl.passes.legalise.statements.pulsedoutputs import pulsed_outputs
from rpl.passes.legalise.statements.pulselevels import pulse_levels
from rpl.passes.legalise.statements.restingwaits import resting_waits
from rpl.passes.legalise.statements.seldomlooks import seldom_looks
from rpl.passes.legalise.statements.structure import labels_to_structure
from rpl.passes.legalise.statements.switches import unroll_switches
from rpl.passes.legalise.statements.waits import fit_waits

STAGE = Stage(
    "statements",
    (
        check_errors,
        labels_to_structure,
        late_flags,
        seldom_looks,
        resting_waits,
        fit_waits,
        pulsed_outputs,
        pulse_levels,
        poll_waits,
        unroll_switches,
        decide_logic,
        message_lines,
        senders_as_texts,
        rewrite_calls,
        split_messages,
        again(fit_loops, "loops over choices count with them, and these become numbers next"),
        enums_to_constants,
    ),
    Clause(
        statements="Raise Retry SetAfter Switch TryNext",
        functions="ceil character_code dimension floor format message_text number_text power round text_append "
        "text_find text_map text_part text_upper trunc value_text",
        procedures="decrement format_into increment",
        operators="& ** band bnot bor bxor xor",
        system="error_number",
        further=frozenset(
            (
                "declaration EnumDeclaration",
                "handler of errors",
            )
        ),
    ),
)
