"""The page in the browser: a server on the loopback that lets nobody else in, and what it does with the drive."""
