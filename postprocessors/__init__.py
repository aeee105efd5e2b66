"""One folder per target: how it is written and what its controller can say."""
