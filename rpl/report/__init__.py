"""What a run looked like, for people: samples of the motion, signals over time, a page to look at.

Everything here is made from a finished run's result; nothing here has a part in running it.
"""
