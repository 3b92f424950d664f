"""Transports that connect the graph to other processes, one folder for each.

The graph uses transports only through the interface `linkwright.graph.endpoints.bus.Transport`. ``Graph.attach``
attaches a transport. `joining` decides which transport a process uses.
"""
