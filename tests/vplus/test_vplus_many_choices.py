"""What follows a corner is found in time that grows with the program, however many choices stand behind it."""

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

CHOICES = "".join(f"    IF n > {number} THEN\n        n = n + 1\n    END IF\n" for number in range(60))
PROGRAM = f"""VAR n: INT = 0
PROCEDURE main()
    MOVE JOINT TO joints {{j1: 0, j2: -80, j3: 100, j4: 0, j5: 60, j6: 0}}
    MOVE LINEAR BY {{z: 50}} BLEND 10 mm
{CHOICES}    SET do[1] TO ON
    MOVE LINEAR BY {{x: 50}}
END PROCEDURE
"""


def test_sixty_choices_behind_a_corner() -> None:
    read = read_sources([source_from_text("main.rpl", PROGRAM)], "rpl", Diagnostics())
    written = translate_program(read, "vplus", "kuka_kr6r900sixx", None, Diagnostics())
    steps = [line.strip() for line in written.files[0].data.decode().splitlines()]
    assert steps[steps.index("SIGNAL 1") - 1] == "BREAK"
