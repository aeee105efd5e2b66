"""Which way the arm reaches a place: flags, turns, joints, other arms."""
