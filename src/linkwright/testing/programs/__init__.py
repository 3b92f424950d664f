"""Programs with a ``main``, which run in lockstep with a stepped graph."""
