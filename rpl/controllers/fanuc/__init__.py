"""FANUC controllers (R-30iA and later): programs by FTP on the device `MD:`, values by SNPX.

Where facts are from. Other people's clients against throwaway servers (fanuc-ucl, fanucpy: SNPX, RMI, Stream
Motion). Public projects that read controllers in use: a monitor of an R-30iA Mate (CURPOS.DG, SFTYSIG.DG by
anonymous FTP; of the signals only TP Enable and TP Deadman were checked by pressing them, the latter names the
released state), editors and backup tools (PRGSTATE.DG, ERRALL.LS), CrossArm (ROBOGUIDE: STOR of a listing loads
it, a refusal is a 550 whose reason stands in ERRALL.LS, a program in use is refused, DELE takes the name with
.TP). M marks what is from general knowledge and was checked nowhere: the option that loads listings (R796),
which names are no programs, the wording of refusals. Nobody has tried this client against a controller.
"""

from rpl.controllers.fanuc.listing import same_program
from rpl.controllers.rules import SendingRules
from rpl.controllers.vendors import Vendor

# Listings that are logs of the controller (public backups have them), no programs.
LOGS = (
    *("errall.ls", "erract.ls", "errapp.ls", "errcomm.ls", "errcurr.ls", "errext.ls", "errhist.ls", "errmotn.ls"),
    *("errnon.ls", "errpwd.ls", "errsys.ls", "hist.ls", "histe.ls", "histp.ls", "histr.ls", "hists.ls"),
    *("logbook.ls", "updtlog.ls"),
)

RULES = SendingRules(
    # The binary .TP of a program beside its .LS would bring back what was there before: only one of them travels.
    programs=("*.ls", "*.pc"),
    denied=("*.sv", "*.io", "*.img", *LOGS),
    # M: 36 characters since R-30iB, 8 before; no digit first.
    name=r"[A-Za-z_][A-Za-z0-9_]{0,35}",
    names="a letter first, then letters, digits and _, 36 in all",
    flat=True,
    encoding="latin-1",
    line_ends="crlf",
    same=same_program,
)

VENDOR = Vendor(
    package=__name__,
    title="FANUC",
    ports={"ftp": 21, "snpx": 60008, "rmi": 16001, "rmi-session": 16002, "streammotion": 60015, "mappdk": 18735},
    path="md:",
    rules=RULES,
    dialect="tp",
)
