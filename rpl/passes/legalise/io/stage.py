"""What a program asks of the controller and of the machine: overrides and settings that it reads, signals, groups and
clocks, with the numbers, names and forms of the target. They stand before data, because calls of signals and settings
that are kept make data; remarks of declarations come first, because clocks leave none.
"""

from __future__ import annotations

from rpl.passes.legalise.io.analogunits import analog_units
from rpl.passes.legalise.io.bitgroups import shared_groups_to_bits
from rpl.passes.legalise.io.declaredremarks import declared_remarks
from rpl.passes.legalise.io.flagdata import flags_as_data
from rpl.passes.legalise.io.keptsettings import kept_settings
from rpl.passes.legalise.io.namednumbers import named_numbers
from rpl.passes.legalise.io.readoverrides import read_overrides
from rpl.passes.legalise.io.signals import name_signals, number_signals
from rpl.passes.legalise.io.speedshares import speed_shares
from rpl.passes.legalise.io.timers import timers_to_clocks
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "io",
    (
        declared_remarks,
        speed_shares,
        read_overrides,
        kept_settings,
        timers_to_clocks,
        shared_groups_to_bits,
        flags_as_data,
        analog_units,
        name_signals,
        number_signals,
        named_numbers,
    ),
    Clause(
        system="timer_positive",
    ),
)
