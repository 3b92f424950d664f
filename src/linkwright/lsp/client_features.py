"""Progress of long work in an editor, and notifications of changes to files on the disk."""

from __future__ import annotations

import asyncio
from typing import Any
from uuid import uuid4

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.translation import localized

_PROGRESS_DELAY_S = 0.5
"""The time in seconds after which an editor shows progress. Shorter work would only flicker."""

WATCHED_FILES = (
    "**/*.{xacro,urdf,sdf,world,srdf,launch,xml,py,yaml,yml,toml,msg,srv,action}",
    "**/model.config",
    "**/CMakeLists.txt",
)
"""The files on the disk that affect findings: descriptions, callers, packages and settings."""


async def show_progress(server: LanguageServer, title: Phrase, work: asyncio.Future[Any]) -> None:
    """Show a progress indicator for long-running work, if the editor supports it.

    Args:
        server: the language server, after its initialization.
        title: the title of the indicator.
        work: the future of the work. The function returns when the work is done.
    """
    await asyncio.wait([work], timeout=_PROGRESS_DELAY_S)
    window = server.client_capabilities.window
    if work.done() or window is None or not window.work_done_progress:
        return
    token = str(uuid4())
    try:
        await server.work_done_progress.create_async(token)
    except JsonRpcException:  # The editor rejected the progress indicator.
        return
    server.work_done_progress.begin(token, types.WorkDoneProgressBegin(localized(title)))
    await asyncio.wait([work])
    server.work_done_progress.end(token, types.WorkDoneProgressEnd())
    server.work_done_progress.tokens.pop(token, None)


async def watch_files(server: LanguageServer) -> None:
    """Register for changes to files on the disk, if the editor supports it."""
    workspace = server.client_capabilities.workspace
    watched = None if workspace is None else workspace.did_change_watched_files
    if watched is None or not watched.dynamic_registration:
        return
    options = types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher(glob) for glob in WATCHED_FILES])
    method = types.WORKSPACE_DID_CHANGE_WATCHED_FILES
    registration = types.Registration("watched-files", method, options)
    await server.client_register_capability_async(types.RegistrationParams([registration]))
