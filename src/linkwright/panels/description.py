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
    NO_ARGUMENT_FORM,
    ArgumentForm,
    Description,
    DescriptionChanged,
    DescriptionText,
    DiagnosticItem,
    DiagnosticNote,
    Diagnostics,
    InertiaFindings,
    RequestDescription,
    RequestDescriptionText,
    RequestInertia,
    SetArguments,
)
from linkwright.page.protocol.message import ServerMessage, get_tag
from linkwright.page.protocol.robot import RequestProvenance
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.displays.robot_model import RobotModelDisplay
from linkwright.urdf import Robot

if TYPE_CHECKING:
    from linkwright.panels.description_details import SourceTexts
    from linkwright.rviz.visualization.manager import VisualizationManager


OnValues = Callable[[dict[str, str]], object]
"""Called with the values of the arguments by name."""


class ArgumentsFeature(PageFeature):
    """The feature that shows a form for arguments in all pages.

    The values from the first page that answers are used.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (SetArguments,)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._form = NO_ARGUMENT_FORM
        self._on_values: OnValues | None = None

    def opening_messages(self) -> list[ServerMessage]:
        """Return the form, which is empty if no arguments are requested."""
        return [self._form]

    def show_form(self, form: ArgumentForm, on_values: OnValues | None) -> None:
        """Show a form to all pages.

        Args:
            form: the requested arguments.
            on_values: called with the values of the first answer, by name; None if `form` is empty.
        """
        self._form, self._on_values = form, on_values
        self.context.pages.publish(form)

    def receive(self, page: Page, message: SetArguments) -> None:
        """Close the form, and report the values of the requested arguments."""
        on_values, names = self._on_values, set(self._form.names)
        if on_values is not None:
            self.show_form(NO_ARGUMENT_FORM, None)
            on_values({name: value for name, value in message.values.items() if name in names})


Part = TypeVar("Part")


class KnownDescription:
    """The description that a display shows, with methods that may be called in any thread.

    Args:
        display: the ID of the RobotModel display.
        revision: the number of the description, counted for each display.
        robot: the robot.
        text: the text from which the robot was read.
        prefix: the display's TF Prefix.
        files: the known source files of the text.
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
    def details(self) -> Description:
        """The details of the description's links and joints, for pages."""
        from linkwright.panels.description_details import describe

        return describe(
            self.robot,
            self.text,
            self.texts.names,
            display=self.display,
            revision=self.revision,
            prefix=self.prefix,
        )

    def find_changes_since(self, previous: KnownDescription | None) -> DescriptionChanged:
        """Return the names of the links and joints that differ from the previous description.

        The lists are empty if `previous` is None.
        """
        links = _find_changed_names(previous.robot.links, self.robot.links) if previous else []
        joints = _find_changed_names(previous.robot.joints, self.robot.joints) if previous else []
        return DescriptionChanged(self.display, self.revision, links, joints)

    def text_of_file(self, file: str) -> DescriptionText:
        """Return the text of a file of the description, or the expanded text if the name is empty.

        The text is None for a file that does not belong to the description.
        """
        text = self.text if file == "" else self.texts.text(file)
        return DescriptionText(self.display, self.revision, file, text)

    def findings(self, finder: PackageFinder) -> InertiaFindings:
        """Return the findings about implausible masses and inertias.

        The findings are computed in each call, because meshes may have changed.
        """
        from linkwright.panels.description_details import find_implausible_inertias

        return InertiaFindings(self.display, self.revision, find_implausible_inertias(self.robot, finder))


def _find_changed_names(previous: Mapping[str, Part], current: Mapping[str, Part]) -> list[str]:
    """Return the names of new or changed links or joints.

    Source positions are ignored.
    """
    # Links and joints are compared without their elements, which contain the source positions.
    return [name for name, element in current.items() if previous.get(name) != element]


_Request = RequestDescription | RequestDescriptionText | RequestInertia | RequestProvenance


