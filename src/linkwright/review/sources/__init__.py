"""Compare the sources of nodes: the names that they offer to other programs, read without running them."""
