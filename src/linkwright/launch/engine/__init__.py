"""The engine that runs a launch description: session, processes, nodes of this process, signals, live reload."""
