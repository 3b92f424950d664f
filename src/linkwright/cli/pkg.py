"""``linkwright pkg``: create ROS packages, and find and describe installed ones."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.cli.maintainer import find_maintainer
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase, print_diagnostics

if TYPE_CHECKING:
    _Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


class _ListLicenses(argparse.Action):
    """The action that stores a license or, for ``?``, lists the known licenses and exits."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        if values == "?":
            from linkwright.packages.creation.licenses import list_known_licenses

            print("\n".join(["Supported licenses:", *list_known_licenses()]))
            parser.exit(0)
        setattr(namespace, self.dest, values)


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``pkg``."""
    from linkwright.packages.creation.request import BUILD_TYPES, DEFAULT_DESCRIPTION, DEFAULT_LICENSE

    verbs = parser.add_subparsers(dest="verb", metavar="COMMAND", required=True, title="commands")
    create_parser = verbs.add_parser(
        "create", help="create a new package", description="create a new package, laid out as ros2 pkg create does"
    )
    create_parser.add_argument(
        "name", metavar="NAME", help="the package's name: lower-case letters, digits, underscores"
    )
    create_parser.add_argument(
        "--package-format",
        "--package_format",
        type=int,
        default=3,
        choices=(2, 3),
        help="format of package.xml, default 3",
    )
    create_parser.add_argument(
        "--description", metavar="TEXT", default=DEFAULT_DESCRIPTION, help="one sentence for package.xml"
    )
    create_parser.add_argument(
        "--license",
        metavar="LICENSE",
        action=_ListLicenses,
        default=DEFAULT_LICENSE,
        help="SPDX identifier or any text; for a known identifier, the file LICENSE is written; '?' lists the "
        "known identifiers",
    )
    create_parser.add_argument(
        "--destination-directory",
        metavar="FOLDER",
        default=".",
        help="the folder to create the package in, default the current one",
    )
    create_parser.add_argument(
        "--build-type",
        choices=BUILD_TYPES,
        default="ament_cmake",
        help="the build type of the package, default ament_cmake",
    )
    create_parser.add_argument(
        "--dependencies", metavar="PACKAGE", nargs="+", default=[], help="packages that this one depends on"
    )
    create_parser.add_argument(
        "--maintainer-email",
        metavar="EMAIL",
        help="the maintainer's address, default git's user.email or login@todo.todo",
    )
    create_parser.add_argument(
        "--maintainer-name", metavar="TEXT", help="the maintainer's name, default git's user.name or the login name"
    )
    create_parser.add_argument("--node-name", metavar="NODE", help="create an executable with this name")
    create_parser.add_argument("--library-name", metavar="LIBRARY", help="create a library with this name")
    create_parser.set_defaults(handler=_create_package)
    _configure_queries(verbs)


def run(arguments: argparse.Namespace) -> int:
    """Run the requested subcommand."""
    run_verb: Callable[[argparse.Namespace], int] = arguments.handler
    return run_verb(arguments)


def _create_package(arguments: argparse.Namespace) -> int:
    """Create a package, and print each step as ``ros2 pkg create`` does."""
    from linkwright.packages.creation.create import create_package
    from linkwright.packages.creation.request import PackageRequest

    request = PackageRequest(
        name=arguments.name,
        maintainer=find_maintainer(arguments.maintainer_name, arguments.maintainer_email),
        year=datetime.now().astimezone().year,
        destination=Path(arguments.destination_directory),
        package_format=arguments.package_format,
        build_type=arguments.build_type,
        description=arguments.description,
        license=arguments.license,
        dependencies=tuple(dict.fromkeys(arguments.dependencies)),
        node_name=arguments.node_name,
        library_name=arguments.library_name,
    )
    warnings = create_package(request, print)
    print_diagnostics(warnings, sys.stderr)
    return 0


def _configure_queries(verbs: _Subparsers) -> None:
    """Declare the subcommands that describe packages."""
    list_parser = verbs.add_parser("list", help="list all packages", description="list all packages")
    list_parser.set_defaults(handler=_print_packages)

    prefix_parser = verbs.add_parser(
        "prefix", help="print the install prefix of a package", description="print the install prefix of a package"
    )
    prefix_parser.add_argument("package", metavar="PACKAGE", help="the package")
    prefix_parser.add_argument(
        "--share", action="store_true", help="print the package's share folder instead of its prefix"
    )
    prefix_parser.set_defaults(handler=_print_prefix)

    executables_parser = verbs.add_parser(
        "executables", help="list the executables of packages", description="list the executables of packages"
    )
    executables_parser.add_argument("package", metavar="PACKAGE", nargs="?", help="the package (default: all packages)")
    executables_parser.add_argument("--full-path", action="store_true", help="print paths instead of names")
    executables_parser.set_defaults(handler=_print_executables)

    xml_parser = verbs.add_parser(
        "xml", help="print the package.xml of a package", description="print the package.xml of a package"
    )
    xml_parser.add_argument("package", metavar="PACKAGE", help="the package")
    xml_parser.add_argument("-t", "--tag", metavar="TAG", help="print only the contents of these elements of <package>")
    xml_parser.set_defaults(handler=_print_manifest)


def _print_packages(_: argparse.Namespace) -> int:
    from linkwright.launch import builtin_packages
    from linkwright.packages import PackageFinder

    print("\n".join(sorted({*PackageFinder().packages(), *builtin_packages()})))
    return 0


def _print_prefix(arguments: argparse.Namespace) -> int:
    from linkwright.packages import PackageFinder
    from linkwright.packages.share_layout import find_prefix

    share = PackageFinder().share(arguments.package)
    print(share if arguments.share else find_prefix(arguments.package, share))
    return 0


def _print_executables(arguments: argparse.Namespace) -> int:
    from linkwright.launch import builtin_packages, find_executables
    from linkwright.packages import PackageFinder

    finder = PackageFinder()
    packages = [arguments.package] if arguments.package else sorted({*finder.packages(), *builtin_packages()})
    for package in packages:
        for name, path in sorted(find_executables(finder, package).items()):
            print(path if arguments.full_path else f"{package} {name}")
    return 0


def _print_manifest(arguments: argparse.Namespace) -> int:
    from linkwright.packages import MANIFEST, PackageFinder
    from linkwright.xmltree import parse_file

    path = PackageFinder().share(arguments.package) / MANIFEST
    document = parse_file(path)
    if arguments.tag is None:
        sys.stdout.write(path.read_text(encoding="utf-8"))
        return 0
    elements = [element for element in document.root.elements() if element.tag == arguments.tag]
    if not elements:
        names = sorted({element.tag for element in document.root.elements()})
        raise LinkwrightError(
            Diagnostic(
                "CLI108",
                phrase(
                    "package.xml of '{package}' has no element <{tag}>", package=arguments.package, tag=arguments.tag
                ),
                hint=did_you_mean(arguments.tag, names) or phrase("choose from {names}", names=joined(names)),
            )
        )
    for element in elements:
        print(element.text())
    return 0
