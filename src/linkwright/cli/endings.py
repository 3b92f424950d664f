"""How a command ends: whatever stops it becomes one message and the exit status that stands for it."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterable

from linkwright._version import __version__
from linkwright.cli.language import UnknownLanguageError
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase, print_diagnostics
from linkwright.interruption import INTERRUPTED
from linkwright.standard_streams import take_any_text
from linkwright.whole_files import NO_SPACE

FINE, FINDINGS, USAGE, BUG = 0, 1, 2, 3

_OF_OUTPUT = NO_SPACE | {errno.EBADF}

_OF_THE_SYSTEM = _OF_OUTPUT | {
    errno.EACCES,
    errno.EMFILE,
    errno.ENFILE,
    errno.ENOMEM,
    errno.EPERM,
    errno.EROFS,
}
"""What the machine refuses through no fault of the program."""


def status_of(command: Callable[[], int]) -> int:
    """Run a command, and give the exit status that it ends with; what it printed is written out by then.

    Args:
        command: returns the status where nothing stops it.
    """
    try:
        open_closed_streams()
        take_any_text()
        try:
            status = command()
        except SystemExit as stop:  # argparse
            status = stop.code if isinstance(stop.code, int) else USAGE
        print(end="", flush=True)  # here, where it is known what to do when nobody reads it
    except UnknownLanguageError as error:
        say(f"linkwright: {error}")
        return USAGE
    except LinkwrightError as error:
        _print(error.diagnostics)
        return FINDINGS
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:  # the reader of our output went away (`| head`)
        _leave_output()
        return FINE
    except MemoryError:
        _print([Diagnostic("CLI204", phrase("there is not enough memory for that"))])
        return FINDINGS
    except Exception as error:  # noqa: BLE001 - the last line of defence: a bug of ours must not print a traceback
        trouble = _trouble_of_the_system(error) if isinstance(error, OSError) else None
        if trouble is None:
            _report_bug(error)
            return BUG
        _print([trouble])
        return FINDINGS
    return status


def open_closed_streams() -> None:
    """Give a process that was started with standard streams closed what stands for them.

    Otherwise the next file that is opened would take their numbers. Nothing can be read from the input, writing to the
    output fails, and messages go nowhere.
    """
    if sys.stdin is None:
        sys.stdin = _open_as(0, os.O_RDONLY, "r")
    if sys.stdout is None:
        sys.stdout = _open_as(1, os.O_RDONLY, "w")
    if sys.stderr is None:
        sys.stderr = _open_as(2, os.O_WRONLY, "w")


def _open_as(number: int, flags: int, mode: str) -> object:
    descriptor = os.open(os.devnull, flags)
    if descriptor != number:
        os.dup2(descriptor, number)
        os.close(descriptor)
    return open(number, mode, encoding="utf-8", closefd=False)


def _trouble_of_the_system(error: OSError) -> Diagnostic | None:
    """The error of the machine: it refuses the output, the working directory, a file; None for a bug of ours."""
    reason = foreign(error.strerror or error)
    # Whatever writes files says which file was refused, so one without a name is the output.
    if error.filename is None and error.errno in _OF_OUTPUT:
        _leave_output()
        return Diagnostic("CLI202", phrase("cannot write to standard output: {reason}", reason=reason))
    try:
        os.getcwd()  # noqa: PTH109 - nothing is to be loaded now
    except OSError:
        message = phrase("the folder that this command was started in is not there any more")
        return Diagnostic("CLI203", message, hint=phrase("change to a folder that is there, for instance with `cd ~`"))
    if error.errno not in _OF_THE_SYSTEM:
        return None
    if error.filename is None:
        return Diagnostic("CLI205", phrase("the system refuses what is needed: {reason}", reason=reason))
    path = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes) else str(error.filename)
    return Diagnostic("CLI205", phrase("the system refuses '{path}': {reason}", path=path, reason=reason))


def _leave_output() -> None:
    """Let Python flush into nothing when it ends; it would complain once more."""
    from contextlib import suppress  # which is slow to import, and seldom needed

    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _print(diagnostics: Iterable[Diagnostic]) -> None:
    try:  # noqa: SIM105 - contextlib takes long to import
        print_diagnostics(diagnostics, sys.stderr)
    except OSError:
        pass


def say(text: str) -> None:
    """Print a line to standard error; what nobody can read changes no exit status."""
    from contextlib import suppress  # which is slow to import, and seldom needed

    with suppress(OSError):
        print(text, file=sys.stderr, flush=True)


def _report_bug(error: Exception) -> None:
    import tempfile
    import traceback

    say(f"linkwright: this is a bug of ours: {type(error).__name__}: {error}")
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="linkwright-", suffix=".log", delete=False, encoding="utf-8"
        ) as log:
            log.write(f"linkwright {__version__}, Python {sys.version}, words {sys.argv[1:]}\n")
            traceback.print_exception(type(error), error, error.__traceback__, file=log)
    except OSError:
        say("".join(traceback.format_exception(error)))
    else:
        say(f"Please report it with the file {log.name}")
