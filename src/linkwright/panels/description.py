"""Descriptions for pages: details, findings, and the form for xacro arguments."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, TypeVar

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.packages import PackageFinder
from linkwright.page.audience import Page
from linkwright.page.protocol.description import (
    NOTHING_ASKED,
    ArgumentForm,
    AskDescription,
    AskDescriptionText,
    AskInertia,
    Description,
    DescriptionChanged,
    DescriptionText,
    DiagnosticItem,
    DiagnosticNote,
    Diagnostics,
    GiveArguments,
    InertiaFindings,
)
from linkwright.page.protocol.message import ServerMessage, tag_of
from linkwright.page.protocol.robot import AskProvenance
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.displays.robot_model import RobotModelDisplay
from linkwright.urdf import Robot

if TYPE_CHECKING:
    from linkwright.panels.description_details import SourceTexts
    from linkwright.rviz.visualization.manager import VisualizationManager


Give = Callable[[dict[str, str]], object]
"""Receives the values that a user gives."""


class ArgumentsFeature(PageFeature):
    """Shows all pages a form for arguments, and passes on the values of the first page that answers."""

    RECEIVES: ClassVar[tuple[type, ...]] = (GiveArguments,)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._form = NOTHING_ASKED
        self._give: Give | None = None

    def opening(self) -> list[ServerMessage]:
        """Return the form, which is empty if no arguments are requested."""
        return [self._form]

    def ask(self, form: ArgumentForm, give: Give | None) -> None:
        """Show a form to all pages.

        Args:
            form: the requested arguments.
            give: called with the values of the first answer, by name; None if `form` is empty.
        """
        self._form, self._give = form, give
        self.context.pages.publish(form)

    def receive(self, page: Page, message: GiveArguments) -> None:
        """Close the form, and pass on the values that a page gives to the requested arguments."""
        give, names = self._give, set(self._form.names)
        if give is not None:
            self.ask(NOTHING_ASKED, None)
            give({name: value for name, value in message.values.items() if name in names})


Part = TypeVar("Part")


class KnownDescription:
    """The description that a display shows. All methods may be called in another thread.

    Args:
        display: the ID of the RobotModel display.
        revision: the number of the description, counted for each display.
        robot: the robot.
        text: the text from which the robot was read.
        prefix: the display's TF Prefix.
        files: the known files from which the text was made.
    """

    def __init__(
        self, display: str, revision: int, robot: Robot, text: str, prefix: str, files: Iterable[Path]
    ) -> None:
        self.display = display
        self.revision = revision
        self.robot = robot
        self.text = text
        self.prefix = prefix
        self._files = tuple(files)

    @cached_property
    def texts(self) -> SourceTexts:
        """The source texts of the description's files."""
        from linkwright.panels.description_details import SourceTexts

        return SourceTexts(self.robot.element, self._files)

    @cached_property
    def account(self) -> Description:
        """The details of the description's links and joints, for pages."""
        from linkwright.panels.description_details import account

        return account(
            self.robot,
            self.text,
            self.texts.names,
            display=self.display,
            revision=self.revision,
            prefix=self.prefix,
        )

    def changes_since(self, before: KnownDescription | None) -> DescriptionChanged:
        """Return the links and joints that differ from those of the previous description.

        The lists are empty if `before` is None.
        """
        links = _changed(before.robot.links, self.robot.links) if before else []
        joints = _changed(before.robot.joints, self.robot.joints) if before else []
        return DescriptionChanged(self.display, self.revision, links, joints)

    def named_text(self, file: str) -> DescriptionText:
        """Return the text of one of the description's files, or the expanded text for an empty name.

        The text is None for a file that does not belong to the description.
        """
        text = self.text if file == "" else self.texts.text(file)
        return DescriptionText(self.display, self.revision, file, text)

    def findings(self, finder: PackageFinder) -> InertiaFindings:
        """Return the findings about implausible masses and inertias.

        They are computed for each call, because meshes may have changed.
        """
        from linkwright.panels.description_details import implausible

        return InertiaFindings(self.display, self.revision, implausible(self.robot, finder))


def _changed(before: Mapping[str, Part], after: Mapping[str, Part]) -> list[str]:
    """Return the names of the links or joints that are new or different, apart from their positions."""
    # Comparing model parts ignores their elements, which have the source positions.
    return [name for name, part in after.items() if before.get(name) != part]


_Question = AskDescription | AskDescriptionText | AskInertia | AskProvenance


