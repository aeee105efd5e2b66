"""What only KRL needs of a program, each pass with its place among those of the core."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .begunanew import begun_anew
from .changedplaces import changed_places
from .framenumbers import frame_numbers
from .groups import name_groups
from .heldmotion import held_motion
from .inlineforms import inline_forms
from .onemove import settings_of_one_move
from .plainstops import plain_stops
from .roomytexts import roomy_texts
from .searches import searches
from .shifts import said_shifts
from .signalnames import signals_by_name
from .startbases import start_bases
from .ways import ways_as_frames
from .writestates import states_of_writes

PASSES: tuple[Placed, ...] = (
    Placed(changed_places, "source", behind="whole_settings"),
    Placed(ways_as_frames, "source", before="elementwise"),
    Placed(plain_stops, "paths", behind="whole_targets"),
    Placed(searches, "searches", before="search_parts"),
    Placed(held_motion, "interrupts", behind="stored_paths"),
    Placed(name_groups, "io", behind="number_signals"),
    Placed(states_of_writes, "statements", behind="rewrite_calls"),
    Placed(settings_of_one_move, "settings", behind="accelerations_of_moves"),
    Placed(start_bases, "settings", behind="explicit_to_modal"),
    Placed(said_shifts, "settings", behind="stand_first"),
    Placed(frame_numbers, "settings", behind="stand_first"),
    Placed(begun_anew, "storage", behind="drop_unused"),
    Placed(roomy_texts, "storage", behind="one_spelling"),
    Placed(signals_by_name, "storage", behind="one_spelling"),
    Placed(inline_forms, "storage", behind="place_made_statements"),
)
