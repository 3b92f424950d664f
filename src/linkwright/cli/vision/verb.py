"""The verb ``vision`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.vision import detect

VERBS = {
    "detect": SubVerb(detect.configure, detect.run, help="find things in pictures, with a network or without one"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
