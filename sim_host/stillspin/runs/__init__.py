"""Running it: one run, campaigns on many processes, commissioning, the start-up matrix."""
