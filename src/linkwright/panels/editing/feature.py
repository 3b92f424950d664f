"""Edit a robot in the page: previews of the smallest text change, and writing.

All pages share one history. Requests are handled one after the other in a thread, because an edit is verified by
expanding the description again.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from linkwright.descriptions import Description
from linkwright.descriptions.editing import EditHistory, EditPlan, EditRefusedError, Workspace, plan_edit, read_again
from linkwright.descriptions.unsaved import UnsavedText
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.page.audience import Page
from linkwright.page.protocol import editing
from linkwright.page.protocol.message import PageMessage
from linkwright.panels.description import make_item
from linkwright.panels.editing.parts import find_parts, make_edit_request, make_edited_files
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.urdf import Robot

_AXIS_NAMES = "xyz"


class EditingFeature(PageFeature):
    """The feature that previews edits of the robot, and writes edits to the files.

    The feature also sends the editable parts to pages.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._history = EditHistory()
        self._writing = asyncio.Lock()
        self._previewed_plans: dict[Page, tuple[int, EditPlan]] = {}
        self._newest_numbers: dict[Page, int] = {}
        self._editing_pages: set[Page] = set()
        self._waiting: asyncio.Queue[tuple[Page, PageMessage]] = asyncio.Queue()
        self._worker: asyncio.Task[None] | None = None

    def receive(self, page: Page, message: Any) -> None:
        """Queue a request.

        Requests are handled in order.
        """
        if isinstance(message, editing.PreviewEdit):
            self._newest_numbers[page] = message.number
        self._editing_pages.add(page)
        self._waiting.put_nowait((page, message))
        if self._worker is None:
            self._worker = asyncio.get_running_loop().create_task(self._work())

    def remove_page(self, page: Page) -> None:
        """Discard the preview of a page."""
        self._editing_pages.discard(page)
        self._previewed_plans.pop(page, None)
        self._newest_numbers.pop(page, None)

    def close(self) -> None:
        """Stop handling requests."""
        if self._worker is not None:
            self._worker.cancel()

    async def _work(self) -> None:
        while True:
            page, message = await self._waiting.get()
            try:
                await self._handle_request(page, message)
            except (EditRefusedError, LinkwrightError) as error:
                diagnostic = error.diagnostic if isinstance(error, EditRefusedError) else error.diagnostics[0]
                self._refuse(page, message, diagnostic)
            except Exception as error:  # noqa: BLE001  # editing must continue after an error of this program
                self.context.node.get_logger().error(f"The robot cannot be edited: {type(error).__name__}: {error}")
                self._refuse(page, message, Diagnostic("EDIT105", Phrase(f"{type(error).__name__}: {error}")))

    async def _handle_request(self, page: Page, message: PageMessage) -> None:
        if isinstance(message, editing.RequestEditableParts):
            page.send(self._find_editable_parts(page, message))
            page.send(editing.EditHistory(self._history.can_undo, self._history.can_redo))
            return
        if not page.is_local:
            raise EditRefusedError(make_other_machine_finding())
        if isinstance(message, editing.PreviewEdit):
            if self._newest_numbers.get(page) == message.number:
                await self._preview(page, message)
            return
        history = self._history
        if isinstance(message, editing.ApplyEdit):
            number, plan = self._previewed_plans.pop(page, (-1, EditPlan({}, {})))
            if number != message.number:
                raise EditRefusedError(
                    Diagnostic("EDIT101", phrase("this edit cannot be applied, because it was not previewed"))
                )
            unsaved = self.context.library.unsaved.texts
            if any(path in unsaved for path in plan.texts):
                _edit_unsaved(plan, unsaved)
                page.send(editing.EditWritten(list(plan.texts), None, is_saved=False))
                return
            files = await self.write(plan)
        else:
            async with self._writing:
                undone = history.undo if isinstance(message, editing.UndoEdit) else history.redo
                files = await asyncio.to_thread(undone)
        page.send(editing.EditWritten(files, None, is_saved=True))
        self._send_history()

    async def write(self, plan: EditPlan) -> list[str]:
        """Write the files of an edit, and return their paths.

        The edit can then be undone.

        Raises:
            EditRefusedError: see `EditHistory.apply`.
        """
        async with self._writing:
            files = await asyncio.to_thread(self._history.apply, plan)
        self._send_history()
        return files

    def _send_history(self) -> None:
        for page in self._editing_pages:
            page.send(editing.EditHistory(self._history.can_undo, self._history.can_redo))

    async def _preview(self, page: Page, message: editing.PreviewEdit) -> None:
        robot, description = self._find_robot_and_description(page, message.display)
        refusal_reason = _find_refusal_reason(robot, description)
        if description is None or refusal_reason is not None:
            raise EditRefusedError(Diagnostic("EDIT101", refusal_reason or phrase("there is no robot")))
        for values in (message.xyz, message.rpy):
            if values is not None and len(values) != len(_AXIS_NAMES):
                raise EditRefusedError(Diagnostic("EDIT102", phrase("xyz and rpy must have three numbers each")))
        plan = await asyncio.to_thread(_plan_request, description, message, self.context.library.unsaved_texts)
        self._previewed_plans[page] = message.number, plan
        page.send(editing.EditPreview(message.number, make_edited_files(plan), list(plan.side_effects), None))

    def _find_editable_parts(self, page: Page, message: editing.RequestEditableParts) -> editing.EditableParts:
        robot, description = self._find_robot_and_description(page, message.display)
        refusal_reason = (
            _find_refusal_reason(robot, description) if page.is_local else make_other_machine_finding().message
        )
        parts = [] if robot is None else find_parts(robot, message.link)
        problem = "" if refusal_reason is None else make_item(Diagnostic("EDIT101", refusal_reason)).message
        return editing.EditableParts(message.display, message.link, problem, parts)

    def _find_robot_and_description(self, page: Page, display: str) -> tuple[Robot | None, Description | None]:
        """Return the robot of a display, and its description if the library stores the same text."""
        display_model = next(
            (candidate for candidate in self.managers.of(page).robot_models() if candidate.id == display), None
        )
        if display_model is None or display_model.robot is None:
            return None, None
        description = self.context.library.description(display_model.text)
        return (
            display_model.robot,
            description if description is not None and description.text == display_model.text else None,
        )

    def _refuse(self, page: Page, message: PageMessage, diagnostic: Diagnostic) -> None:
        if isinstance(message, editing.PreviewEdit):
            self._previewed_plans.pop(page, None)
            page.send(editing.EditPreview(message.number, [], [], make_item(diagnostic)))
        else:
            page.send(editing.EditWritten([], make_item(diagnostic), is_saved=False))


