"""A plant's archive: every project in a folder is checked, run or translated, each in a process that may be lost.

`finding` says what the projects are, `work` what is done with one, `processes` and `cluster` who does it, `journal`
what is done already, and `tables` how the rows are kept.
"""
