"""A simulation with long steps, which suffice for bodies in fluids."""

from __future__ import annotations

from functools import partial

from tests.simulation import test_plugins

running_server = partial(test_plugins.running_server, step=0.01)
weightless_server = partial(running_server, gravity="0 0 0")
