"""Generated tests draw the same examples every time: a change is judged by what it changes, not by luck."""

from hypothesis import settings

settings.register_profile("repeatable", derandomize=True)
settings.load_profile("repeatable")
