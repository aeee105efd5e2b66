"""What a target's controller can say, as data. The passes ask this record, never the target's name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from rpl.ir.types import Type


@dataclass(frozen=True, slots=True)
class NameRules:
    """What the target accepts as a name. `reserved` in lower case when names are case-insensitive. `longest_routine`:
    the length of a routine's name where that is shorter (0: as any other). `predefined`: names (lower case) of the data
    and routines every controller has; a program's own of that name would hide it, so it gets another."""

    longest: int
    case_sensitive: bool
    reserved: frozenset[str]
    first: str = "abcdefghijklmnopqrstuvwxyz"
    further: str = "abcdefghijklmnopqrstuvwxyz0123456789_"
    longest_routine: int = 0
    predefined: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Bank:
    """Numbered storage of a controller: elements `first`..`last` under one name (`R[1]`..`R[200]`). `holds`: what else
    has these numbers, a kind of signal or a system variable (flags, timers). `most`: the last number there can be when
    the controller is set up for more (0: there are never more)."""

    name: str
    first: int
    last: int
    holds: str = ""
    most: int = 0


@dataclass(frozen=True, slots=True)
class Capabilities:
    """What the target's controller can say. passes.legalise rewrites the rest before writing.

    statements: names of IR statement classes the writer prints (a Move may still be refused for one of its settings).
    functions, procedures, system_variables: neutral names (ir.builtins) the writer prints.
    operators: operators printed as they are. said_otherwise: kinds of nodes (rpl.passes.legality.Illegal.kind) that
    stand in none of these tables, so that the passes avoid them, and that the writer says in some forms of its own.
    modal_motion: tool, frame, speed and blend are modal (KRL); otherwise each
    move names them (RAPID). for_at_least_once / for_scoped / for_automatic: the target's FOR has exactly that rule.
    postures: `flags` of the notation in a target, or `joints` that a joint move solves near to (targets have none).
    place_turns: a joint move to a place comes there in the turns that are told with it (by flags, or by the joints that
    it is solved near to; else the controller takes each axis the shortest way).
    flags: whether the controller has flags with numbers, or the passes give them names (else they are data).
    most_arguments: how many arguments a call has at most (0: any).
    asked_frames: whether a program can ask for the frame in force (else a variable keeps it where one does).
    last_flag: the largest number of a flag there is (0: any); flags beyond it are data.
    reads_override: a program may read the override that it can set.
    flags_by_sign: a target's flags name the sign of every axis, so they hold for its very place only.
    notation: arm configuration notation; rotation: `zyx` (a, b, c) or `quaternion` (rot) components.
    types: names of type classes that can be declared. signal_prefixes: empty when signals have numbers (KRL); otherwise
    signals have names (RAPID), and a number 5 of a kind is called prefix + 5. named_aggregates: members are named (else
    listed in order); partial_aggregates: some may be left out; constant_aggregates: members must be constants.
    keeps_angles: a place keeps its angles a, b and c as they were set (else each angle that is set is put together with
    the others, which are worked out from the place). whole_places: a component is set by making a new place of the old
    one, which must have a value. untyped_places: what
    holds a place holds a pose or joints, as it was given last; a component is one of what is there.
    for_real: the counter of a FOR may be a real number. waits_at_rest: waits say that
    the robot stands before they begin. wait_timeout: WaitUntil takes a timeout. timers: how many
    system timers there are (`timer[1]` ...). counted_clocks: there are no stop watches, but a task can count them in
    steps of so many seconds (0: none can, or there are some).
    dynamic_calls: a procedure may be called by a name computed at run time.
    switch_types: type classes a Switch may select by (NamedType: enumerations); empty: any type.
    switch_constant_cases: case values must be literals. switch_variables: it looks at a variable, at no signal or other
    value. text_results: functions may return texts. text_room: each text is declared with its longest length: what it
    gets where nothing says more, and the most that the controller's own functions take.
    kinematics: functions of the controller for the joints of a target (near joints) and for the target of joints, that
    write 0 or an error into a further argument, when that is how it says so.
    format_state: type of the state that format_into writes; None when it has none. carries_rules: the target's text
    says by which language's rules a module runs (RPL's USING), so nothing has to be rewritten.

    Flow: which of If, Switch, For, While, Repeat, Loop, ExitLoop, NextPass, Goto, Label stand in `statements` says what
    structure there is; without If there is still `If` with one Goto as its only branch. else_if: an If may have several
    branches. switch_jumps: a case of a Switch holds one Goto or one call. for_keeps_last: a FOR's counter keeps the
    last value a pass ran with. for_looks_once: the last value is looked at before the first pass only. for_steps:
    `any`, or `one` (only up or down by 1). shortest_wait_s: the smallest time that a wait can be given (0: any).
    places_beside: a separate background task can ask where the robot is. poll_s: time between two looks in a
    loop that waits for a condition, for targets without WaitUntil. next_move_settings: SetForNextMove can be said;
    otherwise it is attached to the next move. search_results: what a search move gives, `found` (the place) and `hit`
    (whether). task_operations: ops of TaskControl, where that is in `statements`; without it, background_tasks: the
    controller runs background programs that see the data of the others (`shared`), or modules of their own that share
    persistent data by name (`separate`). moving_tasks: a task that the program starts may move the robot.
    stopping_reactions: an interrupt can
    brake the robot and drop its move (DeclareInterrupt `stops`), and the program goes on behind that. interrupt_masks:
    the less urgent interrupts can be made to wait (ControlInterrupt `mask`). one_shot_reactions: an interrupt that has
    come is off until it is armed again (DeclareInterrupt `once`); elsewhere it comes at each edge. single_disables: a
    single interrupt can be disabled. shortest_interrupt_period_s: of interrupts that come with time, which look at what
    no other one can. action_arguments: what an interrupt (`reaction`) or a place on the path (`path`) calls may have
    arguments, also variables of the routine around it (`own`). path_assignments: what a place on the path assigns:
    `any` variable, or `signals` (else a routine assigns it).

    Routines: local_routines: a routine can be seen by its module alone. function_routines: there are user functions
    (else procedures that leave their result in a variable).
    parameters: `names`; `numbered` (argument registers: numbers and texts by value, the rest in variables); `none`.
    reference_parameters: a routine may write its parameters (else copies go in, and out by variables).
    arrays_by_value: an array can be an argument by value (else the routine gets the caller's own).
    list_arguments: a list that is written out can be an argument (else it is stored in a variable first).
    compares_records: whole records are compared (else each of their components).
    list_results: functions may return arrays (else they write a parameter).
    locals: a routine has variables of its own; static_locals: also some that keep their values from call to call;
    local_clocks: also stop watches. reset_stops: a stop watch that is set to zero stands (else it counts on).
    recursion: a routine may be active twice, each time with variables of its own (else they are kept on a stack
    around calls that lead back). call_depth: how deep calls nest (0: not said).

    Data: banks: where variables of a type (class name) are kept, when they have numbers and no names; types may share a
    bank. points: taught points that live in a routine. module_points: they are data of the module: constants
    (`module`, `global` where all modules share their names) or a data list that the pendant changes (`list`).
    records, arrays (False only with banks: consecutive numbers),
    texts: whether there are any. line_ends: they may have line ends (else a message is shown line by line).
    longest_message: characters of a message's line (0: any).
    joined_texts: texts that one assignment joins at most (0: any).
    numbered_messages: who sends a message may be a number (the number of an alarm); else it is a text.
    computed_messages: a message may show computed text (else it names the registers of its values).
    asks_numbers_only: the operator can type a number, and the question is a message in front of it. text_case:
    comparisons of texts tell capital letters from small ones. text_ordering: `<` of texts is their order (else only
    `=` and `<>` compare them). text_find_from: text_find begins at any position.
    printable_texts: a text holds only the printable signs of ASCII, so no bytes.
    leading_numbers: a text that is read as a number may go on behind it; without a number it is 0.
    text_decimals: a number with a fraction shows so many decimals in a text (0: six digits in all).
    computed_decimals: a number can be rounded to a count of decimals that is computed.
    text_parts: without numbered storage as well, helpers read numbers from texts and search them by cutting and
    comparing parts.
    text_parts_cut: a part that goes beyond the end of its text is shorter or empty (else the controller stops).
    truth: `minus_one` when TRUE is the number -1 and there is no type of truth values.
    faults_outside: the controller stops at an index outside of an array (else the program looks first).
    faults_fractions: it stops at an index with a fraction, in place of rounding or cutting it (the same).
    index_base: where arrays start; None: anywhere. expressions: `steps` when an assignment has one operator or function
    of constants and variables. calculated_places: moves, signals, waits take any expression. conditions: `comparisons`
    of two simple operands, joined by and/or.
    condition_terms: how many comparisons such a condition has at most, spelled out without brackets (0: any).
    logic_names: variables and signals that one condition or truth value names at most, to fit in a line (0: any).
    fixed_arcs: an arc may keep the tool as it is to the arc (else its end is worked out). searched_data: a search may
    look at a truth value, which another task sets, in place of an input.
    functions_alone: a function only as the whole right side of an assignment.

    Motion: move_settings: which of `tool`, `frame`, `speed`, `blend`, `deceleration` a move says itself, the rest being
    modal (System tool, base, and modal_motion set); empty: all or none, in data of types of RAPID or KRL. Only then:
    speeds: fields of Speed that the target says (for joint moves `joint`, `axis`; for the others `path`, ...);
    blends: blend classes that it says (BlendStop always). move_functions: functions (and `:`) that a move's target may
    be although nothing else can: a place seen from another one, with simple operands. places_in_base: functions of
    places know only the tool in use and the robot's base. no_tool, no_frame: the target's
    own tool and work object data without any offset; then moves name such data, and no plain poses. arcs_by_angle: an
    arc may go on for an angle (else it ends at a computed point). paths_to_joints: a straight move may go to joint
    values. place_components: the components of taught points and of the robot's place can be read.

    turned_ways: a relative move may turn the tool too, in the axes of the frame (`base`) or the `tool`, and a `joint`
    move may go such a way (else it goes to a computed place).

    wrist_paths: the wrist axes of a straight move may go evenly to their end values.

    path_points: the smallest corner (mm) of a point that the writer cuts a straight move at for an action on its path;
    where the ends of the move are computed, a pass does it (0: moves are not cut).

    row_sizes: the function `dimension` tells of a list in lists how many there are in any of its dimensions (else the
    sizes of such a list come with it where a routine is given it).

    whole_texts: `value_text` makes a text of a value with components too (else of those one by one).

    timed_arcs: an arc may say its time, where the other moves can (else it gets the speed that takes so long).

    straight_distances: a place on the way of an arc is looked for by how far it is straight from an end of the arc.

    move_triggers: a move says the actions on its path itself (Move.triggers), and only so. late_triggers: an action
    on the path may come some time behind the end of a move that stops there (else a task does it).
    concurrent_moves: a program that goes on while a move is driven: `moves` say so (or a task of watching_tasks drives
    them), the program runs `advance` over moves where it is allowed to, or `tasks` do what stands beside the move;
    empty: it waits, which is named a loss.
    ways_from_here: a way in joints is worked out from where the robot is, which has to stand for it.
    watching_tasks: path events, searches and interrupts stand in `statements` although moves and the controller have
    none: the passes make tasks of them that watch beside the move (pathevents, watching). watched_interrupts: only
    interrupts are such tasks; one that stops the robot ends its moves by a search. pulse_levels: a Pulse may be to any
    level (else it is to high). pulse_times: its length may be computed (else it is a number).

    declared_groups: a group of signals exists only by a declaration with a name (KRL SIGNAL). signal_groups: a group
    can be named by its first and last signal, or a pass or the writer finds a name for it. Where signals have names
    (signal_prefixes), a group has one of its own; groups of which a part is used otherwise are written bit by bit.
    widest_group: bits of a group at most, where a program shows that eight are not enough.
    group_sizes: a group has so many signals and begins behind a multiple of them (empty: any).
    computed_groups: a group may have computed numbers. Without it, or where groups are declared or have names, such
    groups of a constant width are written bit by bit.
    numbered_groups: groups have numbers of their own beside those of their bits (GO[2]). write_only: kinds of outputs
    that programs set and cannot read back.
    curve_points: moves of the kind spline in a row, from a first one at its beginning, are one curve through points
    (INFORM MOVS); there are no spline blocks.
    """

    statements: frozenset[str]
    functions: frozenset[str]
    procedures: frozenset[str]
    system_variables: frozenset[str]
    operators: frozenset[str]
    types: frozenset[str]
    names: NameRules
    modal_motion: bool
    notation: str
    rotation: str
    for_at_least_once: bool = False
    for_scoped: bool = False
    for_automatic: bool = False
    error_handlers: bool = False
    optional_parameters: bool = False
    curve_points: bool = False
    short_circuit: bool = False
    enums: bool = False
    text_room: tuple[int, int] | None = None
    conversions: frozenset[str] = frozenset()
    signal_prefixes: Mapping[str, str] = field(default_factory=dict)
    for_real: bool = False
    wait_timeout: bool = False
    waits_at_rest: bool = True
    timers: int = 0
    counted_clocks: float = 0.0
    dynamic_calls: bool = False
    switch_types: frozenset[str] = frozenset()
    switch_constant_cases: bool = False
    switch_variables: bool = False
    text_results: bool = True
    named_aggregates: bool = False
    partial_aggregates: bool = False
    constant_aggregates: bool = False
    whole_places: bool = False
    keeps_angles: bool = True
    untyped_places: bool = False
    format_state: Type | None = None
    kinematics: tuple[str, str] | None = None
    carries_rules: bool = False
    relative_moves: bool = False
    turned_ways: frozenset[str] = frozenset(("base", "tool", "joint"))
    partial_targets: bool = False
    flags_by_sign: bool = False
    flags: bool = True
    last_flag: int = 0
    asked_frames: bool = True
    most_arguments: int = 0
    reads_override: bool = True
    wrist_paths: bool = True
    data_lists: bool = False
    aliases: bool = False
    else_if: bool = True
    switch_jumps: bool = False
    poll_s: float = 0.008
    shortest_wait_s: float = 0.0
    places_beside: bool = False
    for_keeps_last: bool = False
    for_looks_once: bool = True
    for_steps: str = "any"
    local_routines: bool = True
    function_routines: bool = True
    parameters: str = "names"
    reference_parameters: bool = True
    locals: bool = True
    static_locals: bool = False
    local_clocks: bool = True
    reset_stops: bool = True
    arrays_by_value: bool = True
    list_arguments: bool = True
    compares_records: bool = False
    list_results: bool = False
    recursion: bool = True
    call_depth: int = 0
    next_move_settings: bool = False
    search_results: frozenset[str] = frozenset(("found",))
    stopping_reactions: bool = False
    interrupt_masks: bool = False
    one_shot_reactions: bool = False
    single_disables: bool = False
    shortest_interrupt_period_s: float = 0.0
    action_arguments: frozenset[str] = frozenset(("reaction", "path"))
    task_operations: frozenset[str] = frozenset(("start", "stop", "pause", "resume", "join"))
    background_tasks: str = ""
    moving_tasks: bool = True
    banks: Mapping[str, Bank] = field(default_factory=dict)
    points: Bank | None = None
    module_points: str = ""
    records: bool = True
    arrays: bool = True
    texts: bool = True
    line_ends: bool = False
    longest_message: int = 0
    joined_texts: int = 0
    numbered_messages: bool = False
    computed_messages: bool = True
    asks_numbers_only: bool = False
    text_find_from: bool = True
    computed_decimals: bool = True
    text_parts: bool = False
    printable_texts: bool = False
    leading_numbers: bool = False
    text_decimals: int = 0
    text_case: bool = True
    text_ordering: bool = False
    truth: str = "bool"
    index_base: int | None = 1
    faults_outside: bool = True
    faults_fractions: bool = True
    text_parts_cut: bool = False
    expressions: str = "any"
    calculated_places: bool = True
    arcs_by_angle: bool = False
    paths_to_joints: bool = True
    place_components: bool = True
    path_points: float = 0.0
    conditions: str = "any"
    condition_terms: int = 0
    logic_names: int = 0
    functions_alone: bool = False
    fixed_arcs: bool = False
    searched_data: bool = False
    move_settings: frozenset[str] = frozenset()
    speeds: frozenset[str] = frozenset()
    blends: frozenset[str] = frozenset()
    row_sizes: bool = True
    whole_texts: bool = False
    timed_arcs: bool = False
    straight_distances: bool = False
    path_assignments: str = "any"
    move_triggers: bool = False
    late_triggers: bool = True
    concurrent_moves: str = ""
    ways_from_here: bool = False
    watching_tasks: bool = False
    watched_interrupts: bool = False
    pulse_levels: bool = True
    pulse_times: bool = True
    declared_groups: bool = False
    signal_groups: bool = True
    group_sizes: tuple[int, ...] = ()
    widest_group: int = 8
    computed_groups: bool = True
    numbered_groups: bool = False
    write_only: frozenset[str] = frozenset()
    postures: str = "flags"
    place_turns: bool = True
    move_functions: frozenset[str] = frozenset()
    said_otherwise: frozenset[str] = frozenset()
    places_in_base: bool = False
    no_tool: str = ""
    no_frame: str = ""
