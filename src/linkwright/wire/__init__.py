"""Transports that connect the graph to other processes, one folder for each.

The transports implement one interface, `linkwright.graph.endpoints.bus.Transport`, through which alone the graph uses
them. ``Graph.attach`` attaches a transport. `joining` decides which transport a process uses.
"""
