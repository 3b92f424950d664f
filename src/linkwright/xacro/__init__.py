"""The macro language xacro, as ros/xacro 2.1 understands it, with positions and without its holes."""

from linkwright.xacro.engine import expand
from linkwright.xacro.expansion import Expansion
from linkwright.xacro.inspection import arguments_of, explain
from linkwright.xacro.limits import Limits
from linkwright.xacro.origin import Origin

__all__ = ["Expansion", "Limits", "Origin", "arguments_of", "expand", "explain"]
