"""``linkwright explain``: explain a rule, another diagnostic, an element or an attribute."""

from __future__ import annotations

import argparse

from linkwright.diagnostics import Diagnostic, LinkwrightError, joined, nearest, phrase
from linkwright.diagnostics.translation import localized


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``explain``."""
    parser.add_argument(
        "code",
        metavar="CODE|ELEMENT",
        help="a code such as LW201, limit-inverted or URDF110, or an element or attribute such as joint.limit.effort",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the explanation of a rule, diagnostic, element or attribute."""
    from linkwright.lint.explain import find_page, find_similar_codes
    from linkwright.urdf.vocabulary import meanings, names

    page = find_page(arguments.code)
    if page is not None:
        print(localized(page.markdown))
        return 0
    explanations = meanings(arguments.code)
    if not explanations:
        suggestions = list(dict.fromkeys([*find_similar_codes(arguments.code), *nearest(arguments.code, names(), 2)]))
        hint = (
            phrase("did you mean {names}?", names=joined(suggestions, last=" or "))
            if suggestions
            else phrase("see docs/rules.md for the rules")
        )
        message = phrase("there is no code, rule, element or attribute '{code}'", code=arguments.code)
        raise LinkwrightError(Diagnostic("CLI301", message, hint=hint))
    print("\n\n".join(map(localized, explanations)))
    return 0
