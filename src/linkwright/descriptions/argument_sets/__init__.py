"""Find the values that launch files, tests and build files of a workspace give to a description's arguments."""

from linkwright.descriptions.argument_sets.calling import ArgumentSet, ArgumentSets, argument_sets
from linkwright.descriptions.argument_sets.compared import compared_values, empty_defaults

__all__ = ["ArgumentSet", "ArgumentSets", "argument_sets", "compared_values", "empty_defaults"]
