"""The longest path through a linked Thumb-2 program, in instructions."""
