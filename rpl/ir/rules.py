"""The meaning of a dialect as data: conversions, defaults, look-ahead. The core asks this record, never the name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from rpl.ir.analog import AnalogPorts
from rpl.ir.types import Type

# Speeds (mm/s, deg/s, shares of the most) below this are no speeds: a move would last for months.
SLOWEST = 1e-6


@dataclass(frozen=True, slots=True)
class AdvanceRules:
    """How the program pointer runs ahead of the motion.

    moves: how many moves ahead at most (`advance` system variable overrides it where the language has it).
    runs_ahead_of: `all` moves (KRL), `fly_by` only (RAPID: a stop point halts the program until the robot is there), or
        `begun` ones (V+: a move holds the program until the robot has begun to drive it).
    lead_s: with `fly_by`, logic behind a fly-by move runs this long before the corner path begins.
    stop_statements: names of IR statement classes before which the controller waits for the motion to end.
    signals_stop: reading or writing a signal or an actual position waits for the motion to end.
    waits_queue: a time waited at rest is a move without a way: the robot keeps still, the program goes on.
    most: what the program may set `moves` to at most; 0: it cannot set it. source: where the numbers are from.
    late_corner: with `fly_by`, what the controller logs when the next move comes too late for the corner.
    """

    moves: int
    runs_ahead_of: str = "all"
    lead_s: float = 0.0
    stop_statements: frozenset[str] = frozenset()
    signals_stop: bool = False
    waits_queue: bool = False
    most: int = 0
    source: str = ""
    late_corner: str = ""


@dataclass(frozen=True, slots=True)
class TriggerRules:
    """Where actions on the path happen, and how far a time shifts them.

    measured: `path`: millimetres along the way that is driven, from the middle of a corner (KRL), or `programmed`:
        along the move as programmed, the rest of it in a corner standing for that half of the corner.
    start_behind_corner: the start with a time and no distance counts from where the corner at the move's start ends
        (KRL DISTANCE=0), any other one from its middle.
    delays_within_move: a time shifts an action no further than its move goes, one by a distance to the next stop.
    passes_points: a distance behind the end counts on in the moves behind, up to the next stop; else it is the end.
    end_at_joint_corner: what is left when a path is left for a joint move happens there, and a path that is met from a
        joint move has its actions behind the corner only.
    early_while_braking: an action a time before the end comes not earlier than the robot brakes (RAPID \\Time).
    on_paths_only: distances mean something on paths only; a joint move with such an action is a fault.
    """

    measured: str = "programmed"
    start_behind_corner: bool = False
    delays_within_move: bool = False
    passes_points: bool = False
    end_at_joint_corner: bool = False
    early_while_braking: bool = False
    on_paths_only: bool = False


@dataclass(frozen=True, slots=True)
class LoadVariables:
    """Of a controller that keeps its load in variables of the language (KRL): `variable` is the load in force; where
    that weighs nothing, the element of `table` that `number` says. components: neutral names (mass, `frame` of the
    centre in the flange, ix, iy, iz) -> those of the language, `a.b` for a component of a component."""

    variable: str
    table: str
    number: str
    components: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Range:
    """The values that a controller takes of a quantity (base units): from `least` (`above`: only beyond it) to `most`.

    Any other one stops the program where it is set or driven with. `at_least`: what happens at `least`, where that is
    allowed and yet hardly meant.
    """

    least: float = -math.inf
    most: float = math.inf
    above: bool = False
    at_least: str = ""

    def holds(self, value: float) -> bool:
        """Is this value (base units) one that the controller takes? NaN is none."""
        return (value > self.least if self.above else value >= self.least) and value <= self.most

    @property
    def text(self) -> str:
        """The range in words."""
        low = f"more than {self.least:g}" if self.above else f"at least {self.least:g}"
        if self.most == math.inf:
            return low
        high = f"at most {self.most:g}"
        return high if self.least == -math.inf else f"{low} and {high}"


# What no controller can drive with, whatever its language: by neutral system variable, or by the part of a move that
# stands for it. A speed of zero or less is told by the planner, together with what a speed is worked out from.
# M where no manual at hand says so: that a controller refuses what no robot can do (a negative time or corner).
RANGES: Mapping[str, Range] = {
    "override": Range(0.0, above=True),
    "speed_percent": Range(0.0, above=True),
    "speed_limit": Range(0.0, above=True),
    "path_acceleration": Range(0.0, above=True),
    "axis_acceleration": Range(0.0, above=True),
    "joint_acceleration": Range(0.0, above=True),
    "move_duration": Range(0.0),
    "blend_distance": Range(0.0),
    "blend_rotation": Range(0.0),
    "blend_joint": Range(0.0, 100.0),
    "blend_speed": Range(0.0, 100.0),
}

# How a message calls them, with the base unit.
QUANTITIES: Mapping[str, tuple[str, str]] = {
    "override": ("override", "%"),
    "speed_percent": ("share of the speed", "%"),
    "speed_limit": ("speed limit", "mm/s"),
    "joint_speed": ("axis speed", "%"),
    "external_speed": ("speed of external axes", "%"),
    "path_acceleration": ("path acceleration", "mm/s2"),
    "axis_acceleration": ("axis acceleration", "deg/s2"),
    "joint_acceleration": ("axis acceleration", "%"),
    "acceleration_percent": ("acceleration", "%"),
    "deceleration_percent": ("deceleration", "%"),
    "acceleration_ramp": ("acceleration ramp", "%"),
    "stop_ramp": ("ramp of a stop", "%"),
    "move_duration": ("time of the move", "s"),
    "blend_distance": ("corner distance", "mm"),
    "blend_rotation": ("corner angle", "deg"),
    "blend_joint": ("corner", "%"),
    "blend_speed": ("corner", "% of the speed"),
}


def refusal(name: str, value: float, allowed: Range) -> str:
    """Why a controller does not take a value (base units) of a quantity or variable; empty: it does."""
    if allowed.holds(value):
        return ""
    what, unit = QUANTITIES.get(name, (name, ""))
    return f"the {what} is {value:g}{' ' if unit else ''}{unit}, but must be {allowed.text}"


@dataclass(frozen=True, slots=True)
class InputRules:
    """What a controller makes of motion values that are no good (rpl.passes.motionvalues).

    rotation_limits: by how much the squares of a quaternion may miss 1 without and with being normalised; beyond, it
        cannot be used. large_corner: what happens to a corner larger than half of a move beside it (`half`: in mm).
    least_mass: kg of a load that is none below, and what happens then. without_tool: what happens before a tool is set.
    overlapping_blends: what is logged when a move is left out whose blend (`radius` mm) and that of the move before it
        (`before`) are longer than the `way` between both; empty: no move is.
    ranges: values of quantities that it takes, where they differ from RANGES; variable_ranges: those of the language's
    own variables, by name, without the digits at its end where it has a number (FANUC UTOOL_NUM, INFORM B000).
    """

    rotation_limits: tuple[float, float] | None = None
    large_corner: str = ""
    least_mass: float | None = None
    without_mass: str = ""
    without_tool: str = ""
    overlapping_blends: str = ""
    ranges: Mapping[str, Range] = field(default_factory=dict)
    variable_ranges: Mapping[str, Range] = field(default_factory=dict)

    def range_of(self, name: str) -> Range | None:
        """The values that the controller takes of a quantity; None: any."""
        return self.ranges.get(name, RANGES.get(name))

    def range_of_variable(self, name: str) -> Range | None:
        """The values that one of the language's own variables, or a list of them, holds; None: any."""
        return self.variable_ranges.get(name) or self.variable_ranges.get(name.rstrip("0123456789"))


