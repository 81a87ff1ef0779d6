"""What `make prove` reads and plants: the parts of the drive's C with their readings, and the defects."""
