"""``linkwright interface package``."""

from __future__ import annotations

import argparse

from linkwright.cli.interface.kinds import add_kind_arguments, kinds
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase

HELP = "list the types of a package"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("package_name", metavar="PACKAGE", help="such as example_interfaces")
    add_kind_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print their names, a line each."""
    from linkwright.messages import interface_names

    package = arguments.package_name
    known = {kind: interface_names(kind) for kind in ("msg", "srv", "action")}
    packages = sorted({name.split("/")[0] for names in known.values() for name in names})
    if package not in packages:
        hint = did_you_mean(package, packages) or phrase("`linkwright interface packages` lists those with types")
        raise LinkwrightError(Diagnostic("CLI441", phrase("Unknown package '{package}'", package=package), hint=hint))
    names = [name for kind in kinds(arguments) for name in known[kind]]
    for name in sorted(name for name in names if name.startswith(f"{package}/")):
        print(name)
    return 0
