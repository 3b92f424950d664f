"""Nodes and viewers that run in the launcher's process.

The package starts and ends them, and contains their log, signal handling, and live reload of robot descriptions.
"""
