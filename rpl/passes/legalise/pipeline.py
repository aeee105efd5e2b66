"""The order of the passes. Each is listed once; its module says what it needs from the ones before it."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.advance.aheadreadings import ahead_readings
from rpl.passes.legalise.advance.arcdistances import arc_distances
from rpl.passes.legalise.advance.atrest import at_rest
from rpl.passes.legalise.advance.begunmoves import begun_moves, moves_ahead, polled_ahead
from rpl.passes.legalise.advance.begunoutputs import begun_outputs
from rpl.passes.legalise.advance.cornercalls import corner_calls
from rpl.passes.legalise.advance.cornerleads import corner_leads
from rpl.passes.legalise.advance.corners import corners
from rpl.passes.legalise.advance.cornersteps import corner_steps
from rpl.passes.legalise.advance.keptcorners import kept_corners
from rpl.passes.legalise.advance.latedelays import without_late_delays
from rpl.passes.legalise.advance.lookahead import stop_blends
from rpl.passes.legalise.advance.overlapping import left_out_moves
from rpl.passes.legalise.advance.partedcorners import parted_corners
from rpl.passes.legalise.advance.pathevents import path_events
from rpl.passes.legalise.advance.pathpoints import path_points
from rpl.passes.legalise.advance.standing import stand_first
from rpl.passes.legalise.advance.triggers import triggers
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.control.elseif import nest_branches
from rpl.passes.legalise.control.labels import structure_to_labels
from rpl.passes.legalise.control.logic import decide_logic
from rpl.passes.legalise.control.longlogic import long_logic
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.control.steps import steps
from rpl.passes.legalise.control.structure import labels_to_structure
from rpl.passes.legalise.control.switches import unroll_switches
from rpl.passes.legalise.data.aggregates import aggregates
from rpl.passes.legalise.data.aliases import without_aliases
from rpl.passes.legalise.data.arithmetic import arithmetic
from rpl.passes.legalise.data.arrays import array_bases, array_sizes
from rpl.passes.legalise.data.calls import rewrite_calls
from rpl.passes.legalise.data.comparedrecords import compared_records
from rpl.passes.legalise.data.datalists import set_data_at_start
from rpl.passes.legalise.data.defaults import starting_values
from rpl.passes.legalise.data.enums import enums_to_constants
from rpl.passes.legalise.data.flatrecords import flat_records
from rpl.passes.legalise.data.lists import lists_in_variables
from rpl.passes.legalise.data.neutralfunctions import neutral_functions
from rpl.passes.legalise.data.numbers import numbers
from rpl.passes.legalise.data.precisions import precisions
from rpl.passes.legalise.data.randomnumbers import random_numbers
from rpl.passes.legalise.data.subscriptchecks import checked_subscripts
from rpl.passes.legalise.data.subscripts import joined_subscripts
from rpl.passes.legalise.data.truths import truths_to_numbers
from rpl.passes.legalise.data.undefined import asked_values
from rpl.passes.legalise.data.undefinedparts import asked_elements
from rpl.passes.legalise.data.wholesubscripts import whole_subscripts
from rpl.passes.legalise.errors.errorcodes import name_errors
from rpl.passes.legalise.errors.errornumbers import error_numbers
from rpl.passes.legalise.errors.errorplaces import unreachable_moves
from rpl.passes.legalise.errors.errorroutines import error_routines
from rpl.passes.legalise.errors.errors import check_errors
from rpl.passes.legalise.errors.errortexts import error_texts
from rpl.passes.legalise.interrupts.emptyreactions import without_empty_reactions
from rpl.passes.legalise.interrupts.heldmotion import held_motion
from rpl.passes.legalise.interrupts.interruptplaces import interrupt_places
from rpl.passes.legalise.interrupts.interrupts import interrupts
from rpl.passes.legalise.interrupts.nestedinterrupts import nested_interrupts
from rpl.passes.legalise.interrupts.onceonly import reactions_once, rearmed_reactions
from rpl.passes.legalise.interrupts.rates import rates
from rpl.passes.legalise.interrupts.reactions import reactions
from rpl.passes.legalise.interrupts.reactionsearches import reaction_searches
from rpl.passes.legalise.interrupts.repeatedmoves import repeated_moves
from rpl.passes.legalise.interrupts.resumes import resumes
from rpl.passes.legalise.interrupts.searches import searches
from rpl.passes.legalise.interrupts.searchparts import search_parts
from rpl.passes.legalise.interrupts.singledisables import single_disables
from rpl.passes.legalise.interrupts.storedpaths import stored_paths
from rpl.passes.legalise.interrupts.watching import watching
from rpl.passes.legalise.io.analogunits import analog_units
from rpl.passes.legalise.io.bitgroups import groups_to_bits, shared_groups_to_bits
from rpl.passes.legalise.io.cyclicflags import cyclic_flags
from rpl.passes.legalise.io.flagdata import flags_as_data, named_flags
from rpl.passes.legalise.io.groups import name_groups
from rpl.passes.legalise.io.heldtimers import held_timers
from rpl.passes.legalise.io.polling import poll_waits
from rpl.passes.legalise.io.programtimes import program_times
from rpl.passes.legalise.io.pulsedoutputs import pulsed_outputs
from rpl.passes.legalise.io.pulselevels import pulse_levels
from rpl.passes.legalise.io.queuedwaits import queued_waits
from rpl.passes.legalise.io.readports import read_ports
from rpl.passes.legalise.io.resetclocks import stopped_resets
from rpl.passes.legalise.io.restingwaits import resting_waits
from rpl.passes.legalise.io.routineclocks import clocks_of_routines
from rpl.passes.legalise.io.seldomlooks import seldom_looks
from rpl.passes.legalise.io.signals import name_signals, number_signals
from rpl.passes.legalise.io.steptimes import step_times
from rpl.passes.legalise.io.timers import timers_to_clocks
from rpl.passes.legalise.io.waits import fit_waits
from rpl.passes.legalise.io.watches import counted_watches
from rpl.passes.legalise.io.wholetimes import whole_times
from rpl.passes.legalise.io.writeonly import kept_outputs
from rpl.passes.legalise.paths.arcpoints import whole_arc_points
from rpl.passes.legalise.paths.circles import circle_rules
from rpl.passes.legalise.paths.constantorientations import constant_orientations
from rpl.passes.legalise.paths.levels import levels_to_distances
from rpl.passes.legalise.paths.splines import straight_splines, without_path_rules
from rpl.passes.legalise.paths.threepoints import three_point_arcs
from rpl.passes.legalise.paths.turningzones import full_zones, reduced_zones
from rpl.passes.legalise.paths.wristpaths import wrist_paths
from rpl.passes.legalise.places.changedplaces import changed_places
from rpl.passes.legalise.places.components import read_components
from rpl.passes.legalise.places.composition import compositions
from rpl.passes.legalise.places.coordinatedmoves import coordinated_moves
from rpl.passes.legalise.places.destinations import destinations
from rpl.passes.legalise.places.displacements import displacements
from rpl.passes.legalise.places.elementwise import elementwise
from rpl.passes.legalise.places.geometry import geometry
from rpl.passes.legalise.places.keptangles import named_angles
from rpl.passes.legalise.places.partialplaces import partial_places
from rpl.passes.legalise.places.recordsinuse import records_in_use
from rpl.passes.legalise.places.rotationvectors import rotation_vectors
from rpl.passes.legalise.places.seenhalf import seen_half
from rpl.passes.legalise.places.seenplaces import posed_places, seen_places
from rpl.passes.legalise.places.targets import whole_targets
from rpl.passes.legalise.postures.askedpostures import asked_postures
from rpl.passes.legalise.postures.configurations import configurations
from rpl.passes.legalise.postures.copiedflags import copied_flags
from rpl.passes.legalise.postures.externalplaces import external_places
from rpl.passes.legalise.postures.fewaxes import axes_of_arm
from rpl.passes.legalise.postures.flagreadings import flag_readings
from rpl.passes.legalise.postures.freepostures import free_postures
from rpl.passes.legalise.postures.homes import home_positions
from rpl.passes.legalise.postures.jointgoals import joint_goals
from rpl.passes.legalise.postures.knownjoints import known_joints
from rpl.passes.legalise.postures.nearjoints import near_joints
from rpl.passes.legalise.postures.otherarms import places_on_other_arm
from rpl.passes.legalise.postures.pulses import fold_pulses
from rpl.passes.legalise.postures.seenjoints import seen_joints
from rpl.passes.legalise.postures.solvedplaces import solved_places
from rpl.passes.legalise.postures.turnedways import turned_ways
from rpl.passes.legalise.postures.turns import told_turns
from rpl.passes.legalise.postures.wholeturns import whole_turns
from rpl.passes.legalise.refusals import refuse
from rpl.passes.legalise.routines.actionarguments import action_arguments
from rpl.passes.legalise.routines.aliasing import without_shared_references
from rpl.passes.legalise.routines.functions import functions_to_procedures
from rpl.passes.legalise.routines.givenarrays import given_arrays
from rpl.passes.legalise.routines.optional import fit_parameters
from rpl.passes.legalise.routines.parameters import fit_arguments
from rpl.passes.legalise.routines.references import references_as_copies
from rpl.passes.legalise.routines.results import list_results
from rpl.passes.legalise.routines.unreadparameters import drop_unread_parameters
from rpl.passes.legalise.routines.valuearrays import copy_value_arrays
from rpl.passes.legalise.settings.accelerations import accelerations_of_moves
from rpl.passes.legalise.settings.explicit import explicit_to_modal
from rpl.passes.legalise.settings.joinedmoves import joined_moves, stand_before_ways
from rpl.passes.legalise.settings.keptsettings import kept_settings
from rpl.passes.legalise.settings.loadreadings import load_readings
from rpl.passes.legalise.settings.loadvariables import load_variables
from rpl.passes.legalise.settings.mixedspeeds import mixed_speeds
from rpl.passes.legalise.settings.modal import modal_to_explicit
from rpl.passes.legalise.settings.movesettings import settings_at_moves
from rpl.passes.legalise.settings.movetimes import move_times
from rpl.passes.legalise.settings.nextmove import settings_of_next_move
from rpl.passes.legalise.settings.nextmovecalls import next_moves_behind_calls
from rpl.passes.legalise.settings.onemove import settings_of_one_move
from rpl.passes.legalise.settings.overrides import full_override
from rpl.passes.legalise.settings.ownplaces import own_places
from rpl.passes.legalise.settings.readoverrides import read_overrides
from rpl.passes.legalise.settings.scaledaccelerations import scaled_accelerations
from rpl.passes.legalise.settings.scaledspeeds import scaled_override
from rpl.passes.legalise.settings.settingparts import whole_settings
from rpl.passes.legalise.settings.speeds import fit_speeds
from rpl.passes.legalise.settings.speedshares import speed_shares
from rpl.passes.legalise.settings.startbases import start_bases
from rpl.passes.legalise.settings.strengths import strengths
from rpl.passes.legalise.settings.tooldata import tool_data
from rpl.passes.legalise.settings.turningtimes import turning_times
from rpl.passes.legalise.settings.usualaccelerations import usual_accelerations
from rpl.passes.legalise.source.ownnames import names_of_local_routines
from rpl.passes.legalise.source.ownrecords import apart_from_neutral_records
from rpl.passes.legalise.source.possiblecases import possible_cases
from rpl.passes.legalise.source.prelude import link_prelude
from rpl.passes.legalise.source.sameunits import same_units
from rpl.passes.legalise.source.sourcelayout import source_layout
from rpl.passes.legalise.stages import Pass, run_passes
from rpl.passes.legalise.storage.declaredremarks import declared_remarks
from rpl.passes.legalise.storage.grownarrays import grown_arrays
from rpl.passes.legalise.storage.keptvalues import kept_values_known
from rpl.passes.legalise.storage.labelled import labels_as_remarks
from rpl.passes.legalise.storage.locals import variables_of_routines
from rpl.passes.legalise.storage.modulepoints import points_of_modules
from rpl.passes.legalise.storage.numbered import number_data
from rpl.passes.legalise.storage.saidtwice import said_once
from rpl.passes.legalise.storage.sharing import share_temporaries
from rpl.passes.legalise.storage.spelling import one_spelling
from rpl.passes.legalise.storage.statics import static_variables
from rpl.passes.legalise.storage.unused import drop_idle_data, drop_untyped, drop_unused
from rpl.passes.legalise.storage.usedelements import used_elements
from rpl.passes.legalise.tasks.background import background_tasks
from rpl.passes.legalise.tasks.calledtasks import called_tasks
from rpl.passes.legalise.tasks.criticals import without_criticals
from rpl.passes.legalise.tasks.handles import known_handles
from rpl.passes.legalise.tasks.joins import joins
from rpl.passes.legalise.tasks.locks import critical_flags
from rpl.passes.legalise.tasks.secondstarts import second_starts
from rpl.passes.legalise.tasks.startedtasks import started_tasks
from rpl.passes.legalise.tasks.stoppedtasks import stopped_tasks
from rpl.passes.legalise.tasks.taskarguments import task_arguments
from rpl.passes.legalise.tasks.taskdata import shared_task_data
from rpl.passes.legalise.tasks.tasknames import task_names
from rpl.passes.legalise.tasks.taskreferences import task_references
from rpl.passes.legalise.tasks.taskstarts import stand_before_tasks
from rpl.passes.legalise.tasks.taskstates import task_states
from rpl.passes.legalise.texts.dialogs import number_dialogs
from rpl.passes.legalise.texts.formats import formats
from rpl.passes.legalise.texts.leadingnumbers import leading_numbers
from rpl.passes.legalise.texts.messages import message_lines, senders_as_texts, split_messages
from rpl.passes.legalise.texts.shown import values_beside_messages
from rpl.passes.legalise.texts.textbytes import text_bytes
from rpl.passes.legalise.texts.textdecimals import text_decimals
from rpl.passes.legalise.texts.textlengths import roomy_texts, text_lengths
from rpl.passes.legalise.texts.textorders import text_orders
from rpl.passes.legalise.texts.textpartchecks import checked_text_parts
from rpl.passes.legalise.texts.wholetexts import whole_texts
from rpl.passes.typing import normalise

# First what asks for the source language's own rules (its prelude, its look-ahead), then signals and control (each may
# make what a later one rewrites: errors make Repeat, switches make cor), then data and motion, geometry last. Structure
# comes out of labels first (what follows the flow sees more) and again behind what makes jumps; labels come behind all
# that makes or needs blocks. Functions become procedures when no pass makes calls any more; what that puts in front of
# conditions makes loops, so these are fitted again; then nested expressions become steps (and again behind labels,
# whose conditions are opposites), and nothing needs new variables of routines. Numbers are given when nothing has a
# name to add.
PASSES: tuple[Pass, ...] = (
    kept_values_known,
    names_of_local_routines,
    source_layout,
    drop_untyped,
    precisions,
    text_lengths,
    grown_arrays,
    rates,
    axes_of_arm,
    copied_flags,
    read_ports,
    records_in_use,
    seen_half,
    step_times,
    load_readings,
    load_variables,
    whole_times,
    same_units,
    shared_task_data,
    cyclic_flags,
    named_flags,
    task_names,
    started_tasks,
    task_states,
    without_path_rules,
    straight_splines,
    home_positions,
    fold_pulses,
    neutral_functions,
    named_angles,
    rotation_vectors,
    levels_to_distances,
    displacements,
    whole_settings,
    changed_places,
    random_numbers,
    formats,
    whole_texts,
    text_orders,
    text_bytes,
    leading_numbers,
    text_decimals,
    constant_orientations,
    turned_ways,
    elementwise,
    known_handles,
    second_starts,
    called_tasks,
    searches,
    reaction_searches,
    search_parts,
    at_rest,
    without_late_delays,
    without_empty_reactions,
    interrupt_places,
    unreachable_moves,
    error_numbers,
    error_texts,
    link_prelude,
    apart_from_neutral_records,
    used_elements,
    possible_cases,
    wrist_paths,
    labels_to_structure,
    queued_waits,
    next_moves_behind_calls,
    settings_of_next_move,
    scaled_accelerations,
    joined_moves,
    move_times,
    turning_times,
    error_routines,
    without_shared_references,
    list_results,
    lists_in_variables,
    compared_records,
    joined_subscripts,
    array_bases,
    seen_joints,
    near_joints,
    known_joints,
    solved_places,
    elementwise,
    asked_postures,
    joint_goals,
    partial_places,
    external_places,
    whole_arc_points,
    three_point_arcs,
    circle_rules,
    destinations,
    flag_readings,
    free_postures,
    places_on_other_arm,
    configurations,
    told_turns,
    without_aliases,
    stop_blends,
    begun_moves,
    begun_outputs,
    program_times,
    held_timers,
    reactions_once,
    nested_interrupts,
    single_disables,
    action_arguments,
    triggers,
    stored_paths,
    held_motion,
    reactions,
    resumes,
    interrupts,
    rearmed_reactions,
    repeated_moves,
    clocks_of_routines,
    stopped_resets,
    static_variables,
    task_references,
    without_criticals,
    critical_flags,
    background_tasks,
    stopped_tasks,
    joins,
    task_arguments,
    speed_shares,
    full_override,
    read_overrides,
    kept_settings,
    refuse,
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
    whole_subscripts,
    numbers,
    starting_values,
    fit_parameters,
    asked_values,
    given_arrays,
    asked_elements,
    copy_value_arrays,
    checked_subscripts,
    checked_text_parts,
    array_sizes,
    check_errors,
    labels_to_structure,
    seldom_looks,
    resting_waits,
    fit_waits,
    pulsed_outputs,
    pulse_levels,
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
    coordinated_moves,
    strengths,
    usual_accelerations,
    fit_speeds,
    left_out_moves,
    corners,
    reduced_zones,
    stand_before_ways,
    accelerations_of_moves,
    settings_of_one_move,
    corner_leads,
    corner_calls,
    modal_to_explicit,
    full_zones,
    tool_data,
    own_places,
    mixed_speeds,
    corner_steps,
    moves_ahead,
    explicit_to_modal,
    start_bases,
    kept_corners,
    settings_at_moves,
    parted_corners,
    scaled_override,
    stand_first,
    arc_distances,
    path_points,
    seen_places,
    posed_places,
    aggregates,
    geometry,
    whole_turns,
    flat_records,
    drop_unread_parameters,
    compositions,
    path_events,
    watching,
    stand_before_tasks,
    arithmetic,
    functions_to_procedures,
    fit_arguments,
    fit_loops,
    read_components,
    long_logic,
    steps,
    variables_of_routines,
    nest_branches,
    structure_to_labels,
    steps,
    name_errors,
    ahead_readings,
    polled_ahead,
    said_once,
    drop_unused,
    points_of_modules,
    labels_as_remarks,
    one_spelling,
    truths_to_numbers,
    roomy_texts,
    share_temporaries,
    drop_idle_data,
    number_data,
)


def legalise(program: ir.Program, context: Context) -> ir.Program:
    """The program rewritten for the context's target and governed by its rules.

    Same-language writing leaves it as it is.
    """
    context.taken |= names_in(program)
    other_arm = context.robot is not None and context.to_robot is not None and context.robot is not context.to_robot
    if not context.foreign or context.capabilities.carries_rules:
        return configurations(places_on_other_arm(program, context), context) if other_arm else program
    program = run_passes(PASSES, program, context)
    return normalise(_governed(program, context), context.diagnostics)


def _governed(program: ir.Program, context: Context) -> ir.Program:
    """The program under the target's rules; targets that passes have added take its notation."""
    old, new = ir.TargetType(context.source), ir.TargetType(context.capabilities.notation)

    def retyped(type: ir.Type) -> ir.Type:
        match type:
            case ir.TargetType() if type.notation == old.notation:
                return replace(type, notation=new.notation)
            case ir.ArrayType(element=element):
                return replace(type, element=retyped(element))
        return type

    def declared(declaration: ir.Declaration) -> ir.Declaration:
        match declaration:
            case ir.Variable():
                return replace(declaration, type=retyped(declaration.type))
            case ir.RecordDeclaration(fields=fields):
                return replace(declaration, fields=tuple((name, retyped(type)) for name, type in fields))
        return declaration

    def routine(one: ir.Routine) -> ir.Routine:
        return replace(
            one,
            parameters=tuple(replace(parameter, type=retyped(parameter.type)) for parameter in one.parameters),
            returns=None if one.returns is None else retyped(one.returns),
            declarations=tuple(map(declared, one.declarations)),
        )

    modules = tuple(
        replace(
            module,
            dialect=context.target,
            declarations=tuple(map(declared, module.declarations)),
            routines=tuple(map(routine, module.routines)),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)
