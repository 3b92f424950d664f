"""Names in the graph: validation, expansion, remapping, and expressions that find them."""
