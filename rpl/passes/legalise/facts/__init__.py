"""What is known of a program. Nothing is rewritten here. Which file answers which question:

- What holds in front of each statement, on every way there? A subclass of `forward` (the one walk over branches, loops,
  labels, calls, handlers) that says what a statement changes; backward, what is wanted later: `liveness`.
- What is set where, the same on every way? A subclass of `inforce` that says what counts as a value. Settings as the
  program says them: `settingsinforce`. Tool and frame as poses: `framesinforce`. Variables: `heldvalues`.
- Which moves does a written target serve, and in which frames? `targetuses`.
- What does a variable hold over the whole program? Texts `heldtexts`, whole numbers `wholes`, bounds of subscripts
  `intervals`, set once at the start `beginning` (asked by `rewriting.walk.unchanged_in`). Places made in the lines in
  front: `straightplaces`; read before it is set: `firstreads`; worked out of taught data: `taughtvalues`; numbers of
  tools and frames in a controller's tables: `framenumbers`.
- Where is the robot? Before each move: `whereabouts`. Does it stand, or is it at a corner: `cornerways`. Which move
  follows which: `moveorder`; how far apart: `ways`.
- Who changes and reads what? `usage`, `effects`, `mentioned`; beside the program: `runbeside`. Where it begins and
  what calls what: `entries`, `activations`. While an interrupt is armed: `reach`; errors that get out: `raising`.
"""
