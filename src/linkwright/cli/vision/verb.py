"""The verb ``vision`` and the verbs below it."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.vision import detect, evaluate, train

VERBS = {
    "detect": SubVerb(detect.configure, detect.run, help="find things in pictures, with a network or without one"),
    "evaluate": SubVerb(evaluate.configure, evaluate.run, help="say how well a detector does on a dataset"),
    "train": SubVerb(train.configure, train.run, help="teach a network with the pictures of a dataset"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
