"""The verb ``lifecycle`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import configure_nested, run_nested

HELP = "look at and change the states of managed nodes"
VERBS = {"get": "get", "list": "listing", "nodes": "nodes", "set": "set"}

configure = partial(configure_nested, package=__package__, modules=VERBS)
run = run_nested
