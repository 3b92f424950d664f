"""Find names, values and undefined names in the syntax trees of Python sources."""
