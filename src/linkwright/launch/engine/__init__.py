"""Running a launch description: the session, its processes, the nodes of this process, signals, live reload."""
