"""What a project holds: programs and who calls whom, what is missing, what nobody uses, signals, points, frames, tools.

`contents.py` asks the read program once; `robots.py` says which arm its files name; `shown.py` and `page.py` put both
before people, as a tree and as a page with the graph of calls.
"""
