"""``linkwright pkg list``, ``prefix``, ``executables`` and ``xml``: what is known of packages."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


def configure(verbs: Subparsers) -> None:
    """Declare the commands; each sets `answer`, what runs it."""
    listing = verbs.add_parser("list", help="list the packages there are", description="list the packages there are")
    listing.set_defaults(answer=_list)

    prefix = verbs.add_parser(
        "prefix", help="print where a package is installed", description="print where a package is installed"
    )
    prefix.add_argument("package", metavar="PACKAGE", help="the package")
    prefix.add_argument("--share", action="store_true", help="print its share folder instead of the prefix")
    prefix.set_defaults(answer=_prefix)

    executables = verbs.add_parser(
        "executables", help="list the executables of packages", description="list the executables of packages"
    )
    executables.add_argument("package", metavar="PACKAGE", nargs="?", help="the package, default all")
    executables.add_argument("--full-path", action="store_true", help="print paths instead of names")
    executables.set_defaults(answer=_executables)

    xml = verbs.add_parser("xml", help="print the package.xml of a package", description="print a package.xml")
    xml.add_argument("package", metavar="PACKAGE", help="the package")
    xml.add_argument("-t", "--tag", metavar="TAG", help="only the texts of these elements below <package>")
    xml.set_defaults(answer=_xml)


def _list(_: argparse.Namespace) -> int:
    from linkwright.launch import builtin_packages
    from linkwright.packages import PackageFinder

    print("\n".join(sorted({*PackageFinder().packages(), *builtin_packages()})))
    return 0


def _prefix(arguments: argparse.Namespace) -> int:
    from linkwright.packages import PackageFinder, install_prefix

    share = PackageFinder().share(arguments.package)
    print(share if arguments.share else install_prefix(share))
    return 0


def _executables(arguments: argparse.Namespace) -> int:
    from linkwright.launch import builtin_packages, executables_of
    from linkwright.packages import PackageFinder

    finder = PackageFinder()
    packages = [arguments.package] if arguments.package else sorted({*finder.packages(), *builtin_packages()})
    for package in packages:
        for name, place in sorted(executables_of(finder, package).items()):
            print(place if arguments.full_path else f"{package} {name}")
    return 0


def _xml(arguments: argparse.Namespace) -> int:
    from linkwright.packages import MANIFEST, PackageFinder
    from linkwright.xmltree import parse_file

    path = PackageFinder().share(arguments.package) / MANIFEST
    document = parse_file(path)
    if arguments.tag is None:
        sys.stdout.write(path.read_text(encoding="utf-8"))
        return 0
    found = [each for each in document.root.elements() if each.tag == arguments.tag]
    if not found:
        names = sorted({each.tag for each in document.root.elements()})
        raise LinkwrightError(
            Diagnostic(
                "CLI108",
                phrase(
                    "package.xml of '{package}' has no element <{tag}>", package=arguments.package, tag=arguments.tag
                ),
                hint=did_you_mean(arguments.tag, names) or phrase("there are {names}", names=joined(names)),
            )
        )
    for element in found:
        print(element.text())
    return 0
