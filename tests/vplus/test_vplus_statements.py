"""V+ steps: what each becomes, shown as RPL."""

from __future__ import annotations

import pytest
from vplus_helpers import as_rpl, program_of, read

MORE = ".PROGRAM p(a, b)\nx = a+b\n.END\n.PROGRAM alarm()\n.END"

MOTION: list[tuple[str, list[str]]] = [
    ("MOVE place", ["MOVE TO place BLEND AT SPEED 100"]),
    (
        "MOVES place:TRANS(0,0,10)",
        ["MOVE LINEAR TO place : pose {x: 0, y: 0, z: 10, a: 0, b: 0, c: 0} BLEND AT SPEED 100"],
    ),
    ("MOVE #place", ["MOVE TO `#place` BLEND AT SPEED 100"]),
    ("MOVE #PPOINT(10,20,30,40)", ["MOVE TO joints {j1: 10, j2: 20, j3: 30, j4: 40, j5: 0, j6: 0} BLEND AT SPEED 100"]),
    ("MOVE TRANS(400,0,300,0,180,0)", ["MOVE TO pose {x: 400, y: 0, z: 300, a: 180, b: 0, c: 180} BLEND AT SPEED 100"]),
    ("APPRO place, 50", ["MOVE TO tool_offset(place, 0, 0, -50) BLEND AT SPEED 100"]),
    ("APPROS place, -dist", ["MOVE LINEAR TO tool_offset(place, 0, 0, dist) BLEND AT SPEED 100"]),
    ("DEPART 50", ["MOVE BY pose {x: 0, y: 0, z: -50, a: 0, b: 0, c: 0} IN TOOL BLEND AT SPEED 100"]),
    ("DEPARTS dist", ["MOVE LINEAR BY pose {x: 0, y: 0, z: -dist, a: 0, b: 0, c: 0} IN TOOL BLEND AT SPEED 100"]),
    (
        "MOVET place, 5",
        [
            "TRIGGER AT start DO SET do[3002] TO OFF",
            "TRIGGER AT start DO SET do[3001] TO ON",
            "MOVE TO place BLEND AT SPEED 100",
        ],
    ),
    (
        "MOVEST place, 0",
        [
            "TRIGGER AT start DO SET do[3001] TO OFF",
            "TRIGGER AT start DO SET do[3002] TO ON",
            "MOVE LINEAR TO place BLEND AT SPEED 100",
        ],
    ),
    (
        "MOVEF place, 30, 40",
        [
            "MOVE BY pose {x: 0, y: 0, z: -30, a: 0, b: 0, c: 0} IN TOOL BLEND AT SPEED 100",
            "MOVE TO tool_offset(place, 0, 0, -40) BLEND AT SPEED 100",
            "MOVE TO place BLEND AT SPEED 100",
        ],
    ),
    ("MOVEC via, place", ["MOVE CIRCULAR VIA via TO place BLEND AT SPEED 100"]),
    (
        "DRIVE 3, -10.5, 50",
        ["MOVE BY joints {j1: 0, j2: 0, j3: -10.5, j4: 0, j5: 0, j6: 0} IN JOINTS JOINT SPEED 50 BLEND AT SPEED 100"],
    ),
    ("READY", ["MOVE TO $home_joints BLEND AT SPEED 100"]),
    ("ALIGN", ["MOVE TO aligned(pose_of($end_pose)) BLEND AT SPEED 100"]),
    ("DELAY 0.5", ["WAIT 0.5 AT REST"]),
    ("BREAK", ["WAIT FOR MOTION"]),
    ("BRAKE", ["STOP MOTION", "CLEAR MOTION"]),
    ("OPEN", ["TRIGGER AT start DO SET do[3002] TO OFF", "TRIGGER AT start DO SET do[3001] TO ON"]),
    ("CLOSEI", ["WAIT FOR MOTION", "SET do[3001] TO OFF", "SET do[3002] TO ON", "WAIT 0.05"]),
    ("RELAX", ["TRIGGER AT start DO SET do[3001] TO OFF", "TRIGGER AT start DO SET do[3002] TO OFF"]),
    ("MOVES %belt:place", ['VENDOR vplus "MOVES %belt:place" EFFECT unknown']),
]

