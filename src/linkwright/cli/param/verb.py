"""The verb ``param`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import configure_nested, run_nested

HELP = "list, read and set parameters of nodes"
VERBS = {
    "delete": "delete",
    "describe": "describe",
    "dump": "dump",
    "get": "get",
    "list": "listing",
    "load": "load",
    "set": "set",
}

configure = partial(configure_nested, package=__package__, modules=VERBS)
run = run_nested
