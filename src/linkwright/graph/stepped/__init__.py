"""Nodes whose callbacks run between the steps of a simulation or control loop, on its thread."""
