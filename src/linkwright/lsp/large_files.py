"""Checks of large files in a separate process, so that other requests do not wait for them."""

from __future__ import annotations

import asyncio
import multiprocessing
from collections.abc import Iterable, Mapping
from multiprocessing.connection import Connection
from pathlib import Path

from linkwright.diagnostics import Diagnostic
from linkwright.language.workspace import Workspace


async def findings_of_process(
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
    process = spawn.Process(target=_check, args=(sender, [*folders], subject, dict(texts)), daemon=True)
    try:
        await asyncio.to_thread(process.start)
        sender.close()
        found: tuple[Diagnostic, ...] = await asyncio.to_thread(receiver.recv)
    except EOFError:
        return None
    else:
        return found
    finally:
        if process.pid is not None:
            process.kill()


def _check(sender: Connection, folders: list[Path], subject: Path, texts: dict[Path, str]) -> None:
    """Send the findings about a subject."""
    project = Workspace(folders)
    project.index.refresh()
    sender.send(project.checked(subject, texts))
    sender.close()
