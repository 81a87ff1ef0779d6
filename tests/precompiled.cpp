// A precompiled header belongs to a program; this one has no tests.
