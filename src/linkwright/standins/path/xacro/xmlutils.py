"""Stands in for ``xacro.xmlutils``."""

from linkwright.standins.xacro_api.nodes import (
    attribute,
    first_child_element,
    next_sibling_element,
    opt_attrs,
    replace_node,
    reqd_attrs,
)

__all__ = ["attribute", "first_child_element", "next_sibling_element", "opt_attrs", "replace_node", "reqd_attrs"]
