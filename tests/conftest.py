"""Generated tests draw the same examples every time and are not timed: a change is judged by what it changes."""

from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")
