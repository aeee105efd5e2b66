"""The order of the passes. Each is listed once; its module says what it needs from the ones before it."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.accelerations import accelerations_of_moves
from rpl.passes.legalise.actionarguments import action_arguments
from rpl.passes.legalise.aggregates import aggregates
from rpl.passes.legalise.aheadreadings import ahead_readings
from rpl.passes.legalise.aliases import without_aliases
from rpl.passes.legalise.aliasing import without_shared_references
from rpl.passes.legalise.analogunits import analog_units
from rpl.passes.legalise.arcdistances import arc_distances
from rpl.passes.legalise.arcpoints import whole_arc_points
from rpl.passes.legalise.arithmetic import arithmetic
from rpl.passes.legalise.arrays import array_bases, array_sizes
from rpl.passes.legalise.askedpostures import asked_postures
from rpl.passes.legalise.atrest import at_rest
from rpl.passes.legalise.background import background_tasks
from rpl.passes.legalise.begunmoves import begun_moves, moves_ahead, polled_ahead
from rpl.passes.legalise.begunoutputs import begun_outputs
from rpl.passes.legalise.bitgroups import groups_to_bits, shared_groups_to_bits
from rpl.passes.legalise.calledtasks import called_tasks
from rpl.passes.legalise.calls import rewrite_calls
from rpl.passes.legalise.changedplaces import changed_places
from rpl.passes.legalise.circles import circle_rules
from rpl.passes.legalise.comparedrecords import compared_records
from rpl.passes.legalise.components import read_components
from rpl.passes.legalise.composition import compositions
from rpl.passes.legalise.configurations import configurations
from rpl.passes.legalise.constantorientations import constant_orientations
from rpl.passes.legalise.context import Context, Pass, names_in
from rpl.passes.legalise.coordinatedmoves import coordinated_moves
from rpl.passes.legalise.copiedflags import copied_flags
from rpl.passes.legalise.cornercalls import corner_calls
from rpl.passes.legalise.cornerleads import corner_leads
from rpl.passes.legalise.corners import corners
from rpl.passes.legalise.cornersteps import corner_steps
from rpl.passes.legalise.criticals import without_criticals
from rpl.passes.legalise.cyclicflags import cyclic_flags
from rpl.passes.legalise.datalists import set_data_at_start
from rpl.passes.legalise.declaredremarks import declared_remarks
from rpl.passes.legalise.defaults import starting_values
from rpl.passes.legalise.destinations import destinations
from rpl.passes.legalise.dialogs import number_dialogs
from rpl.passes.legalise.displacements import displacements
from rpl.passes.legalise.elementwise import elementwise
from rpl.passes.legalise.elseif import nest_branches
from rpl.passes.legalise.emptyreactions import without_empty_reactions
from rpl.passes.legalise.enums import enums_to_constants
from rpl.passes.legalise.errorcodes import name_errors
from rpl.passes.legalise.errornumbers import error_numbers
from rpl.passes.legalise.errorplaces import unreachable_moves
from rpl.passes.legalise.errorroutines import error_routines
from rpl.passes.legalise.errors import check_errors
from rpl.passes.legalise.errortexts import error_texts
from rpl.passes.legalise.explicit import explicit_to_modal
from rpl.passes.legalise.externalplaces import external_places
from rpl.passes.legalise.fewaxes import axes_of_arm
from rpl.passes.legalise.flagdata import flags_as_data, named_flags
from rpl.passes.legalise.flagreadings import flag_readings
from rpl.passes.legalise.flatrecords import flat_records
from rpl.passes.legalise.formats import formats
from rpl.passes.legalise.freepostures import free_postures
from rpl.passes.legalise.functions import functions_to_procedures
from rpl.passes.legalise.geometry import geometry
from rpl.passes.legalise.givenarrays import given_arrays
from rpl.passes.legalise.groups import name_groups
from rpl.passes.legalise.grownarrays import grown_arrays
from rpl.passes.legalise.handles import known_handles
from rpl.passes.legalise.heldmotion import held_motion
from rpl.passes.legalise.heldtimers import held_timers
from rpl.passes.legalise.homes import home_positions
from rpl.passes.legalise.interruptplaces import interrupt_places
from rpl.passes.legalise.interrupts import interrupts
from rpl.passes.legalise.joinedmoves import joined_moves, stand_before_ways
from rpl.passes.legalise.joins import joins
from rpl.passes.legalise.jointgoals import joint_goals
from rpl.passes.legalise.keptangles import named_angles
from rpl.passes.legalise.keptcorners import kept_corners
from rpl.passes.legalise.keptsettings import kept_settings
from rpl.passes.legalise.keptvalues import kept_values_known
from rpl.passes.legalise.knownjoints import known_joints
from rpl.passes.legalise.labelled import labels_as_remarks
from rpl.passes.legalise.labels import structure_to_labels
from rpl.passes.legalise.latedelays import without_late_delays
from rpl.passes.legalise.leadingnumbers import leading_numbers
from rpl.passes.legalise.levels import levels_to_distances
from rpl.passes.legalise.lists import lists_in_variables
from rpl.passes.legalise.loadreadings import load_readings
from rpl.passes.legalise.loadvariables import load_variables
from rpl.passes.legalise.locals import variables_of_routines
from rpl.passes.legalise.locks import critical_flags
from rpl.passes.legalise.logic import decide_logic
from rpl.passes.legalise.longlogic import long_logic
from rpl.passes.legalise.lookahead import stop_blends
from rpl.passes.legalise.loops import fit_loops
from rpl.passes.legalise.messages import message_lines, senders_as_texts, split_messages
from rpl.passes.legalise.mixedspeeds import mixed_speeds
from rpl.passes.legalise.modal import modal_to_explicit
from rpl.passes.legalise.modulepoints import points_of_modules
from rpl.passes.legalise.movesettings import settings_at_moves
from rpl.passes.legalise.movetimes import move_times
from rpl.passes.legalise.nearjoints import near_joints
from rpl.passes.legalise.nestedinterrupts import nested_interrupts
from rpl.passes.legalise.neutralfunctions import neutral_functions
from rpl.passes.legalise.nextmove import settings_of_next_move
from rpl.passes.legalise.nextmovecalls import next_moves_behind_calls
from rpl.passes.legalise.numbered import number_data
from rpl.passes.legalise.numbers import numbers
from rpl.passes.legalise.onceonly import reactions_once, rearmed_reactions
from rpl.passes.legalise.onemove import settings_of_one_move
from rpl.passes.legalise.optional import fit_parameters
from rpl.passes.legalise.otherarms import places_on_other_arm
from rpl.passes.legalise.overlapping import left_out_moves
from rpl.passes.legalise.overrides import full_override
from rpl.passes.legalise.ownnames import names_of_local_routines
from rpl.passes.legalise.ownplaces import own_places
from rpl.passes.legalise.ownrecords import apart_from_neutral_records
from rpl.passes.legalise.parameters import fit_arguments
from rpl.passes.legalise.partedcorners import parted_corners
from rpl.passes.legalise.partialplaces import partial_places
from rpl.passes.legalise.pathevents import path_events
from rpl.passes.legalise.pathpoints import path_points
from rpl.passes.legalise.polling import poll_waits
from rpl.passes.legalise.possiblecases import possible_cases
from rpl.passes.legalise.precisions import precisions
from rpl.passes.legalise.prelude import link_prelude
from rpl.passes.legalise.programtimes import program_times
from rpl.passes.legalise.pulsedoutputs import pulsed_outputs
from rpl.passes.legalise.pulselevels import pulse_levels
from rpl.passes.legalise.pulses import fold_pulses
from rpl.passes.legalise.queuedwaits import queued_waits
from rpl.passes.legalise.randomnumbers import random_numbers
from rpl.passes.legalise.rates import rates
from rpl.passes.legalise.reactions import reactions
from rpl.passes.legalise.reactionsearches import reaction_searches
from rpl.passes.legalise.readoverrides import read_overrides
from rpl.passes.legalise.readports import read_ports
from rpl.passes.legalise.recordsinuse import records_in_use
from rpl.passes.legalise.references import references_as_copies
from rpl.passes.legalise.refusals import refuse
from rpl.passes.legalise.repeatedmoves import repeated_moves
from rpl.passes.legalise.resetclocks import stopped_resets
from rpl.passes.legalise.restingwaits import resting_waits
from rpl.passes.legalise.results import list_results
from rpl.passes.legalise.resumes import resumes
from rpl.passes.legalise.rotationvectors import rotation_vectors
from rpl.passes.legalise.routineclocks import clocks_of_routines
from rpl.passes.legalise.saidtwice import said_once
from rpl.passes.legalise.sameunits import same_units
from rpl.passes.legalise.scaledaccelerations import scaled_accelerations
from rpl.passes.legalise.scaledspeeds import scaled_override
from rpl.passes.legalise.searches import searches
from rpl.passes.legalise.searchparts import search_parts
from rpl.passes.legalise.secondstarts import second_starts
from rpl.passes.legalise.seenhalf import seen_half
from rpl.passes.legalise.seenjoints import seen_joints
from rpl.passes.legalise.seenplaces import posed_places, seen_places
from rpl.passes.legalise.seldomlooks import seldom_looks
from rpl.passes.legalise.settingparts import whole_settings
from rpl.passes.legalise.sharing import share_temporaries
from rpl.passes.legalise.shown import values_beside_messages
from rpl.passes.legalise.signals import name_signals, number_signals
from rpl.passes.legalise.singledisables import single_disables
from rpl.passes.legalise.solvedplaces import solved_places
from rpl.passes.legalise.sourcelayout import source_layout
from rpl.passes.legalise.speeds import fit_speeds
from rpl.passes.legalise.speedshares import speed_shares
from rpl.passes.legalise.spelling import one_spelling
from rpl.passes.legalise.splines import straight_splines, without_path_rules
from rpl.passes.legalise.standing import stand_first
from rpl.passes.legalise.startbases import start_bases
from rpl.passes.legalise.startedtasks import started_tasks
from rpl.passes.legalise.statics import static_variables
from rpl.passes.legalise.steps import steps
from rpl.passes.legalise.steptimes import step_times
from rpl.passes.legalise.stoppedtasks import stopped_tasks
from rpl.passes.legalise.storedpaths import stored_paths
from rpl.passes.legalise.strengths import strengths
from rpl.passes.legalise.structure import labels_to_structure
from rpl.passes.legalise.subscriptchecks import checked_subscripts
from rpl.passes.legalise.subscripts import joined_subscripts
from rpl.passes.legalise.switches import unroll_switches
from rpl.passes.legalise.targets import whole_targets
from rpl.passes.legalise.taskarguments import task_arguments
from rpl.passes.legalise.taskdata import shared_task_data
from rpl.passes.legalise.tasknames import task_names
from rpl.passes.legalise.taskreferences import task_references
from rpl.passes.legalise.taskstarts import stand_before_tasks
from rpl.passes.legalise.taskstates import task_states
from rpl.passes.legalise.textbytes import text_bytes
from rpl.passes.legalise.textdecimals import text_decimals
from rpl.passes.legalise.textlengths import roomy_texts, text_lengths
from rpl.passes.legalise.textorders import text_orders
from rpl.passes.legalise.textpartchecks import checked_text_parts
from rpl.passes.legalise.threepoints import three_point_arcs
from rpl.passes.legalise.timers import timers_to_clocks
from rpl.passes.legalise.tooldata import tool_data
from rpl.passes.legalise.triggers import triggers
from rpl.passes.legalise.truths import truths_to_numbers
from rpl.passes.legalise.turnedways import turned_ways
from rpl.passes.legalise.turningtimes import turning_times
from rpl.passes.legalise.turningzones import full_zones, reduced_zones
from rpl.passes.legalise.turns import told_turns
from rpl.passes.legalise.undefined import asked_values
from rpl.passes.legalise.undefinedparts import asked_elements
from rpl.passes.legalise.unreadparameters import drop_unread_parameters
from rpl.passes.legalise.unused import drop_idle_data, drop_untyped, drop_unused
from rpl.passes.legalise.usedelements import used_elements
from rpl.passes.legalise.usualaccelerations import usual_accelerations
from rpl.passes.legalise.valuearrays import copy_value_arrays
from rpl.passes.legalise.waits import fit_waits
from rpl.passes.legalise.watches import counted_watches
from rpl.passes.legalise.watching import watching
from rpl.passes.legalise.wholesubscripts import whole_subscripts
from rpl.passes.legalise.wholetexts import whole_texts
from rpl.passes.legalise.wholetimes import whole_times
from rpl.passes.legalise.wholeturns import whole_turns
from rpl.passes.legalise.wristpaths import wrist_paths
from rpl.passes.legalise.writeonly import kept_outputs
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
    for one in PASSES:
        program = one(program, context)
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
