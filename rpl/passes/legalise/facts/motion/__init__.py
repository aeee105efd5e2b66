"""Where the robot is and how it moves.

Before each move: `whereabouts`. Does it stand, or is it at a corner: `cornerways`; how large corners are:
`cornersizes`. Which move follows which: `moveorder`; how far apart they are: `ways`. How far the program runs ahead:
`advance`. What moves are accelerated with: `saidaccelerations`. Axes beside the arm: `externalaxes`; motor pulses:
`pulsecounts`.
"""
