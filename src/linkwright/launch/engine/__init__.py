"""The engine that runs a launch description.

The engine consists of the session, processes, nodes in the launcher's process, signals and live reload.
"""
