"""The verb ``action`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import configure_nested, run_nested

HELP = "list actions and send goals"
VERBS = {"info": "info", "list": "listing", "send_goal": "send_goal", "type": "type_of"}

configure = partial(configure_nested, package=__package__, modules=VERBS)
run = run_nested
