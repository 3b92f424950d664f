"""The messages and exit statuses for errors of commands."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterable

from linkwright._version import __version__
from linkwright.cli.language import UnknownLanguageError
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase, print_diagnostics
from linkwright.files.whole_files import DISK_ERRORS
from linkwright.process.interruption import INTERRUPTED
from linkwright.process.standard_streams import accept_any_text

FINE, FINDINGS, USAGE, BUG = 0, 1, 2, 3

_OUTPUT_ERRORS = DISK_ERRORS | {errno.EBADF}

_SYSTEM_ERRORS = _OUTPUT_ERRORS | {
    errno.EACCES,
    errno.EMFILE,
    errno.ENFILE,
    errno.ENOMEM,
    errno.EPERM,
    errno.EROFS,
}
"""Numbers of operating-system errors that are not bugs in the program."""


def run_command(command: Callable[[], int]) -> int:
    """Run a command, flush its output and return its exit status.

    Args:
        command: the function to run; errors that it raises are printed and determine the status.
    """
    try:
        open_closed_streams()
        accept_any_text()
        try:
            status = command()
        except SystemExit as stop:  # raised by argparse
            status = stop.code if isinstance(stop.code, int) else USAGE
        print(end="", flush=True)  # flush here, where a closed output can be handled
    except UnknownLanguageError as error:
        print_message(f"linkwright: {error}")
        return USAGE
    except LinkwrightError as error:
        _print_findings(error.diagnostics)
        return FINDINGS
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:  # the program that reads the output has exited, such as `head`
        _discard_output()
        return FINE
    except MemoryError:
        _print_findings([Diagnostic("CLI204", phrase("there is not enough memory"))])
        return FINDINGS
    except Exception as error:  # noqa: BLE001 - the last resort: a bug must not print a traceback
        diagnostic = _create_system_error_diagnostic(error) if isinstance(error, OSError) else None
        if diagnostic is None:
            _report_bug(error)
            return BUG
        _print_findings([diagnostic])
        return FINDINGS
    return status


def open_closed_streams() -> None:
    """Open null devices for standard streams that were closed when the process was started.

    Without null devices, files that are opened later would get the file descriptors of these streams. With null
    devices, standard input is empty, messages are discarded, and writing to standard output fails.
    """
    if sys.stdin is None:
        sys.stdin = _open_null_device(0, os.O_RDONLY, "r")
    if sys.stdout is None:
        sys.stdout = _open_null_device(1, os.O_RDONLY, "w")
    if sys.stderr is None:
        sys.stderr = _open_null_device(2, os.O_WRONLY, "w")


def _open_null_device(stream_number: int, flags: int, mode: str) -> object:
    descriptor = os.open(os.devnull, flags)
    if descriptor != stream_number:
        os.dup2(descriptor, stream_number)
        os.close(descriptor)
    return open(stream_number, mode, encoding="utf-8", closefd=False)


def _create_system_error_diagnostic(error: OSError) -> Diagnostic | None:
    """Return the diagnostic for an operating system error, or None for a bug in Linkwright."""
    reason = foreign(error.strerror or error)
    # Functions that write files name the file in the error, so an error without a file name concerns standard output.
    if error.filename is None and error.errno in _OUTPUT_ERRORS:
        _discard_output()
        return Diagnostic("CLI202", phrase("cannot write to standard output: {reason}", reason=reason))
    try:
        os.getcwd()  # noqa: PTH109 - import nothing at this point
    except OSError:
        message = phrase("the current folder no longer exists")
        return Diagnostic("CLI203", message, hint=phrase("change to an existing folder, for instance with `cd ~`"))
    if error.errno not in _SYSTEM_ERRORS:
        return None
    if error.filename is None:
        return Diagnostic("CLI205", phrase("the operating system reports an error: {reason}", reason=reason))
    path = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes) else str(error.filename)
    return Diagnostic(
        "CLI205", phrase("the operating system reports an error for '{path}': {reason}", path=path, reason=reason)
    )


def _discard_output() -> None:
    """Redirect standard output to the null device.

    Without this, Python would report a second error when it exits.
    """
    from contextlib import suppress  # imported here, because the import is slow and rarely needed

    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _print_findings(diagnostics: Iterable[Diagnostic]) -> None:
    try:  # noqa: SIM105 - contextlib takes long to import
        print_diagnostics(diagnostics, sys.stderr)
    except OSError:
        pass


def print_message(text: str) -> None:
    """Print a line to standard error, and ignore a failure to write."""
    from contextlib import suppress  # imported here, because the import is slow and rarely needed

    with suppress(OSError):
        print(text, file=sys.stderr, flush=True)


def _report_bug(error: Exception) -> None:
    import tempfile
    import traceback

    print_message(f"linkwright: this is a bug in Linkwright: {type(error).__name__}: {error}")
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="linkwright-", suffix=".log", delete=False, encoding="utf-8"
        ) as log:
            log.write(f"linkwright {__version__}, Python {sys.version}, words {sys.argv[1:]}\n")
            traceback.print_exception(type(error), error, error.__traceback__, file=log)
    except OSError:
        print_message("".join(traceback.format_exception(error)))
    else:
        print_message(f"Please report it with the file {log.name}")