@dataclass(frozen=True, slots=True)
class PassingRules:
    """A statement (how its text begins, in small letters) behind which an error of the next one does not stop the
    program: it goes on behind that one, and the error's number stands in a component of a variable, until another
    statement clears it."""

    statement: str
    clearing: str
    variable: str
    component: str


@dataclass(frozen=True, slots=True)
class Rules:
    """What differs between languages that share the IR.

    case_sensitive: of names. real_to_int: conversion put in where a real meets a whole number: a name of CONVERSIONS,
    or empty when the language refuses it. char_numbers: CHAR compares with numbers by code. text_plus: `+` joins texts.
    components: per built-in type class name, the language's component names (lower case) -> neutral names; a nested
    RAPID `robax.rax_1` maps step by step. undefined: reading a variable without a value is a fault (else zero values).
    unset_length: the length of a text without a value is 0 (else asking for it is such a fault).
    by_file: people start a program by its file: only its first routine, the others are its subprograms.
    whole_targets: a move to a position of which a component has no value is a fault (FANUC), else the component stays.
    implicit_pose: an undeclared name is a pose. call_depth: nested calls the controller allows.
    system_defaults: modal system variables at the start of a run, in base units. percent_limits: least and most that
    the controller takes of a percentage; a value beyond counts as that. errors: names of error numbers.
    group_bits: bits of a group of signals that has a name only, as its controller has them (URScript's registers: 32).
    blend_levels: distance in mm of each numbered blend level (INFORM PL). array_base: index of the first element of a
    list that is written out. first_signal: least number of a signal (0: not told); a smaller one that the program
    works out is a fault. number_marks: what stands before the digits of a number to another base, also in a text
    that is read as a number (longest first, in small letters). leading_numbers: such a text may go on behind its
    number, and without one it is 0. text_decimals: a number with a fraction shows so many decimals in a text,
    without zeros at the end; 0: six digits in all. text_length: characters that a text variable takes which says no
    length of its own (0: any). message_numbers, message_texts: of a controller whose messages show constant text
    only: regular expressions for what names a register of numbers, or any other register, in such a text.
    last_tool: while the program has set no tool, the place of the robot is told by tool and frame of the last move
    that named some (else by none). task_instances: starting a task that runs begins another one of its routine
    (else nothing happens). task_name: how lists of tasks call a motion task of that `{number}` where its own name
    is not known. exact_types: built-in types with components
    have to be equal too where a value is stored or passed. loads_of_tools: a tool has its own load; a load set for all
    moves is the part's, given in the tool, and that of one move is all of it (else there is one load, in the
    flange). load_variables: where it is kept, if not
    in the neutral system variable.
    functions: neutral function -> how the language spells it
    and its parameters' types in the language's words (`word.part`: the reader takes that component of the argument).
    triggers: where actions on the path happen. pulse_step_s: a pulse's length is rounded to this.
    inputs: what the controller makes of motion values that are no good. passing: how a program passes over an error.
    real_bits: of the mantissa of real numbers; 24: four-byte floats, to which each operation rounds. whole_bits: of
    whole numbers, sign included; a larger one is a fault where the language has a type of whole numbers, else it is
    rounded like a real number.
    kept_at: where the controller shows values that it keeps, by the word that their names begin with.
    mean_parabolas: a curve through points is the mean of the two parabolas that overlap there, weighted along the way
    (else it bends continuously; see rpl.passes.curves). analog: what numbers of analogue signals stand for, as far as
    the language fixes it; without a range the I/O configuration alone says it. system_data: modules (folded) of data
    that belong to the controller and not to a program; what a program does not use of them is no part of it.
    settings_data: variables that a reader keeps settings of the controller in (frames, the number of the frame in use,
    the time that waits take, whether one took too long); where moves and waits say it, nobody looks at them.
    """

    name: str
    advance: AdvanceRules
    case_sensitive: bool = False
    real_to_int: str = ""
    char_numbers: bool = False
    text_plus: bool = False
    components: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    undefined: bool = False
    by_file: bool = False
    unset_length: bool = False
    whole_targets: bool = False
    wait_poll_s: float = 0.0
    call_depth: int = 100
    system_defaults: Mapping[str, float | bool | str] = field(default_factory=dict)
    percent_limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    errors: Mapping[str, int] = field(default_factory=dict)
    type_names: Mapping[str, Type] = field(default_factory=dict)
    group_bits: int = 8
    blend_levels: tuple[float, ...] = ()
    array_base: int = 1
    first_signal: int = 0
    number_marks: Mapping[str, int] = field(default_factory=dict)
    leading_numbers: bool = False
    text_decimals: int = 0
    text_length: int = 0
    message_numbers: str = ""
    message_texts: str = ""
    last_tool: bool = True
    task_instances: bool = False
    task_name: str = ""
    exact_types: bool = False
    loads_of_tools: bool = False
    load_variables: LoadVariables | None = None
    functions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    triggers: TriggerRules = TriggerRules()
    pulse_step_s: float = 0.0
    inputs: InputRules = InputRules()
    passing: PassingRules | None = None
    real_bits: int = 53
    whole_bits: int = 64
    kept_at: Mapping[str, str] = field(default_factory=dict)
    mean_parabolas: bool = False
    analog: tuple[AnalogPorts, ...] = ()
    system_data: frozenset[str] = frozenset()
    settings_data: frozenset[str] = frozenset()

    def percents_of(self, name: str) -> tuple[float, float]:
        """Least and most that counts of a percentage of acceleration."""
        return self.percent_limits.get(name, (1.0, math.inf))
