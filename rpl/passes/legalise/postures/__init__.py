"""Which way the arm reaches a place: flags, turns, joints, other arms. Behind it each place says its posture as the
target does.
"""
