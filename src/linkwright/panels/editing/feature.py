"""Editing of a robot in the page: previews of minimal text changes, which are written on request.

All pages share one history. Requests are handled one after the other in a thread, because an edit is verified by
expanding the description again.
"""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

from linkwright.descriptions import Description
from linkwright.descriptions.editing import EditHistory, EditPlan, EditRefusedError, Workspace, plan_edit, read_again
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.page.audience import Page
from linkwright.page.protocol import editing
from linkwright.page.protocol.message import PageMessage
from linkwright.panels.description import item_of
from linkwright.panels.editing.parts import files_of, parts_of, request_of
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.urdf import Robot

_AXES = "xyz"


class EditingFeature(PageFeature):
    """Sends pages the editable parts, previews edits, and writes them."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._history = EditHistory()
        self._writing = asyncio.Lock()
        self._plans: dict[Page, tuple[int, EditPlan]] = {}
        self._newest: dict[Page, int] = {}
        self._watching: set[Page] = set()
        self._waiting: asyncio.Queue[tuple[Page, PageMessage]] = asyncio.Queue()
        self._worker: asyncio.Task[None] | None = None

    def receive(self, page: Page, message: Any) -> None:
        """Queue a request; requests are handled in order."""
        if isinstance(message, editing.PreviewEdit):
            self._newest[page] = message.number
        self._watching.add(page)
        self._waiting.put_nowait((page, message))
        if self._worker is None:
            self._worker = asyncio.get_running_loop().create_task(self._work())

    def page_closed(self, page: Page) -> None:
        """Discard the preview of a page."""
        self._watching.discard(page)
        self._plans.pop(page, None)
        self._newest.pop(page, None)

    def close(self) -> None:
        """Stop handling requests."""
        if self._worker is not None:
            self._worker.cancel()

    async def _work(self) -> None:
        while True:
            page, message = await self._waiting.get()
            try:
                await self._do(page, message)
            except (EditRefusedError, LinkwrightError) as error:
                found = error.diagnostic if isinstance(error, EditRefusedError) else error.diagnostics[0]
                self._refuse(page, message, found)
            except Exception as error:  # noqa: BLE001  # editing must continue after an error of this program
                self.context.node.get_logger().error(f"The robot cannot be edited: {type(error).__name__}: {error}")
                self._refuse(page, message, Diagnostic("EDIT105", Phrase(f"{type(error).__name__}: {error}")))

    async def _do(self, page: Page, message: PageMessage) -> None:
        if isinstance(message, editing.AskEditableParts):
            page.send(self._parts(page, message))
            page.send(editing.EditHistory(self._history.can_undo, self._history.can_redo))
            return
        if not page.is_here:
            raise EditRefusedError(elsewhere())
        if isinstance(message, editing.PreviewEdit):
            if self._newest.get(page) == message.number:
                await self._preview(page, message)
            return
        history = self._history
        if isinstance(message, editing.ApplyEdit):
            number, plan = self._plans.pop(page, (-1, EditPlan({}, {})))
            if number != message.number:
                raise EditRefusedError(
                    Diagnostic("EDIT101", phrase("this edit was not previewed before it was applied"))
                )
            files = await self.write(plan)
        else:
            async with self._writing:
                undone = history.undo if isinstance(message, editing.UndoEdit) else history.redo
                files = await asyncio.to_thread(undone)
        page.send(editing.EditWritten(files, None))
        self._send_history()

    async def write(self, plan: EditPlan) -> list[str]:
        """Write the files of an edit, which can then be undone, and return their paths.

        Raises:
            EditRefusedError: see `EditHistory.apply`.
        """
        async with self._writing:
            files = await asyncio.to_thread(self._history.apply, plan)
        self._send_history()
        return files

    def _send_history(self) -> None:
        for page in self._watching:
            page.send(editing.EditHistory(self._history.can_undo, self._history.can_redo))

    async def _preview(self, page: Page, message: editing.PreviewEdit) -> None:
        robot, known = self._known_robot(page, message.display)
        why_not = _refusal_reason(robot, known)
        if known is None or why_not is not None:
            raise EditRefusedError(Diagnostic("EDIT101", why_not or phrase("there is no robot")))
        for given in (message.xyz, message.rpy):
            if given is not None and len(given) != len(_AXES):
                raise EditRefusedError(
                    Diagnostic("EDIT102", phrase("these numbers are not finite, or too large for a robot"))
                )
        plan = await asyncio.to_thread(_planned, known, message)
        self._plans[page] = message.number, plan
        page.send(editing.EditPreview(message.number, files_of(plan), list(plan.also), None))

    def _parts(self, page: Page, message: editing.AskEditableParts) -> editing.EditableParts:
        robot, known = self._known_robot(page, message.display)
        why_not = _refusal_reason(robot, known) if page.is_here else elsewhere().message
        parts = [] if robot is None else parts_of(robot, message.link)
        problem = "" if why_not is None else item_of(Diagnostic("EDIT101", why_not)).message
        return editing.EditableParts(message.display, message.link, problem, parts)

    def _known_robot(self, page: Page, display: str) -> tuple[Robot | None, Description | None]:
        """Return the robot of a display, and its description if that was read from a file of this machine."""
        found = next(
            (robot_model for robot_model in self.managers.of(page).robot_models() if robot_model.id == display), None
        )
        if found is None or found.robot is None:
            return None, None
        known = self.context.library.description(found.text)
        return found.robot, known if known is not None and known.text == found.text else None

    def _refuse(self, page: Page, message: PageMessage, why: Diagnostic) -> None:
        if isinstance(message, editing.PreviewEdit):
            self._plans.pop(page, None)
            page.send(editing.EditPreview(message.number, [], [], item_of(why)))
        else:
            page.send(editing.EditWritten([], item_of(why)))


def _planned(known: Description, message: editing.PreviewEdit) -> EditPlan:
    """Return the plan of an edit for the current files."""
    return plan_edit(read_again(known), request_of(message), Workspace(Path(known.name)).refusal)


def _refusal_reason(robot: Robot | None, known: Description | None) -> Phrase | None:
    if robot is None:
        return phrase("there is no robot")
    if known is not None and known.document.root.tag == "sdf":
        return phrase(
            "this robot is described in SDF, but only URDF and xacro can be edited: run `linkwright "
            "convert FILE --to urdf`"
        )
    if known is None or known.name.startswith("<"):
        return phrase(
            "this description was received as text, so its file is unknown: open it with `linkwright view FILE`"
        )
    return None


def elsewhere() -> Diagnostic:
    """Return the finding that a page on another machine may not write files (EDIT109)."""
    message = phrase("files are written only from pages that are open on the machine with the files")
    return Diagnostic("EDIT109", message, hint=phrase("open the page there, or through an SSH tunnel"))
