"""Stands in for ``launch.frontend.expose``."""

from linkwright.launch.frontend.expose import (
    action_parse_methods,
    expose_action,
    expose_substitution,
    instantiate_action,
    instantiate_substitution,
    substitution_parse_methods,
)
from linkwright.launch.frontend.expose import (
    expose_impl as __expose_impl,
)
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = [
    "__expose_impl",
    "action_parse_methods",
    "expose_action",
    "expose_substitution",
    "instantiate_action",
    "instantiate_substitution",
    "substitution_parse_methods",
]
