"""Programs with a ``main`` that run in lockstep with a stepped graph."""
