"""``linkwright lsp``: the language server for editors."""

from __future__ import annotations

import argparse
import gc
import logging
import sys

from linkwright.cli.exit_status import FINE
from linkwright.diagnostics import Diagnostic, LinkwrightError, missing_extra, phrase

_LOOPBACK = "127.0.0.1"
_GC_THRESHOLD = 2_000
"""The number of new objects that starts a garbage collection.

Garbage may contain the text of each edit.
"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``lsp``."""
    transport_group = parser.add_mutually_exclusive_group()
    transport_group.add_argument("--stdio", action="store_true", help="use standard input and output (the default)")
    transport_group.add_argument(
        "--tcp", metavar="PORT", type=int, help="listen on this port of 127.0.0.1 for a connection"
    )
    transport_group.add_argument(
        "--ws", metavar="PORT", type=int, help="listen on this port of 127.0.0.1 for a WebSocket"
    )
    parser.add_argument(
        "--python",
        action="store_true",
        help="also report the results of ty and ruff for Python files, if they are installed (not with --tcp and --ws)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Serve an editor until the connection is closed."""
    try:
        from linkwright.lsp.features import make_server
        from linkwright.lsp.python.combined_server import serve
        from linkwright.lsp.python.programs import installed_programs
    except ModuleNotFoundError as error:
        raise missing_extra("CLI307", error) from None
    if arguments.python and (arguments.tcp is not None or arguments.ws is not None):
        message = phrase("--python works only over standard input and output, not with --tcp or --ws")
        raise LinkwrightError(Diagnostic("CLI308", message))
    logging.basicConfig(stream=sys.stderr, level=logging.WARNING, format="linkwright lsp: %(message)s")
    server = make_server()
    gc.set_threshold(_GC_THRESHOLD)
    if arguments.tcp is not None:
        server.start_tcp(_LOOPBACK, arguments.tcp)
    elif arguments.ws is not None:
        server.start_ws(_LOOPBACK, arguments.ws)
    else:
        serve(server, installed_programs() if arguments.python else [])
    return FINE
