"""Files by SFTP, the file way of SSH: `sftp://10.0.0.5/programs`. Of the controller behind it nothing is known."""

from rpl.controllers.rules import SendingRules
from rpl.controllers.vendors import Vendor

VENDOR = Vendor(
    package=__name__,
    title="files by SFTP",
    ports={"sftp": 22},
    path="/",
    rules=SendingRules(programs=("*",)),
    needs="ssh",
    options={"host_key": "fingerprint of the controller's SSH key, SHA256:..."},
)