LOCATIONS: list[tuple[str, list[str]]] = [
    ("HERE place", ["place = pose_of(current_target())"]),
    ("HERE #place", ["`#place` = current_joints()"]),
    ("HERE board:place", ["place = inverse(board) : pose_of(current_target())"]),
    ("SET place = board:INVERSE(tool.t):NULL", ["place = board : inverse(`tool.t`) : $null_frame"]),
    ("SET place = SHIFT(board BY 10, , -5)", ["place = offset(board, 10, 0, -5)"]),
    (
        "SET place = RZ(30):RX(a)",
        ["place = pose {x: 0, y: 0, z: 0, a: 30, b: 0, c: 0} : pose {x: 0, y: 0, z: 0, a: 0, b: 0, c: a}"],
    ),
    ("SET place = HERE", ["place = pose_of(current_target())"]),
    ("SET place = DEST", ["place = pose_of($end_pose)"]),
    ("SET #there = #PDEST", ["`#there` = target_to_joints(pose_of($end_pose))"]),
    (
        "SET place = FRAME(a, b, c, d)",
        ["place = offset(frame_from_points(a.trans, b.trans, c.trans), d.x - a.x, d.y - a.y, d.z - a.z)"],
    ),
    ("SET board:place = HERE", ["place = inverse(board) : pose_of(current_target())"]),
    (
        "SET place = TRANS(x, y, 0, 10, 20, 30)",
        ["place = pose {x: x, y: y, z: 0, a: 41.566703966, b: 17.229396563, c: 10.314104816}"],
    ),
    ("SET place = TRANS(x, y, 0, q, 20, 30)", ["place = pose_zyz(x, y, 0, q, 20, 30)"]),
]

SETTINGS: list[tuple[str, list[str]]] = [
    ("SPEED 50 ALWAYS", ["$joint_speed = 50", "$path_speed = 500", "$swivel_speed = 90"]),
    (
        "SPEED 50, 25",
        ["FOR NEXT MOVE $joint_speed = 50", "FOR NEXT MOVE $path_speed = 500", "FOR NEXT MOVE $swivel_speed = 45"],
    ),
    ("SPEED 200 MMPS ALWAYS", ["$joint_speed = 20", "$path_speed = 200"]),
    ("SPEED 4 IPS", ["FOR NEXT MOVE $joint_speed = 10.16", "FOR NEXT MOVE $path_speed = 101.6"]),
    ("SPEED 80 MONITOR", ["$override = 80"]),
    ("SPEED fast ALWAYS", ["$joint_speed = fast", "$path_speed = fast * 10.0", "$swivel_speed = fast * 1.8"]),
    ("ACCEL 50, 80", ["$acceleration_percent = 50", "$deceleration_percent = 80"]),
    ("DURATION 2 ALWAYS", ["$move_duration = 2"]),
    ("DURATION 1.5", ["FOR NEXT MOVE $move_duration = 1.5"]),
    ("CPOFF", ["FOR NEXT MOVE $blending = FALSE"]),
    ("CPON ALWAYS", ["$blending = TRUE"]),
    ("FINE 50", ["FOR NEXT MOVE $end_tolerance = 50"]),
    ("COARSE 200 ALWAYS", ["$end_tolerance = 2000"]),
    ("NONULL ALWAYS", ['VENDOR vplus "NONULL ALWAYS" EFFECT tuning']),
    ("LEFTY", ["FOR NEXT MOVE $posture_shoulder = #back"]),
    ("RIGHTY", ["FOR NEXT MOVE $posture_shoulder = #front"]),
    ("ABOVE", ["FOR NEXT MOVE $posture_elbow = #up"]),
    ("BELOW", ["FOR NEXT MOVE $posture_elbow = #down"]),
    ("FLIP", ["FOR NEXT MOVE $posture_wrist = #flip"]),
    ("NOFLIP", ["FOR NEXT MOVE $posture_wrist = #noflip"]),
    ("TOOL TRANS(0,0,100)", ["WAIT FOR MOTION", "$tool = pose {x: 0, y: 0, z: 100, a: 0, b: 0, c: 0}"]),
    ("TOOL", ["WAIT FOR MOTION", "$tool = $null_frame"]),
    ("BASE 0,0,0,0", ["WAIT FOR MOTION", "$base = pose {x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}"]),
    ("BASE 10, 20, 30, 90", ["WAIT FOR MOTION", "$base = pose {x: -20, y: 10, z: -30, a: -90, b: 0, c: 0}"]),
    ("BASE board", ["WAIT FOR MOTION", "$base = inverse(board)"]),
    ("ENABLE POWER", ['VENDOR vplus "ENABLE POWER" EFFECT tuning']),
    ("DISABLE CP", ["$blending = FALSE"]),
    ("PARAMETER HAND.TIME = 3", ['VENDOR vplus "PARAMETER HAND.TIME = 3" EFFECT tuning']),
]

