"""Mutants of the drive's C: what is changed, and how it is compiled and run."""
