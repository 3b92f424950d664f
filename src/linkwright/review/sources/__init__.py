"""The comparison of the sources of nodes: what they offer to other programs, read without running them."""
