"""The verb ``bag`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import configure_nested, run_nested

HELP = "record topics, play recordings and tell what is in them"
VERBS = {"info": "info", "play": "play", "record": "record"}

configure = partial(configure_nested, package=__package__, modules=VERBS)
run = run_nested
