"""Which values the launch files, tests and build files of a workspace give to the arguments of a description."""

from linkwright.descriptions.argument_sets.calling import ArgumentSet, ArgumentSets, argument_sets
from linkwright.descriptions.argument_sets.compared import compared_values, empty_defaults

__all__ = ["ArgumentSet", "ArgumentSets", "argument_sets", "compared_values", "empty_defaults"]
