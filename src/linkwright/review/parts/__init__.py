"""Compare unexpanded descriptions, including the elements that no robot shows."""

from linkwright.review.parts.comparing import compare_parts
from linkwright.review.parts.expanded import find_expanded_elements

__all__ = ["compare_parts", "find_expanded_elements"]
