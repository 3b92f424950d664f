"""Sweeps: a scenario, run over parameters and seeds, becomes a table."""

from linkwright.sweep.scenario import Normal, Uniform, scenario

__all__ = ["Normal", "Uniform", "scenario"]
