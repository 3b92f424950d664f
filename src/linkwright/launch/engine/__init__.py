"""What runs a launch description: the session, processes, nodes of this process, the log, live reload."""
