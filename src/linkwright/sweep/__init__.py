"""Run a scenario with several parameter values and seeds, and tabulate the results."""

from linkwright.sweep.scenario import Normal, Uniform, scenario

__all__ = ["Normal", "Uniform", "scenario"]
