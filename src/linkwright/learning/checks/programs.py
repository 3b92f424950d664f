"""Programs of the learner's packages, to be started in a stepped graph or simulation."""

from __future__ import annotations

import importlib
import re
import sys
import traceback
from collections.abc import Callable
from pathlib import Path

from linkwright.diagnostics import Phrase, foreign, nearest, phrase
from linkwright.diagnostics.lookalikes import lookalike_hint
from linkwright.learning.checks.findings import add_hint
from linkwright.learning.checks.not_yet import NotYet

_ADDRESS = re.compile(r" at 0x[0-9a-f]+")


def find_program(folder: Path, package: str, name: str) -> Callable[[], object]:
    """Return the ``main`` of an executable that a package's ``setup.py`` declares.

    The function imports the learner's module when it is called, and is meant for `SteppedGraph.start_program`.

    Args:
        folder: the folder of the package.
        package: the name of the package.
        name: the name of the executable.

    Raises:
        NotYet: the package declares no such executable, or has no such module.
    """
    from linkwright import standins
    from linkwright.packages.programs.source_programs import module_file, python_root, source_programs

    entries = source_programs(folder).entry_points
    if name not in entries:
        similar = nearest(name, entries, 1)
        if similar:
            raise NotYet(
                phrase("setup.py declares no executable '{name}'; there is '{similar}'", name=name, similar=similar[0])
            )
        raise NotYet(phrase("setup.py declares no executable '{name}' in 'console_scripts'", name=name))
    entry = entries[name]
    root = python_root(folder, package)
    if root is None or module_file(root, entry.module) is None:
        raise NotYet(
            phrase(
                "the executable '{name}' names the module '{module}', which is missing", name=name, module=entry.module
            )
        )
    standins.activate()
    if str(root) not in sys.path:
        sys.path.insert(0, str(root))

    def main() -> object:
        module = importlib.import_module(entry.module)
        function = getattr(module, entry.function, None)
        if function is None:
            raise NotYet(phrase("{module} has no function '{function}'", module=entry.module, function=entry.function))
        return function()

    return main


def describe_failure(error: Exception, workspace: Path) -> Phrase:
    """Return an exception as one sentence, with the last line of the learner's files that it passed."""
    from linkwright.launch.errors.user_code import hint_about

    text = _ADDRESS.sub("", f"{type(error).__name__}: {error}")
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if Path(frame.filename).is_relative_to(workspace)]
    if isinstance(error, SyntaxError) and error.filename and Path(error.filename).is_relative_to(workspace):
        text = f"{type(error).__name__}: {error.msg}"
        hint = lookalike_hint(error.text or "") if "invalid character" in error.msg else None
        place, line = error.filename, error.lineno or 1
    elif own:
        hint = hint_about(error)
        place, line = own[-1].filename, own[-1].lineno or 1
    else:
        return phrase("the check failed: {error}", error=foreign(text))
    described = phrase("{file}, line {line}: {error}", file=Path(place).name, line=line, error=foreign(text))
    return add_hint(described, hint)
