"""The command ``vision`` and its subcommands."""

from __future__ import annotations

from functools import partial

from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.vision import detect, evaluate, train

VERBS = {
    "detect": SubVerb(detect.configure, detect.run, help="detect objects in images, with or without a network"),
    "evaluate": SubVerb(evaluate.configure, evaluate.run, help="evaluate a detector on a dataset"),
    "train": SubVerb(train.configure, train.run, help="train a network on the images of a dataset"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
