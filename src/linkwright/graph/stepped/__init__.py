"""Nodes whose callbacks run between steps of a simulation or control loop, in its thread."""
