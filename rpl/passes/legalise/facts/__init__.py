"""What is known of a program. Nothing is rewritten here. Which file answers which question:

- What holds in front of each statement, on every way there? A subclass of `forward` (the one walk over branches, loops,
  labels, calls, handlers) that says what a statement changes; backward, what is wanted later: `liveness`.
- What is set where, the same on every way? A subclass of `inforce` that says what counts as a value. Settings as the
  program says them: `settingsinforce`. Tool and frame as poses: `framesinforce`. Variables: `values.heldvalues`.
- Which numbers of the target does data say for itself? `saidnumbers`.
- Which moves does a written target serve, and in which frames? `targetuses`.
- What do variables and places hold? The folder `values`.
- Where is the robot, and how does it move? The folder `motion`.
- Who changes and reads what? `usage`, `effects`, `mentioned`; beside the program: `runbeside`. Where it begins and
  what calls what: `entries`, `activations`. While an interrupt is armed: `reach`; errors that get out: `raising`.
"""
