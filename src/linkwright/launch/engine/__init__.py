"""The engine that runs a launch description.

It has the session, processes, in-process nodes, signals and live reload.
"""
