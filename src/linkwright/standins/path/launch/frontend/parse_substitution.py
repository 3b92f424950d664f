"""Stands in for ``launch.frontend.parse_substitution``."""

from linkwright.launch.frontend.grammar import parse_if_substitutions, parse_substitution, replace_escaped_characters
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["parse_if_substitutions", "parse_substitution", "replace_escaped_characters"]
