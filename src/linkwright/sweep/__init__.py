"""Sweeps: run a scenario over parameters and seeds, and collect the results in a table."""

from linkwright.sweep.scenario import Normal, Uniform, scenario

__all__ = ["Normal", "Uniform", "scenario"]
