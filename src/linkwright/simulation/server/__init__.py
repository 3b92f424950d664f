"""A simulation as a part of the graph: what runs it, what it publishes, and what may be asked of it."""
