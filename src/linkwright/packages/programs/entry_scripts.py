"""Cached script files for entry points, which ``colcon build`` would install.

A launch file may search for the path of an executable, and debuggers, shells and process lists expect each program to
have its own file. Therefore, a script file is written for an entry point.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from keyword import iskeyword
from pathlib import Path

from linkwright.files.user_folders import cache_folder
from linkwright.files.whole_files import write_whole_file
from linkwright.packages.programs.child_python import python_command
from linkwright.packages.readers.installed import EntryPoint

_MAX_INTERPRETER_LINE = 120
"""The maximum length of the interpreter line in characters. Operating systems truncate longer lines."""


def make_script(package: str, name: str, entry: EntryPoint, roots: Sequence[Path]) -> Path:
    """Return the script file that runs an entry point.

    The file is written if it does not exist or its content has changed.

    Args:
        package: the name of the package.
        name: the name of the program.
        entry: the entry point of the program.
        roots: the folders to import modules from, the package's own first.

    Raises:
        OSError: the file cannot be written.
    """
    return _write_script(package, name, str(roots[0]), _format_entry_point(entry, roots))


def make_script_for_own_node(package: str, name: str) -> Path:
    """Return the script file that runs one of Linkwright's own nodes.

    Raises:
        OSError: the file cannot be written.
    """
    lines = [
        *_format_interpreter_lines(),
        "import sys",
        "",
        "from linkwright.process.interruption import end_on_interrupt",
        "",
        'if __name__ == "__main__":',
        "    end_on_interrupt()",
        "    from linkwright.nodes.process import main",
        "",
        f"    sys.exit(main({package!r}, {name!r}, sys.argv[1:]))",
        "",
    ]
    return _write_script(package, name, __file__, "\n".join(lines))


def _write_script(package: str, name: str, origin: str, text: str) -> Path:
    key = hashlib.sha256(f"{origin}\0{package}\0{name}".encode()).hexdigest()[:16]
    path = cache_folder() / "executables" / key / "lib" / package / name
    if path.is_file() and path.read_text(encoding="utf-8") == text:
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole_file(path, text, mode=0o755)
    return path


def _format_entry_point(entry: EntryPoint, roots: Sequence[Path]) -> str:
    function, _, attributes = entry.function.partition(".")
    is_importable = all(part.isidentifier() and not iskeyword(part) for part in entry.module.split("."))
    return "\n".join(
        [
            *_format_interpreter_lines(),
            "import sys",
            *([] if is_importable else ["from importlib import import_module"]),
            "",
            f"sys.path[:1] = {[str(root) for root in roots]!r}",
            # Python can import a module such as '3d_mapping.node', although a statement cannot name it.
            f"from {entry.module} import {function}  # noqa: E402"
            if is_importable
            else f"{function} = import_module({entry.module!r}).{function}",
            "",
            'if __name__ == "__main__":',
            f"    sys.exit({function}{'.' if attributes else ''}{attributes}())",
            "",
        ]
    )


def _format_interpreter_lines() -> list[str]:
    (interpreter,) = python_command([])
    line = f"#!{interpreter}"
    if " " not in interpreter and len(line) < _MAX_INTERPRETER_LINE:
        return [line]
    # The shell runs the second line as a command, and Python reads it as the beginning of a string.
    return ["#!/bin/sh", f'\'\'\'exec\' "{interpreter}" "$0" "$@"', "' '''"]
