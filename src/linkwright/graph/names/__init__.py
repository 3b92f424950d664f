"""Names in the graph: validation, expansion, remapping, and matching by regular expressions."""