SIGNALS: list[tuple[str, list[str]]] = [
    ("SIGNAL 1, -2, 2003", ["SET do[1] TO ON", "SET do[2] TO OFF", "SET flag[3] TO ON"]),
    ("SIGNAL -3001", ["SET do[3001] TO OFF"]),
    ("n = SIG(1001)", ["n = di[1]"]),
    ("IF SIG(1001, -1002) THEN\nEND", ["IF di[1] AND NOT di[2] THEN", "END IF"]),
    ("BITS 33, 4 = n", ["SET go[33 TO 36] TO n"]),
    ("n = BITS(1001, 8)", ["n = gi[1 TO 8]"]),
    ("AIO.OUT 1 = 5", ["SET ao[1] TO 5"]),
    ("n = AIO.IN(2)", ["n = ai[2]"]),
    ("TIMER 1 = 0", ["$timer[1] = 0", "$timer_stopped[1] = FALSE"]),
    ("n = TIMER(1)", ["n = $timer[1]"]),
    ("WAIT", ["WAIT 0.016"]),
    ("WAIT SIG(1001)", ["WAIT UNTIL di[1]"]),
    ("WAIT n > 3", ["WAIT UNTIL n > 3"]),
    ("WAIT.EVENT , 0.1", ["WAIT 0.1"]),
    (
        "REACT 1001, alarm, 10",
        ["DECLARE INTERRUPT 118 EVERYWHERE ONCE NAMED 1001 WHEN di[1] DO alarm()", "INTERRUPT ON 1001"],
    ),
    (
        "REACTI -1002, alarm()",
        [
            "DECLARE INTERRUPT 127 EVERYWHERE ONCE BRAKING NAMED (-1002) WHEN NOT di[2] DO alarm()",
            "INTERRUPT ON (-1002)",
        ],
    ),
    ("REACTE alarm", ["TRAP ERRORS WITH alarm"]),
    ("REACTE", ["TRAP ERRORS OFF"]),
    ("IGNORE 1001", ["INTERRUPT DELETE 1001"]),
    ("LOCK 20", ["INTERRUPT MASK 108"]),
    ("LOCK", ["INTERRUPT MASK 128"]),
    (
        "DECOMPOSE p.v[1] = place",
        [
            "`p.v`[1] = place.x",
            "`p.v`[2] = place.y",
            "`p.v`[3] = place.z",
            "`p.v`[4] = zyz_yaw(place)",
            "`p.v`[5] = zyz_pitch(place)",
            "`p.v`[6] = zyz_roll(place)",
        ],
    ),
    (
        "DECOMPOSE p.v[3] = #place",
        [
            "`p.v`[3] = `#place`.j1",
            "`p.v`[4] = `#place`.j2",
            "`p.v`[5] = `#place`.j3",
            "`p.v`[6] = `#place`.j4",
            "`p.v`[7] = `#place`.j5",
            "`p.v`[8] = `#place`.j6",
        ],
    ),
]

