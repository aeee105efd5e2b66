"""ABB controllers over Robot Web Services: 1.0 of IRC5 (RobotWare 6) and 2.0 of OmniCore (RobotWare 7).

Programs travel as files of the controller's file service ($HOME) and are then loaded into a task, which needs the
mastership of RAPID and a program that does not run. Sources: ABB, Application Manual Robot Web Services,
3HAC050973-001 revisions K to M (the pages of the developer center), for 1.0; what other people's working clients do
(abb-robot-client 0.4.0, rwsuis 0.2, abb_librws, rwswrap 0.1.0) and notes on controllers that were tried, for 2.0.
Nothing here was tried on iron.

Data of RAPID is Latin-1 in `.mod` of RobotWare 6 and UTF-8 in `.modx` of RobotWare 7 (general knowledge, to be checked
on a controller): the profile's `encoding` decides, and nothing is written in another one.
"""

from rpl.controllers.rules import SendingRules
from rpl.controllers.vendors import Vendor

# What RobotWare itself brings or what makes a controller that one: its configuration (SYSPAR, also of signals and of
# safety), its own modules (BASE, user is the integrator's), licences, and everything of a backup beside RAPID. Names as
# in the backups of ABB controllers; the folders of the file service are in no list of ABB.
DENIED = (
    "*.cfg",
    "*.sxml",
    "base.sys",
    "base.sysx",
    "base_shared.sys",
    "*.kxt",
    "*.rlf",
    "*.pf",
    "syspar/*",
    "*/syspar/*",
    "backinfo/*",
    "*/backinfo/*",
    "cs/*",
    "*/cs/*",
    "*safety*",
)

VENDOR = Vendor(
    package=__name__,
    title="ABB (Robot Web Services)",
    ports={"rws": 80, "rws2": 443, "egm": 6510},
    path="$HOME",
    rules=SendingRules(
        programs=("*.mod", "*.modx", "*.sys", "*.sysx", "*.pgf"),
        denied=DENIED,
        name=r"[A-Za-z][A-Za-z0-9_]{0,31}",
        names="a letter, then at most 31 letters, digits and _",
        encoding="latin-1",
    ),
    dialect="rapid",
    needs="rws",
    options={
        "generation": "1 (IRC5) or 2 (OmniCore) of Robot Web Services; found out when it is not said",
        "certificate": "SHA256:... of the certificate of its web server (2.0); else the first one that is seen is kept",
    },
)
