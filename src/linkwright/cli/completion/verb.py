"""``linkwright completion``: print the completion script of a shell."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``completion``."""
    from linkwright.cli.completion.scripts import SHELLS

    parser.add_argument("shell", metavar="SHELL", choices=tuple(SHELLS), help="bash, zsh or fish")
    parser.epilog = (
        'Put `eval "$(linkwright completion bash)"` into `~/.bashrc`, `eval "$(linkwright completion zsh)"` into '
        "`~/.zshrc`, or `linkwright completion fish | source` into `~/.config/fish/config.fish`. "
        "`linkwright shell` sets up completion by itself."
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the completion script, and return the exit status."""
    from linkwright.cli.completion.scripts import completion_script

    print(completion_script(arguments.shell, sys.executable, ["linkwright"]), end="")
    return 0
