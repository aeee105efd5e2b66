"""The order of the passes. Each is listed once; its module says what it needs from the ones before it."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context, Pass, names_in
from rpl.passes.legalise.errors import check_errors
from rpl.passes.legalise.explicit import explicit_to_modal
from rpl.passes.legalise.interrupts import interrupts
from rpl.passes.legalise.logic import decide_logic
from rpl.passes.legalise.lookahead import stop_blends
from rpl.passes.legalise.loops import fit_loops
from rpl.passes.legalise.modal import modal_to_explicit
from rpl.passes.legalise.optional import fit_parameters
from rpl.passes.legalise.prelude import link_prelude
from rpl.passes.legalise.searches import searches
from rpl.passes.legalise.signals import name_signals, number_signals
from rpl.passes.legalise.switches import unroll_switches
from rpl.passes.legalise.triggers import triggers
from rpl.passes.legalise.waits import fit_waits
from rpl.passes.typing import normalise

# First what asks for the source language's own rules (its prelude, its look-ahead), then control, data, motion.
PASSES: tuple[Pass, ...] = (
    searches,
    link_prelude,
    stop_blends,
    triggers,
    interrupts,
    modal_to_explicit,
    explicit_to_modal,
    name_signals,
    number_signals,
    # control: each may make what a later one rewrites (errors make Repeat, switches make cor)
    fit_parameters,
    check_errors,
    fit_waits,
    unroll_switches,
    decide_logic,
    fit_loops,
)


def legalise(program: ir.Program, context: Context) -> ir.Program:
    """The program rewritten for the context's target and governed by its rules.

    Same-language writing leaves it as it is.
    """
    context.taken |= names_in(program)
    if not context.foreign or context.capabilities.carries_rules:
        return program
    for one in PASSES:
        program = one(program, context)
    program = replace(program, modules=tuple(replace(module, dialect=context.target) for module in program.modules))
    return normalise(program, context.diagnostics)
