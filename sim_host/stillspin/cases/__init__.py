"""What can be run: motors, profiles, scenarios, and ways to run them otherwise."""
