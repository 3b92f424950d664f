"""The options that choose messages, services or actions."""

from __future__ import annotations

import argparse

_OPTIONS = (("msg", "-m", "msgs", "message"), ("srv", "-s", "srvs", "service"), ("action", "-a", "actions", "action"))


def add_kind_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare ``--only-msgs``, ``--only-srvs`` and ``--only-actions``."""
    for kind, short, plural, name in _OPTIONS:
        parser.add_argument(short, f"--only-{plural}", dest=kind, action="store_true", help=f"only {name} types")


def kinds(arguments: argparse.Namespace) -> list[str]:
    """The kinds asked for: ``msg``, ``srv``, ``action``; all when none is."""
    every = [kind for kind, *_ in _OPTIONS]
    return [kind for kind in every if getattr(arguments, kind)] or every
