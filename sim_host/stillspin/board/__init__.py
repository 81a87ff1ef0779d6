"""The virtual board as a process: its plugs are pseudo-terminals, its time is the clock on the wall."""
