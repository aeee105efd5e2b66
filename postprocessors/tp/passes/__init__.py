"""What only TP needs of a program, each pass with its place among those of the core, and right in front of the
writer."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .arguments import arguments_in_registers
from .bitgroups import groups_to_bits
from .components import read_components
from .composition import compositions
from .continuouscorners import continuous_corners
from .exactends import exact_ends
from .filledplaces import filled_places
from .framenumbers import frame_numbers
from .instructions import single_instructions
from .joinedtexts import joined_texts
from .limitedwaits import limited_waits
from .longlogic import long_logic
from .moveplaces import places_of_moves
from .ownwords import own_words
from .resetclocks import stopped_resets
from .selects import signals_in_registers
from .shown import values_beside_messages
from .zeroplaces import zero_places

PASSES: tuple[Placed, ...] = (
    Placed(stopped_resets, "interrupts", behind="clocks_of_routines"),
    Placed(own_words, "io", before="number_signals"),
    Placed(groups_to_bits, "io", behind="named_numbers"),
    Placed(values_beside_messages, "statements", behind="senders_as_texts"),
    Placed(places_of_moves, "settings", behind="stand_first"),
    Placed(frame_numbers, "settings", behind="stand_first"),
    Placed(continuous_corners, "settings", behind="stand_first"),
    Placed(compositions, "records", behind="drop_unread_parameters"),
    Placed(filled_places, "control", behind="fit_loops"),
    Placed(read_components, "control", behind="fit_loops"),
    Placed(arguments_in_registers, "control", behind="fit_loops"),
    Placed(long_logic, "control", behind="fit_loops"),
    Placed(joined_texts, "control", behind="steps"),
    Placed(signals_in_registers, "control", behind="steps"),
    Placed(zero_places, "storage", before="unread_flags"),
    Placed(limited_waits, "storage", before="unread_flags"),
)
LAST = (exact_ends, single_instructions)
