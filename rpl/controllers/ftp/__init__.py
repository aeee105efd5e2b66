"""Any controller that has an FTP server and no more: `ftp://HOST:PORT/FOLDER`. Makers whose controllers carry files by
FTP build on the client and the server of this folder.

Tested against our own server (pyftpdlib below it) and pyftpdlib's own; nobody has tried it against a controller.
"""

from rpl.controllers.rules import SendingRules
from rpl.controllers.vendors import Vendor

VENDOR = Vendor(
    package=__name__,
    title="a controller with an FTP server",
    ports={"ftp": 21},
    path="",
    rules=SendingRules(programs=("*",)),
    options={"tls": "yes: the control and data connections are encrypted (AUTH TLS), the certificate is checked"},
)
