"""Checks of large files in a separate process, so that other requests do not wait for them."""

from __future__ import annotations

import asyncio
import multiprocessing
import sys
import threading
from collections.abc import Iterable, Mapping
from contextlib import redirect_stdout
from multiprocessing.connection import Connection
from pathlib import Path

from linkwright.diagnostics import Diagnostic
from linkwright.language.workspace import Workspace


async def check_in_process(
    folders: Iterable[Path], subject: Path, texts: Mapping[Path, str]
) -> tuple[Diagnostic, ...] | None:
    """Check a description or package in a new process, and return the findings.

    A cancellation kills the process.

    Args:
        folders: the folders of the workspace.
        subject: the description or the folder of the package.
        texts: the texts of the open files.

    Returns:
        The findings, or None if the process has failed.
    """
    spawn = multiprocessing.get_context("spawn")
    receiver, sender = spawn.Pipe(duplex=False)
    process = spawn.Process(target=_send_findings, args=(sender, [*folders], subject, dict(texts)), daemon=True)
    is_cancelled = threading.Event()

    def work() -> tuple[Diagnostic, ...] | None:
        with receiver, sender:
            try:
                process.start()  # This returns when the process has read the texts.
                sender.close()
                findings: tuple[Diagnostic, ...] | None = None if is_cancelled.is_set() else receiver.recv()
            except (EOFError, OSError):
                findings = None
        if process.pid is not None:
            process.kill()
            process.join()
        return findings

    try:
        return await asyncio.to_thread(work)
    finally:
        is_cancelled.set()
        if process.pid is not None:
            process.kill()


def _send_findings(sender: Connection, folders: list[Path], subject: Path, texts: dict[Path, str]) -> None:
    """Send the findings about a subject."""
    workspace = Workspace(folders)
    with redirect_stdout(sys.stderr):  # Standard output carries only the responses of the server.
        workspace.index.refresh()
        sender.send(workspace.check_subject(subject, texts))
    sender.close()
