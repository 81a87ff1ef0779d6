"""The type test of a motor: what its drive does from the first start to the top speed, judged on the true shaft."""
