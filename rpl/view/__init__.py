"""Seeing a cell: one page that plays a run from disk, pictures of a moment, and the interactive screen in a browser.

All three draw the same bodies (`rpl.view.bodies`) at the poses that a run gives them (`rpl.view.scene`).
"""
