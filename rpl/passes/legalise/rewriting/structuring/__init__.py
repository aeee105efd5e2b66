"""Jumps as loops and branches: the flow graph of a body, its regions, and the body that is written from them."""
