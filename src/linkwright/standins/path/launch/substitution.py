"""Stands in for ``launch.substitution``."""

from linkwright.launch.substitution import Substitution

__all__ = ["Substitution"]
