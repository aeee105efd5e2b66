"""What a target's controller can say, as data: one record, its parts by concern."""

from rpl.passes.capabilities.control import Control, Counting, Limit
from rpl.passes.capabilities.data import Aggregate, Composite, Data, DataRule
from rpl.passes.capabilities.errors import Errors, Fault
from rpl.passes.capabilities.interrupts import ActionArguments, InterruptRule, Interrupts, Watched
from rpl.passes.capabilities.io import GroupRule, Io, PulseRule
from rpl.passes.capabilities.motion import Motion, PathRule, SearchResult, TriggerRule, TurnedWay
from rpl.passes.capabilities.names import AS_MODULE, NameRules
from rpl.passes.capabilities.places import PlaceRule, Places, Postures
from rpl.passes.capabilities.record import Capabilities
from rpl.passes.capabilities.routines import Local, Parameters, Passing, RoutineRule, Routines
from rpl.passes.capabilities.settings import MoveSetting, SettingRule, Settings
from rpl.passes.capabilities.storage import Bank, ModulePoints, Storage
from rpl.passes.capabilities.tasks import Background, Tasks
from rpl.passes.capabilities.texts import MessageRule, TextRule, Texts

__all__ = [
    "AS_MODULE",
    "ActionArguments",
    "Aggregate",
    "Background",
    "Bank",
    "Capabilities",
    "Composite",
    "Control",
    "Counting",
    "Data",
    "DataRule",
    "Errors",
    "Fault",
    "GroupRule",
    "InterruptRule",
    "Interrupts",
    "Io",
    "Limit",
    "Local",
    "MessageRule",
    "ModulePoints",
    "Motion",
    "MoveSetting",
    "NameRules",
    "Parameters",
    "Passing",
    "PathRule",
    "PlaceRule",
    "Places",
    "Postures",
    "PulseRule",
    "RoutineRule",
    "Routines",
    "SearchResult",
    "SettingRule",
    "Settings",
    "Storage",
    "Tasks",
    "TextRule",
    "Texts",
    "TriggerRule",
    "TurnedWay",
    "Watched",
]
