"""Names in the graph: validation, expansion, remapping, and regular expressions."""
