"""What only the source has: names of its own for neutral things, its units, forms of places, settings and texts.
Behind it a program says the same in neutral words.
"""

from __future__ import annotations

from rpl.passes.legalise.source.countedloops import counted_loops
from rpl.passes.legalise.source.data.fixeddata import fixed_data
from rpl.passes.legalise.source.data.grownarrays import grown_arrays
from rpl.passes.legalise.source.data.keptvalues import kept_values_known
from rpl.passes.legalise.source.data.labellednames import labels_as_names
from rpl.passes.legalise.source.data.loadvariables import load_variables
from rpl.passes.legalise.source.data.ownnames import names_of_local_routines
from rpl.passes.legalise.source.data.undeclareddata import undeclared_data
from rpl.passes.legalise.source.data.untyped import drop_untyped
from rpl.passes.legalise.source.emptyreactions import without_empty_reactions
from rpl.passes.legalise.source.jumpsasblocks import jumps_as_blocks
from rpl.passes.legalise.source.knownlimits import known_limits
from rpl.passes.legalise.source.neutralfunctions import neutral_functions
from rpl.passes.legalise.source.places.copiedflags import copied_flags
from rpl.passes.legalise.source.places.displacements import displacements
from rpl.passes.legalise.source.places.elementwise import elementwise
from rpl.passes.legalise.source.places.fewaxes import axes_of_arm
from rpl.passes.legalise.source.places.homes import home_positions
from rpl.passes.legalise.source.places.keptangles import named_angles
from rpl.passes.legalise.source.places.knownshifts import known_shifts
from rpl.passes.legalise.source.places.movedcopies import moved_copies
from rpl.passes.legalise.source.places.placedata import places_as_targets
from rpl.passes.legalise.source.places.pulses import fold_pulses
from rpl.passes.legalise.source.places.rotationvectors import rotation_vectors
from rpl.passes.legalise.source.places.seenhalf import seen_half
from rpl.passes.legalise.source.places.shiftedplaces import shifted_places
from rpl.passes.legalise.source.places.toolways import ways_along_tool
from rpl.passes.legalise.source.places.unknownpulses import unknown_pulses
from rpl.passes.legalise.source.places.waynumbers import ways_as_numbers
from rpl.passes.legalise.source.precisions import precisions
from rpl.passes.legalise.source.rates import rates
from rpl.passes.legalise.source.sameunits import same_units
from rpl.passes.legalise.source.servos import servos
from rpl.passes.legalise.source.settingparts import whole_settings
from rpl.passes.legalise.source.signals.cyclicflags import cyclic_flags
from rpl.passes.legalise.source.signals.namedflags import named_flags
from rpl.passes.legalise.source.signals.readports import read_ports
from rpl.passes.legalise.source.signals.signalwords import signal_words
from rpl.passes.legalise.source.sourcelayout import source_layout
from rpl.passes.legalise.source.steptimes import step_times
from rpl.passes.legalise.source.texts.leadingnumbers import leading_numbers
from rpl.passes.legalise.source.texts.textbytes import text_bytes
from rpl.passes.legalise.source.texts.textdecimals import text_decimals
from rpl.passes.legalise.source.texts.textlengths import text_lengths
from rpl.passes.legalise.source.texts.wholetexts import whole_texts
from rpl.passes.legalise.source.timedwaits import timed_waits
from rpl.passes.legalise.source.waitsincalls import waits_in_calls
from rpl.passes.legalise.source.ways.constantorientations import constant_orientations
from rpl.passes.legalise.source.ways.levels import levels_to_distances
from rpl.passes.legalise.source.ways.placewaits import place_waits
from rpl.passes.legalise.source.ways.splines import straight_splines, without_path_rules
from rpl.passes.legalise.source.ways.turnedways import turned_ways
from rpl.passes.legalise.source.wholeformulas import whole_formulas
from rpl.passes.legalise.source.wholetimes import whole_times
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "source",
    (
        unknown_pulses,
        kept_values_known,
        undeclared_data,
        labels_as_names,
        waits_in_calls,
        signal_words,
        fixed_data,
        names_of_local_routines,
        source_layout,
        drop_untyped,
        precisions,
        text_lengths,
        grown_arrays,
        rates,
        servos,
        axes_of_arm,
        copied_flags,
        read_ports,
        seen_half,
        step_times,
        load_variables,
        whole_times,
        whole_formulas,
        jumps_as_blocks,
        known_limits,
        counted_loops,
        timed_waits,
        same_units,
        place_waits,
        cyclic_flags,
        named_flags,
        without_path_rules,
        straight_splines,
        home_positions,
        fold_pulses,
        known_shifts,
        moved_copies,
        shifted_places,
        neutral_functions,
        named_angles,
        rotation_vectors,
        ways_along_tool,
        places_as_targets,
        levels_to_distances,
        displacements,
        ways_as_numbers,
        whole_settings,
        whole_texts,
        text_bytes,
        leading_numbers,
        text_decimals,
        constant_orientations,
        turned_ways,
        elementwise,
        without_empty_reactions,
    ),
    Clause(
        statements="Spline",
        functions="displaced displaced_in_tool element_difference element_sum external_from_pulses "
        "interpolate_pose joint_pulses joints_from_pulses pose_from_rotation_vector pose_of pose_sum "
        "rotation_vector_x rotation_vector_y rotation_vector_z text_value with_external",
    ),
)
