"""Controllers of KUKA: `kuka://10.0.0.5`, files by C3 Bridge Interface, variables by it or by KukavarProxy.

Both are programs of others that somebody has installed on the controller; KukavarProxy knows variables alone. Or a
folder of this machine stands for the share that the controller has (`transfer`), and people copy from there at the
pendant: the controller keeps its list of programs in memory, and what comes to its disk by the network is not
selectable before that (known from RoboDK's and others' pages).

What is known, and from where: messages from "C3 Bridge Interface, Application Protocol Specification" revision 1.5 and
the sources of C3 Bridge (both BSD); where they differ (the length of the name in #30 has 2 bytes in the sources, 4 in
the specification) the sources count. How the controller spells paths and lists is not said there: `KRC:\\R1\\Program`
is of the specification's example for #27. System variables are those of the manual "System Variables" for KSS 8.1 to
8.4; what their values mean, and the encoding (Windows-1252, CR LF), is general knowledge. Nobody has tried this on a
controller of iron; the client py-openshowvar passes against the virtual one.
"""

from rpl.controllers.rules import SendingRules
from rpl.controllers.vendors import Vendor

# General knowledge: machine data, the system's own modules, what starts with the submit interpreter, safety.
_DENIED = ("$*.dat", "*.ini", "*.xml", "*.sdb", "*.zip", "sps.sub", "ir_stopm.src", "bas.src", "h50.src", "vw*.src")
_DENIED_FOLDERS = ("system", "mada", "tp", "steu")

VENDOR = Vendor(
    package=__name__,
    title="KUKA (C3 Bridge Interface, KukavarProxy)",
    ports={"c3": 7000},
    path="/KRC:/R1/Program",
    rules=SendingRules(
        programs=("*.src", "*.dat", "*.sub"),
        denied=(*_DENIED, *(f"{name}/*" for name in _DENIED_FOLDERS), *(f"*/{name}/*" for name in _DENIED_FOLDERS)),
        pairs={".dat": ".src"},
        name=r"[A-Za-z_][A-Za-z0-9_]{0,23}",
        names="a letter, then up to 23 letters, digits and _",
        encoding="cp1252",
        line_ends="crlf",
    ),
    dialect="krl",
    options={"transfer": "a folder of this machine that stands for the controller's share, in place of C3 Bridge"},
)
