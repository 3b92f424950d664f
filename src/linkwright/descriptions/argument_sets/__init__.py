"""The search for the argument values that callers pass to a description.

The values are found in launch files, tests and build files.
"""

from linkwright.descriptions.argument_sets.calling import ArgumentSet, ArgumentSets, argument_sets
from linkwright.descriptions.argument_sets.compared import compared_values, empty_defaults, usable_defaults

__all__ = ["ArgumentSet", "ArgumentSets", "argument_sets", "compared_values", "empty_defaults", "usable_defaults"]