class DescriptionFeature(PageFeature):
    """Answers pages' requests about descriptions, one at a time, in a thread.

    If a page repeats a request before it was answered, only the last one is answered.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (AskDescription, AskDescriptionText, AskInertia, AskProvenance)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._known: dict[str, KnownDescription] = {}
        self._faulty: dict[str, str] = {}
        self._answers: dict[tuple[Page, str], asyncio.Task[None]] = {}
        self._thinking = asyncio.Lock()

    def robot_changed(self) -> None:
        """Send pages the names of the links and joints that have changed."""
        shown: set[str] = set()
        for manager in self.managers.all():
            for display in manager.robot_models():
                shown.add(display.id)
                before = self._known.get(display.id)
                known = self._look_at(display)
                if known is not None and known is not before:
                    manager.pages.publish(known.changes_since(before))
        for gone in self._known.keys() - shown:
            del self._known[gone]

    def diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Store the texts that the findings refer to, because the files may change later."""
        self._faulty = {
            diagnostic.source.name: diagnostic.source.text
            for diagnostic in diagnostics
            if diagnostic.source is not None
        }

    def files(self, page: Page) -> list[str]:
        """Return the files of the descriptions that a page shows, and those with findings."""
        models = self.managers.of(page).robot_models()
        return [*(str(path) for model in models for path in self.context.library.files(model.text)), *self._faulty]

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the revision of each description that pages can request."""
        known = [self._look_at(display) for display in manager.robot_models()]
        return [
            DescriptionChanged(known_description.display, known_description.revision, [], [])
            for known_description in known
            if known_description is not None
        ]

    def receive(self, page: Page, message: _Question) -> None:
        """Queue a request."""
        about = message.file if isinstance(message, AskDescriptionText) else ""
        key = (page, f"{tag_of(message)} {message.display} {about}")
        if key in self._answers:
            self._answers[key].cancel()
        task = asyncio.get_running_loop().create_task(self._answer(page, message))
        self._answers[key] = task
        task.add_done_callback(lambda done: self._answers.pop(key) if self._answers.get(key) is done else None)

    def page_closed(self, page: Page) -> None:
        """Cancel the page's requests."""
        for (asking, _), task in list(self._answers.items()):
            if asking is page:
                task.cancel()

    def close(self) -> None:
        """Cancel all requests."""
        for task in self._answers.values():
            task.cancel()

    async def _answer(self, page: Page, question: _Question) -> None:
        seen = self.managers.of(page).robot_models()
        display = next((display for display in seen if display.id == question.display), None)
        known = None if display is None else self._look_at(display)
        faulty = dict(self._faulty)

        def answer() -> ServerMessage | None:
            if isinstance(question, AskDescriptionText):
                return _text(known, faulty, question)
            if known is None:
                return None
            if isinstance(question, AskDescription):
                return known.account
            if isinstance(question, AskInertia):
                return known.findings(self.context.finder)
            return display.provenance(question.link) if display is not None else None

        async with self._thinking:
            reply = await asyncio.to_thread(answer)
        if reply is not None:
            page.send(reply)

    def _look_at(self, display: RobotModelDisplay) -> KnownDescription | None:
        """Return the description that a display shows now, with a new revision if it has changed; or None."""
        robot, prefix = display.robot, display.properties.text("TF Prefix")
        known = self._known.get(display.id)
        if robot is None:
            return known
        if known is None or known.robot is not robot or known.prefix != prefix:
            revision = known.revision + 1 if known else 1
            files = self.context.library.files(display.text)
            known = KnownDescription(display.id, revision, robot, display.text, prefix, files)
            self._known[display.id] = known
        return known


def _text(known: KnownDescription | None, faulty: dict[str, str], question: AskDescriptionText) -> DescriptionText:
    """Return the text of a file; for a file with findings, the text that they refer to."""
    file = question.file
    if file in faulty:
        return DescriptionText(question.display, known.revision if known else 0, file, faulty[file])
    if known is None:
        return DescriptionText(question.display, 0, file, None)
    return known.named_text(file)


class DiagnosticsFeature(PageFeature):
    """Shows every page the findings on the description."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._found: Sequence[Diagnostic] = ()
        self._shown = Diagnostics([])

    def opening(self) -> list[ServerMessage]:
        """Return the current findings."""
        return [self._shown]

    def diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show new findings instead of the current ones; the list may be empty."""
        self._found = diagnostics
        self._shown = self._all()
        self.context.pages.publish(self._shown)

    def robot_changed(self) -> None:
        """Show an additional finding while nothing of a robot can be drawn (VIEW207)."""
        shown = self._all()
        if shown != self._shown:
            self._shown = shown
            self.context.pages.publish(shown)

    def _all(self) -> Diagnostics:
        models = [model for manager in self.managers.all() for model in manager.robot_models()]
        unseen = {model.text: found for model in models if (found := _unseen(model)) is not None}
        return Diagnostics([item_of(diagnostic) for diagnostic in (*self._found, *unseen.values())])


def _unseen(model: RobotModelDisplay) -> Diagnostic | None:
    """Return the finding that no visual of a robot can be drawn (VIEW207); None if some can."""
    robot, problems = model.robot, model.file_problems
    if robot is None or not problems or not model.enabled or any(link.visuals for link in model.scene.links):
        return None
    named = [text for link in robot.links.values() if link.visuals for text in problems.get(link.name, ())]
    if not named:
        return None
    message = phrase("robot '{name}' is not visible: none of its meshes can be read", name=robot.name)
    hint = phrase("are they in another repository, fetched by the build, or in a package that is not installed?")
    return Diagnostic("VIEW207", message, severity=Severity.WARNING, notes=(Note(named[0]),), hint=hint)


def item_of(diagnostic: Diagnostic) -> DiagnosticItem:
    """Return a diagnostic in the page's form, with the source line that it refers to."""
    span, source = diagnostic.span, diagnostic.source
    excerpt = source.line(span.line) if span and source and source.name == span.file else ""
    return DiagnosticItem(
        code=diagnostic.code,
        severity=diagnostic.severity.value,
        message=diagnostic.message,
        file=span.file if span else None,
        line=span.line if span else None,
        column=span.column if span else None,
        end_line=span.end_line if span else None,
        end_column=span.end_column if span else None,
        excerpt=excerpt,
        notes=[
            DiagnosticNote(
                message=note.message,
                file=note.span.file if note.span else None,
                line=note.span.line if note.span else None,
                column=note.span.column if note.span else None,
            )
            for note in diagnostic.notes
        ],
        hints=[diagnostic.hint] if diagnostic.hint else [],
    )
