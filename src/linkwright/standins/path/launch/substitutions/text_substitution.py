"""Stands in for ``launch.substitutions.text_substitution``."""

from linkwright.launch.substitution import TextSubstitution

__all__ = ["TextSubstitution"]
