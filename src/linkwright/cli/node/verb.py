"""The verb ``node`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import configure_nested, run_nested

HELP = "list and describe nodes"
VERBS = {"info": "info", "list": "listing"}

configure = partial(configure_nested, package=__package__, modules=VERBS)
run = run_nested