CONTROL: list[tuple[str, list[str]]] = [
    ("CALL p(1, n)", ["p(1, n)"]),
    ("CALL p((n), )", ["p(+n)"]),
    ("CALLS $t", ["CALL BY `$t`"]),
    ("CALLS $t(n)", ["CALL BY `$t` PASSING (n)"]),
    ('CALLS "job."+$CHR(65)', ['CALL BY "job." & from_code(65)']),
    ("CALLS $jobs[2]", ["CALL BY `$jobs`[2]"]),
    ("CALLS $jobs[2](n, 1)", ["CALL BY `$jobs`[2] PASSING (n, 1)"]),
    ('CALLS "job"(n)', ['CALL BY "job" PASSING (n)']),
    ("EXECUTE 3 alarm()", ["START TASK alarm"]),
    ("EXECUTE 3 alarm\nABORT 3", ["START TASK alarm", "STOP TASK alarm"]),
    (
        "EXECUTE 3 alarm\nABORT 3\nEXECUTE 3 watch",
        ["START TASK alarm", "STOP TASK alarm", "STOP TASK watch", "START TASK watch"],
    ),
    ("RETURN", ["RETURN"]),
    ("RETURNE", ["TRY NEXT"]),
    ("STOP", ["HALT EXIT"]),
    ("HALT", ["HALT EXIT"]),
    ("PAUSE", ["HALT"]),
    ("GOTO 10\n10 n = 1", ["GOTO `10`", "LABEL `10`", "n = 1"]),
    ("IF n == 1 GOTO 10\n  10", ["IF n = 1 THEN", "GOTO `10`", "END IF", "LABEL `10`"]),
]

TALKING: list[tuple[str, list[str]]] = [
    ('TYPE "a", n, $t', ['MESSAGE "a" & format("% .8g", n) & `$t` KIND write']),
    ("TYPE /C1, /F6.2, n, /X3, n, /S", ['MESSAGE "\\n" & format("%6.2f", n) & "   " & format("%6.2f", n) KIND write']),
    ("TYPE", ['MESSAGE "" KIND write']),
    ("$t = $ENCODE(/I4, n)", ['`$t` = format("%4d", n)']),
    ('PROMPT "How many? ", n', ['ASK "How many? " INTO n KIND number']),
    ('PROMPT "Name? ", $t', ['ASK "Name? " INTO `$t` KIND text']),
    ('PROMPT "ready"', ['MESSAGE "ready" KIND write']),
    ("ATTACH", ['VENDOR vplus "ATTACH" EFFECT tuning']),
    ('ATTACH (lun, 4) "TCP"', ['VENDOR vplus "ATTACH (lun, 4) \\"TCP\\"" EFFECT unknown']),
    ("SELECT ROBOT = 1", ['VENDOR vplus "SELECT ROBOT = 1" EFFECT tuning']),
    ("FCLOSE (lun)", ['VENDOR vplus "FCLOSE (lun)" EFFECT none']),
    ("WRITE (lun) $t, /S", ['VENDOR vplus "WRITE (lun) $t, /S" EFFECT `message`']),
    ('WRITE (4) "x=", n', ['MESSAGE "x=" & format("% .8g", n) KIND write']),
]


@pytest.mark.parametrize(("text", "wanted"), [*MOTION, *LOCATIONS, *SETTINGS, *SIGNALS, *CONTROL, *TALKING])
def test_steps(text: str, wanted: list[str]) -> None:
    program, diagnostics = read(program_of(text, MORE))
    assert not diagnostics.has_errors
    assert as_rpl(program) == wanted
