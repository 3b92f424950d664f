"""Rules about names inside the elements that URDF readers pass on to other programs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, phrase, quoted
from linkwright.diagnostics.misspellings import find_misspelled
from linkwright.lint.extension_names import ATTRIBUTE_NAMES, CHILD_TAGS
from linkwright.lint.fix import rename_attribute, rename_element
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.unknown_names import attribute_name_span
from linkwright.xmltree import Element


class MisspelledExtension(Rule):
    """A misspelled element or attribute inside `<gazebo>`, `<transmission>` or `<ros2_control>`.

    ## Why

    URDF readers pass these elements on to other programs, which ignore unknown content. With a `<command_interfce>`,
    the joint has no command interface that a controller can claim.

    ## Example

    ```xml
    <ros2_control name="arm" type="system">
      <joint name="elbow">
        <command_interfce name="position"/>
    ```

    ## Use instead

    ```xml
        <command_interface name="position"/>
    ```
    """

    code = "LW109"
    name = "misspelled-extension"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every element and attribute in the extensions whose name misspells a known name."""
        for extension in subject.elements():
            if extension.tag not in CHILD_TAGS:
                continue
            pending = [(extension, extension.tag)]
            while pending:
                element, path = pending.pop()
                yield from self._attribute_findings(element, path)
                for child in element.elements():
                    allowed_tags = CHILD_TAGS.get(path)
                    if allowed_tags is None:
                        continue
                    if child.tag not in allowed_tags:
                        yield from self._element_findings(child, element, allowed_tags)
                    pending.append((child, f"{path}/{child.tag}"))

    def _element_findings(self, child: Element, parent: Element, allowed_tags: tuple[str, ...]) -> Iterator[Diagnostic]:
        intended_tag = find_misspelled(child.tag, allowed_tags)
        if intended_tag:
            yield self.report(
                phrase(
                    "no program reads <{tag}> in <{parent_tag}>",
                    tag=child.tag,
                    parent_tag=parent.tag,
                ),
                child,
                hint=phrase("did you mean <{tag}>?", tag=intended_tag),
                fix=rename_element(child, intended_tag, safe=False),
            )

    def _attribute_findings(self, element: Element, path: str) -> Iterator[Diagnostic]:
        allowed = ATTRIBUTE_NAMES.get(path, ())
        for attribute in element.attributes:
            if attribute in allowed:
                continue
            intended = find_misspelled(attribute, [name for name in allowed if name not in element.attributes])
            if intended:
                yield self.report(
                    phrase("'{attribute}' in <{tag}> is not read", attribute=attribute, tag=element.tag),
                    element,
                    span=attribute_name_span(element, attribute),
                    hint=phrase("did you mean {names}?", names=quoted(intended)),
                    fix=rename_attribute(element, attribute, intended, safe=False),
                )
