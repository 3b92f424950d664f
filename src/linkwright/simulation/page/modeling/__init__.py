"""World editing in the page."""
