"""One folder per language: what its statements mean."""
