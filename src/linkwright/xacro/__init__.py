"""The xacro language of ros/xacro 2.1, with source positions and sandboxed expressions."""

from linkwright.loading.deferred import deferred
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.xacro.expansion import Expansion, expand
    from linkwright.xacro.faults import Origin
    from linkwright.xacro.inspection import arguments_of, explain
    from linkwright.xacro.limits import Limits

__all__ = ["Expansion", "Limits", "Origin", "arguments_of", "expand", "explain"]

__getattr__ = deferred(
    __name__,
    {
        "expansion": ("Expansion", "expand"),
        "faults": ("Origin",),
        "inspection": ("arguments_of", "explain"),
        "limits": ("Limits",),
    },
)
"""The engine is loaded when a file is expanded: a check of a plain URDF needs only origins and the file cache."""