class DescriptionFeature(PageFeature):
    """The feature that answers requests about descriptions in a thread, one at a time.

    If a page repeats a request before it is answered, only the last request is answered.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (
        RequestDescription,
        RequestDescriptionText,
        RequestInertia,
        RequestProvenance,
    )

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._descriptions: dict[str, KnownDescription] = {}
        self._texts_with_findings: dict[str, str] = {}
        self._answer_tasks: dict[tuple[Page, str], asyncio.Task[None]] = {}
        self._answer_lock = asyncio.Lock()

    def on_robot_changed(self) -> None:
        """Send the names of the links and joints that have changed to pages."""
        shown_ids: set[str] = set()
        for manager in self.managers.all():
            for display in manager.robot_models():
                shown_ids.add(display.id)
                previous = self._descriptions.get(display.id)
                description = self._find_current_description(display)
                if description is not None and description is not previous:
                    manager.pages.publish(description.find_changes_since(previous))
        for removed_id in self._descriptions.keys() - shown_ids:
            del self._descriptions[removed_id]

    def on_diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Store the texts that the findings refer to, because the files may change later."""
        self._texts_with_findings = {
            diagnostic.source.name: diagnostic.source.text
            for diagnostic in diagnostics
            if diagnostic.source is not None
        }

    def files(self, page: Page) -> list[str]:
        """Return the files of the descriptions that a page shows, and the files with findings."""
        models = self.managers.of(page).robot_models()
        return [
            *(str(path) for model in models for path in self.context.library.files(model.text)),
            *self._texts_with_findings,
        ]

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the revision of each description that pages can request."""
        descriptions = [self._find_current_description(display) for display in manager.robot_models()]
        return [
            DescriptionChanged(description.display, description.revision, [], [])
            for description in descriptions
            if description is not None
        ]

    def receive(self, page: Page, message: _Request) -> None:
        """Answer a request in the background, and cancel an earlier equal request."""
        file_name = message.file if isinstance(message, RequestDescriptionText) else ""
        key = (page, f"{get_tag(message)} {message.display} {file_name}")
        if key in self._answer_tasks:
            self._answer_tasks[key].cancel()
        task = asyncio.get_running_loop().create_task(self._respond(page, message))
        self._answer_tasks[key] = task
        task.add_done_callback(
            lambda finished_task: self._answer_tasks.pop(key) if self._answer_tasks.get(key) is finished_task else None
        )

    def remove_page(self, page: Page) -> None:
        """Cancel the page's requests."""
        for (requesting_page, _), task in list(self._answer_tasks.items()):
            if requesting_page is page:
                task.cancel()

    def close(self) -> None:
        """Cancel all requests."""
        for task in self._answer_tasks.values():
            task.cancel()

    async def details(self, display: RobotModelDisplay) -> Description | None:
        """Return the details of the description that a display shows, or None if it shows none."""
        description = self._find_current_description(display)
        if description is None:
            return None
        async with self._answer_lock:
            return await asyncio.to_thread(lambda: description.details)

    async def _respond(self, page: Page, request: _Request) -> None:
        robot_models = self.managers.of(page).robot_models()
        display = next((display for display in robot_models if display.id == request.display), None)
        description = None if display is None else self._find_current_description(display)
        texts_with_findings = dict(self._texts_with_findings)

        def create_response() -> ServerMessage | None:
            if isinstance(request, RequestDescriptionText):
                return _make_text_response(description, texts_with_findings, request)
            if description is None:
                return None
            if isinstance(request, RequestDescription):
                return description.details
            if isinstance(request, RequestInertia):
                return description.findings(self.context.finder)
            return display.find_provenance(request.link) if display is not None else None

        async with self._answer_lock:
            response = await asyncio.to_thread(create_response)
        if response is not None:
            page.send(response)

    def _find_current_description(self, display: RobotModelDisplay) -> KnownDescription | None:
        """Return the current description of a display, or None.

        If the description has changed, it has a new revision.
        """
        robot, prefix = display.robot, display.properties.text("TF Prefix")
        description = self._descriptions.get(display.id)
        if robot is None:
            return description
        if description is None or description.robot is not robot or description.prefix != prefix:
            revision = description.revision + 1 if description else 1
            files = self.context.library.files(display.text)
            description = KnownDescription(display.id, revision, robot, display.text, prefix, files)
            self._descriptions[display.id] = description
        return description


def _make_text_response(
    description: KnownDescription | None, texts_with_findings: dict[str, str], request: RequestDescriptionText
) -> DescriptionText:
    """Return the text of a file.

    If the file has findings, this is the text that the findings refer to.
    """
    file = request.file
    if file in texts_with_findings:
        return DescriptionText(
            request.display, description.revision if description else 0, file, texts_with_findings[file]
        )
    if description is None:
        return DescriptionText(request.display, 0, file, None)
    return description.text_of_file(file)


class DiagnosticsFeature(PageFeature):
    """The feature that shows the findings about the description in all pages."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._diagnostics: Sequence[Diagnostic] = ()
        self._shown_diagnostics = Diagnostics([])

    def opening_messages(self) -> list[ServerMessage]:
        """Return the current findings."""
        return [self._shown_diagnostics]

    def on_diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Replace the current findings with new findings.

        The list may be empty.
        """
        self._diagnostics = diagnostics
        self._shown_diagnostics = self._collect_diagnostics()
        self.context.pages.publish(self._shown_diagnostics)

    def on_robot_changed(self) -> None:
        """Show an additional finding (VIEW207) while no visual of a robot can be drawn."""
        shown_findings = self._collect_diagnostics()
        if shown_findings != self._shown_diagnostics:
            self._shown_diagnostics = shown_findings
            self.context.pages.publish(shown_findings)

    def _collect_diagnostics(self) -> Diagnostics:
        models = [model for manager in self.managers.all() for model in manager.robot_models()]
        invisibility_findings = {
            model.text: finding for model in models if (finding := _find_invisibility(model)) is not None
        }
        return Diagnostics(
            [make_item(diagnostic) for diagnostic in (*self._diagnostics, *invisibility_findings.values())]
        )


def _find_invisibility(model: RobotModelDisplay) -> Diagnostic | None:
    """Return the finding VIEW207 if no visual of a robot can be drawn, otherwise None."""
    robot, problems = model.robot, model.file_problems
    if robot is None or not problems or not model.enabled or any(link.visuals for link in model.scene.links):
        return None
    problem_texts = [text for link in robot.links.values() if link.visuals for text in problems.get(link.name, ())]
    if not problem_texts:
        return None
    message = phrase("robot '{name}' is not visible: none of its meshes can be read", name=robot.name)
    hint = phrase(
        "check whether the meshes are in another repository, fetched by the build, or in a package that is not "
        "installed"
    )
    return Diagnostic("VIEW207", message, severity=Severity.WARNING, notes=(Note(problem_texts[0]),), hint=hint)


def make_item(diagnostic: Diagnostic) -> DiagnosticItem:
    """Return a diagnostic in the form for pages, with the source line that it refers to."""
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
