"""The macro language xacro, as ros/xacro 2.1 understands it, with positions and without its holes."""

from linkwright.xacro.engine import Expansion, expand
from linkwright.xacro.limits import Limits
from linkwright.xacro.origin import Origin

__all__ = ["Expansion", "Limits", "Origin", "expand"]
