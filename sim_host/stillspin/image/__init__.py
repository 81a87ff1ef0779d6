"""Images on the virtual board, looked into: stopped, traced, interrupted on purpose, debugged."""
