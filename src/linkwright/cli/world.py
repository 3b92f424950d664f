"""``linkwright world``: list worlds and models, create a world, or check one."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path

from linkwright.cli import check
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.output import write_output
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.translation import localized


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``world list``."""
    parser.add_argument(
        "--json", action="store_true", help="print the kind, name and path of each world and model as a JSON list"
    )


def run_list(arguments: argparse.Namespace) -> int:
    """Print the worlds and models that can be used by name."""
    from linkwright.packages import PackageFinder
    from linkwright.sdf.resources import ResourceFinder

    finder = ResourceFinder(PackageFinder(start=Path.cwd()))
    paths_by_kind = {"world": finder.worlds(), "model": finder.models()}
    if arguments.json:
        rows = [
            {"kind": kind, "name": name, "path": str(path)}
            for kind, paths in paths_by_kind.items()
            for name, path in sorted(paths.items())
        ]
        print(json.dumps(rows, indent=2, ensure_ascii=False))
        return 0
    print(localized(phrase("Worlds:")))
    _print_paths(paths_by_kind["world"])
    print(localized(phrase("Models, for <include><uri>model://NAME</uri></include>:")))
    _print_paths(paths_by_kind["model"])
    return 0


def _print_paths(paths: Mapping[str, Path]) -> None:
    width = max(map(len, paths), default=0)
    for name, path in sorted(paths.items()):
        print(f"  {name:<{width}}  {path}")


def configure_new(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``world new``."""
    parser.add_argument(
        "name", metavar="NAME", help="the world's name, or the file to write, such as worlds/kitchen.world"
    )
    parser.add_argument("--force", action="store_true", help="overwrite an existing file")


def run_new(arguments: argparse.Namespace) -> int:
    """Write a small world file as a starting point."""
    from linkwright.descriptions import is_world
    from linkwright.sdf.starting_world import starting_world

    path = Path(arguments.name)
    if not is_world(path.name) or path.suffix == ".xacro":
        path = path.with_name(f"{path.name}.world")
    if path.exists() and not arguments.force:
        hint = phrase("choose another name, or add --force to overwrite it")
        raise LinkwrightError(Diagnostic("CLI206", phrase("'{path}' already exists", path=path), hint=hint))
    write_output(path, starting_world(path.stem))
    print(f"Created file {path}")
    return 0


VERBS = {
    "list": SubVerb(configure_list, run_list, help="list the worlds and models on the search path, with their folders"),
    "new": SubVerb(
        configure_new, run_new, help="write a small world to start from: ground, sun and a box, with comments"
    ),
    "check": SubVerb(check.configure, check.run, help="check worlds and models, as `linkwright check` does"),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``world``."""
    configure_nested(parser, VERBS)


def run(arguments: argparse.Namespace) -> int:
    """Run the requested subcommand."""
    return run_nested(arguments)
