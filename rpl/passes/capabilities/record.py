"""The whole record of a target. The passes ask it, never the target's name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from rpl.passes.capabilities.control import Control
from rpl.passes.capabilities.data import Data
from rpl.passes.capabilities.errors import Errors
from rpl.passes.capabilities.interrupts import Interrupts
from rpl.passes.capabilities.io import Io
from rpl.passes.capabilities.motion import Motion
from rpl.passes.capabilities.names import NameRules
from rpl.passes.capabilities.places import Places
from rpl.passes.capabilities.routines import Routines
from rpl.passes.capabilities.settings import Settings
from rpl.passes.capabilities.storage import Storage
from rpl.passes.capabilities.tasks import Tasks
from rpl.passes.capabilities.texts import Texts


@dataclass(frozen=True, slots=True)
class Capabilities:
    """What the target's controller can say: first its tables of what is written as it is, then its rules by concern.
    passes.legalise rewrites the rest before writing."""

    statements: frozenset[str]
    """Names of IR statement classes the writer prints (a Move may still be refused for one of its settings)."""

    functions: frozenset[str]
    """Neutral functions (ir.builtins) the writer prints."""

    procedures: frozenset[str]

    system_variables: frozenset[str]

    operators: frozenset[str]
    """Operators printed as they are."""

    types: frozenset[str]
    """Names of type classes that can be declared."""

    names: NameRules

    places: Places

    settings: Settings

    conversions: frozenset[str] = frozenset()
    """Conversions (ir.CONVERSIONS) that the writer prints."""

    said_otherwise: Mapping[str, str] = field(default_factory=dict)
    """Kinds of nodes (rpl.passes.legality.Illegal.kind) that stand in none of these tables, so that the passes avoid
    them, and that the writer says in some forms of its own; and how it says them."""

    carries_rules: bool = False
    """The target's text says by which language's rules a module runs (RPL's USING), so nothing has to be rewritten."""

    motion: Motion = field(default_factory=Motion)
    interrupts: Interrupts = field(default_factory=Interrupts)
    tasks: Tasks = field(default_factory=Tasks)
    io: Io = field(default_factory=Io)
    texts: Texts = field(default_factory=Texts)
    data: Data = field(default_factory=Data)
    errors: Errors = field(default_factory=Errors)
    routines: Routines = field(default_factory=Routines)
    control: Control = field(default_factory=Control)
    storage: Storage = field(default_factory=Storage)
