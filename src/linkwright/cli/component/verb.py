"""The verb ``component`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import configure_nested, run_nested

HELP = "load nodes into containers, list and unload them"
VERBS = {
    "list": "listing",
    "load": "load",
    "standalone": "standalone",
    "types": "types",
    "unload": "unload",
}

configure = partial(configure_nested, package=__package__, modules=VERBS)
run = run_nested
