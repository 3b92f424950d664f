"""Serve an editor as one language server.

The server combines Linkwright's own server with the servers for Python files.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from pygls.lsp.server import LanguageServer

from linkwright.lsp.python.programs import Program
from linkwright.lsp.python.responses import OWN_SERVER
from linkwright.lsp.python.router import Router
from linkwright.lsp.python.servers import Stream, read_messages


def serve(server: LanguageServer, programs: Sequence[Program]) -> None:
    """Serve an editor over standard input and output until it closes the connection.

    Args:
        server: Linkwright's own server, which runs in this thread.
        programs: the servers for Python files; if there is none, the editor is connected to Linkwright's own server.
    """
    requests, responses = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    sys.stdout = sys.stderr  # Standard output carries only the responses.
    if not programs:
        with requests, responses:
            server.start_io(requests, responses)
        return
    own_requests, to_own = os.pipe()
    from_own, own_responses = os.pipe()
    editor, own = Stream("editor", responses), Stream(OWN_SERVER, os.fdopen(to_own, "wb"))
    router = Router(editor, own, programs)
    read_messages(requests, router.from_editor)
    ended = read_messages(os.fdopen(from_own, "rb"), router.from_own)
    try:
        with os.fdopen(own_requests, "rb") as reader, os.fdopen(own_responses, "wb") as writer:
            server.start_io(reader, writer)
    finally:  # The thread that reads the requests ends with the process.
        ended.join()
        router.close()
        editor.close()
