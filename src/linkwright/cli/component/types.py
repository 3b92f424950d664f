"""``linkwright component types``."""

from __future__ import annotations

import argparse

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase

HELP = "list the components that come with Linkwright"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("package_name", metavar="PACKAGE", nargs="?", help="only those of this package")


def run(arguments: argparse.Namespace) -> int:
    """Print their names below their packages, as ros2 does."""
    from linkwright.nodes.registry import COMPONENTS

    by_package: dict[str, list[str]] = {}
    for package, plugin in sorted(COMPONENTS):
        by_package.setdefault(package, []).append(plugin)
    wanted = arguments.package_name
    if wanted is None:
        for package, plugins in by_package.items():
            print("\n  ".join([package, *plugins]))
        return 0
    if wanted not in by_package:
        hint = did_you_mean(wanted, by_package) or phrase("there are: {by_package}", by_package=joined(by_package))
        raise LinkwrightError(
            Diagnostic("CLI436", phrase("No component types found in package '{wanted}'", wanted=wanted), hint=hint)
        )
    print("\n".join(by_package[wanted]))
    return 0
