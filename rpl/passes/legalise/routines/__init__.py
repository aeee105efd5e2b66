"""Calls, parameters, results, recursion. Behind it routines take and give what the target's take and give."""
