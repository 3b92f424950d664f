"""``linkwright explain``: the page of a rule or of another diagnostic."""

from __future__ import annotations

import argparse

from linkwright.diagnostics import Diagnostic, LinkwrightError

HELP = "say what a rule or diagnostic code means, why it matters and what to do"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("code", metavar="CODE", help="such as LW201, limit-inverted or URDF110")


def run(arguments: argparse.Namespace) -> int:
    """Print the page."""
    from linkwright.lint.explain import find_page, nearest_codes

    page = find_page(arguments.code)
    if page is None:
        near = nearest_codes(arguments.code)
        hint = f"did you mean {' or '.join(near)}?" if near else "docs/rules.md lists the rules"
        raise LinkwrightError(Diagnostic("CLI301", f"there is no code or rule '{arguments.code}'", hint=hint))
    print(page, end="")
    return 0
