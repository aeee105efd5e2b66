"""A controller's tool 1 for tests that are about something else: the flange itself."""

from rpl.source import Source, source_from_text

SYSFRAME = """[*SYSTEM*]$MNUTOOL  Storage: SHADOW  Access: RW  : ARRAY[1,10] OF POSITION
     [1,1] =
  Group: 1   Config: N D B, 0, 0, 0
  X:     0.000   Y:     0.000   Z:     0.000
  W:     0.000   P:     0.000   R:     0.000
"""


def tool_one() -> Source:
    """Its dump, to be read with the listings."""
    return source_from_text("SYSFRAME.VA", SYSFRAME)
