"""Parse the arguments of the command ``xacro``, as in ``xacro.cli``."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence

from linkwright.standins.xacro_api import color

REMAP = ":="


def load_mappings(argv: Iterable[str]) -> dict[str, str]:
    """Return the values of the arguments ``name:=value`` by name.

    Arguments with an empty name or value, or with a single leading ``_`` in the name, are skipped.

    Raises:
        RuntimeError: an argument contains ``:=`` twice.
    """
    mappings = {}
    for argument in argv:
        if REMAP not in argument:
            continue
        name, value, *extra_parts = (part.strip() for part in argument.split(REMAP))
        if extra_parts:
            raise RuntimeError(f"'{argument}' has more than one '{REMAP}'")
        if name and value and not (len(name) > 1 and name[0] == "_" and name[1] != "_"):
            mappings[name] = value
    return mappings


def process_args(argv: Sequence[str], require_input: bool = True) -> tuple[argparse.Namespace, str | None]:
    """Parse the options and the file name of the command line.

    Args:
        argv: the arguments, without the name of the command.
        require_input: whether exactly one file is required.

    Returns:
        The options ``output``, ``just_deps``, ``in_order``, ``root_dir``, ``verbosity`` and ``mappings``, and the
        file, or None unless the command line names exactly one file.

    Raises:
        SystemExit: the command line is invalid.
    """
    parser = argparse.ArgumentParser(prog="xacro", usage="%(prog)s [options] <input>")
    parser.add_argument("-o", dest="output", metavar="FILE", help="write to this file instead of standard output")
    parser.add_argument("--deps", action="store_true", dest="just_deps", help="print the files that are included")
    parser.add_argument("--inorder", "-i", action="store_true", dest="in_order", help="without effect")
    parser.add_argument("--root-dir", dest="root_dir", metavar="DIR", help="base folder of relative paths")
    parser.add_argument("-q", action="store_const", dest="verbosity", const=0, default=1, help="print errors only")
    parser.add_argument("-v", action="count", dest="verbosity", default=1, help="print more")
    parser.add_argument("--verbosity", metavar="LEVEL", dest="verbosity", type=int, default=1, help="0 to 4")
    parser.add_argument("files", nargs="*", help=argparse.SUPPRESS)
    options = parser.parse_intermixed_args([word for word in argv if REMAP not in word])
    files = options.__dict__.pop("files")
    if options.in_order:
        color.message("xacro: files are always processed in reading order; the option can be omitted")
    options.in_order = True
    if len(files) != 1 and require_input:
        parser.error("exactly one file is expected")
    options.mappings = load_mappings(argv)
    return options, files[0] if len(files) == 1 else None
