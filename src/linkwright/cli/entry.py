"""The entry point of the command line.

Before anything else is imported, it makes Ctrl-C end the process without a traceback.
"""

from __future__ import annotations

from linkwright.process.interruption import end_at_once


def main(words: list[str] | None = None, *, program: str = "linkwright") -> int:
    """Run the command line; see `linkwright.cli.command.main`.

    Args:
        words: the arguments after the program's name; None for the arguments of this process.
        program: the program's name in usage lines.

    Returns:
        The exit status.
    """
    if words is None:
        end_at_once()
    from linkwright.cli.command import main as run

    return run(words, program=program)
