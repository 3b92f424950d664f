"""Compare unexpanded descriptions: macros, parameters, arguments, and the elements that no robot shows."""

from linkwright.review.parts.comparing import compare_parts
from linkwright.review.parts.expanded import expanded_places

__all__ = ["compare_parts", "expanded_places"]
