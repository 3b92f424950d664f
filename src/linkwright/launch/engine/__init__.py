"""The engine that runs a launch description.

The engine consists of the session, processes, in-process nodes, signals and live reload.
"""
