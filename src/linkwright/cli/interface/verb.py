"""The verb ``interface`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import configure_nested, run_nested

HELP = "list and show types of messages, services and actions"
VERBS = {
    "list": "listing",
    "package": "package",
    "packages": "packages",
    "proto": "proto",
    "show": "show",
}

configure = partial(configure_nested, package=__package__, modules=VERBS)
run = run_nested
