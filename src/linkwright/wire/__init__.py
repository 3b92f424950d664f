"""Transports that connect the graph to other processes, one folder for each.

They implement one interface, `linkwright.graph.endpoints.bus.Transport`, which is all that the graph knows of them.
``Graph.attach`` attaches a transport. `joining` decides which transport a process uses.
"""
