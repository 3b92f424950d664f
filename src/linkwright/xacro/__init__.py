"""The macro language xacro, as ros/xacro 2.1 understands it, with positions and without its holes."""

from linkwright.xacro.engine import Expansion, expand
from linkwright.xacro.limits import Limits
from linkwright.xacro.origin import Origin
from linkwright.xacro.questions import arguments_of, explain

__all__ = ["Expansion", "Limits", "Origin", "arguments_of", "expand", "explain"]