def _plan_request(
    description: Description, message: editing.PreviewEdit, unsaved: Mapping[str | os.PathLike[str], str]
) -> EditPlan:
    """Return the plan of an edit of the files' current content or unsaved texts."""
    return plan_edit(
        read_again(description, unsaved), make_edit_request(message), Workspace(Path(description.name)).refusal
    )


def _find_refusal_reason(robot: Robot | None, description: Description | None) -> Phrase | None:
    if robot is None:
        return phrase("there is no robot")
    if description is not None and description.document.root.tag == "sdf":
        return phrase(
            "this robot is described in SDF, but only URDF and xacro can be edited: run `linkwright "
            "convert FILE --to urdf`"
        )
    if description is None or description.name.startswith("<"):
        return phrase(
            "this description was received as text, so its file is unknown: open it with `linkwright view FILE`"
        )
    return None


def _edit_unsaved(plan: EditPlan, unsaved: Mapping[str, UnsavedText]) -> None:
    """Send an edit to the editor that has unsaved texts of the edited files.

    Files without an unsaved text are also edited there.
    """
    owner = next(unsaved[path].owner for path in plan.texts if path in unsaved)
    for path, text in plan.texts.items():
        own_text = unsaved.get(path)
        if own_text is None:
            owner.edit(path, 0, text)
        else:
            own_text.owner.edit(own_text.path, own_text.revision, text)


def make_other_machine_finding() -> Diagnostic:
    """Return the finding that a page on another machine may not write files (EDIT109)."""
    message = phrase("files can be edited only in pages that are open on the machine with the files")
    return Diagnostic("EDIT109", message, hint=phrase("open the page on that machine, or through an SSH tunnel"))
