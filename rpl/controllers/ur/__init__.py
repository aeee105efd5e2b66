"""Universal Robots, controllers CB3 and e-Series (PolyScope 3 and 5): `ur://10.0.0.5`.

Programs travel by SFTP below /programs; the dashboard and RTDE are only asked. Text pushed to 30001, 30002 or 30003
would be run at once: no part of the client can do that. PolyScope X has neither dashboard nor this file system.

Where the facts are from: the dashboard's words from Universal Robots' article "Dashboard Server e-Series" (15690) and
from what ur-rtde 1.6.5 compares; RTDE from "Real-Time Data Exchange (RTDE) Guide" (22229) and Universal Robots' own
client library; the packets of 30001-30003 from "Remote Control via TCP/IP" (16496) and the headers of the client
library. Nothing was tried on a real controller.
"""

from rpl.controllers.rules import SendingRules
from rpl.controllers.vendors import Vendor

VENDOR = Vendor(
    package=__name__,
    title="Universal Robots CB3 and e-Series",
    ports={
        "sftp": 22,
        "dashboard": 29999,
        "rtde": 30004,
        "primary": 30001,
        "secondary": 30002,
        "realtime": 30003,
        "interpreter": 30020,
    },
    path="/programs",
    rules=SendingRules(
        programs=("*.script", "*.urp", "*.txt"),
        denied=("*.installation", "*.variables", "*.conf", "*.urcap", "*.jar", "*.sh", "*safety*"),
        name=r"[^/\\\x00-\x1f]{1,120}",
        names="up to 120 characters without / and \\",
        binary=("*.urp",),
    ),
    dialect="urscript",
    needs="ssh",
    options={"host_key": "fingerprint of the controller's SSH key, SHA256:..."},
)
