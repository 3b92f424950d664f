"""Transports that carry the graph to other processes, a folder each.

They have one interface, `linkwright.graph.endpoints.bus.Transport`; the graph calls it and knows nothing else of
them. ``Graph.attach`` takes one. Which one a process has is decided in `joining`.
"""
