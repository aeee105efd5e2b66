"""Signals, groups, clocks and pulses, with the numbers, names and forms of the target."""

from __future__ import annotations

from rpl.passes.legalise.data.datalists import set_data_at_start
from rpl.passes.legalise.io.analogunits import analog_units
from rpl.passes.legalise.io.bitgroups import groups_to_bits, shared_groups_to_bits
from rpl.passes.legalise.io.flagdata import flags_as_data
from rpl.passes.legalise.io.groups import name_groups
from rpl.passes.legalise.io.signals import name_signals, number_signals
from rpl.passes.legalise.io.timers import timers_to_clocks
from rpl.passes.legalise.io.watches import counted_watches
from rpl.passes.legalise.io.writeonly import kept_outputs
from rpl.passes.legalise.places.targets import whole_targets
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.storage.declaredremarks import declared_remarks

STAGE = Stage(
    "io",
    (
        whole_targets,
        declared_remarks,
        set_data_at_start,
        timers_to_clocks,
        counted_watches,
        shared_groups_to_bits,
        flags_as_data,
        analog_units,
        name_signals,
        number_signals,
        name_groups,
        groups_to_bits,
        kept_outputs,
    ),
)
