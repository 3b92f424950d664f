"""The entry point of the command line.

Before this module imports any other module, it makes Ctrl-C end the process without a traceback.
"""

from __future__ import annotations

from linkwright.process.interruption import end_on_interrupt


def main(words: list[str] | None = None, *, program: str = "linkwright") -> int:
    """Run the command line; see `linkwright.cli.command.main`.

    Args:
        words: the arguments after the program's name; None for the arguments of this process.
        program: the program's name in usage lines.

    Returns:
        The exit status.
    """
    if words is None:
        end_on_interrupt()
    from linkwright.cli.command import main as run

    return run(words, program=program)
