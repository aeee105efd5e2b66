"""A folder that is carried to the controller, or a share of it that this machine has: `folder:///mnt/robot`."""

from rpl.controllers.rules import SendingRules, known_programs
from rpl.controllers.vendors import Vendor

VENDOR = Vendor(
    package=__name__,
    title="a folder (transfer folder, mounted share, USB stick)",
    ports={},
    path="",
    rules=SendingRules(programs=known_programs()),
)
