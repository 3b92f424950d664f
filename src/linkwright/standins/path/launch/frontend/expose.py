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

__all__ = [
    "__expose_impl",
    "action_parse_methods",
    "expose_action",
    "expose_substitution",
    "instantiate_action",
    "instantiate_substitution",
    "substitution_parse_methods",
]
