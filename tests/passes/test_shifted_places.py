"""Places that a program computes of taught ones, as people of TP and INFORM write them."""

from __future__ import annotations

from there_and_back import Journey, there_and_back

SCRIPT = """def stack():
  global pallet = p[0.5, 0.15, 0.1, 0, 0, 0]
  global corner = p[0.05, 0.06, 0.07, 2.2214, 2.2214, 0]
  PITCH = 0.14
  CLEAR = 0.09
  def over(pt):
    return pose_add(p[0, 0, CLEAR, 0, 0, 0], pt)
  end
  def put(column):
    place = pose_add(p[column*PITCH, 0, 0, 0, 0, 0], corner)
    movel(pose_trans(pallet, over(place)), a=1.2, v=0.5)
    movel(pose_trans(pallet, place), a=1.2, v=0.2)
  end
  movej([0, -1.5708, -1.5708, -1.5708, 1.5708, 1.5708], a=1.4, v=1.05)
  movel(pose_trans(pallet, corner), a=1.2, v=0.2)
  put(1)
end
"""
ARM = "ur10e"


def _written(target: str) -> Journey:
    return there_and_back({"stack.script": SCRIPT}, "urscript", target, ARM)


def test_a_function_that_only_shifts_is_an_offset_in_tp() -> None:
    text = _written("tp").text
    assert "RPL_" not in text and "OVER" not in text and "SIN[" not in text
    assert 'P[2:"corner"]' in text
    assert "PR[1,1:place]=(PR[1,1:place]+AR[1]*140)" in text
    assert "Offset,PR[" in text


def test_the_robot_goes_where_it_did() -> None:
    for target in ("tp", "inform"):
        journey = _written(target)
        assert not journey.losses
        assert journey.prove("stack").verdict in ("equal", "alike")


KRL = """DEF main()
  DECL INT n
  DECL E6POS place
  place={X 400,Y 0,Z 500,A 0,B 90,C 0,S 2,T 0}
  FOR n=1 TO 3
    place.X=place.X+n*10
    place.Z=place.Z-5
    LIN place
  ENDFOR
END
"""


def test_whole_counts_are_not_rounded_in_inform() -> None:
    text = there_and_back({"main.src": KRL}, "krl", "inform", "kuka_kr10r1100sixx").text
    assert "SUB D" in text and "5000" in text
    assert " 0.5" not in text
