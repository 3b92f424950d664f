"""Rules about names inside the elements that URDF readers pass on to other programs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, phrase, quoted
from linkwright.diagnostics.misspellings import misspelling_of
from linkwright.lint.extension_names import ATTRIBUTES, CHILDREN
from linkwright.lint.fix import rename_attribute, rename_element
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.unread import attribute_name_span
from linkwright.xmltree import Element


class MisspeltExtension(Rule):
    """A misspelt element or attribute inside `<gazebo>`, `<transmission>` or `<ros2_control>`.

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
    name = "misspelt-extension"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every element and attribute in the extensions whose name misspells a known one."""
        for top in subject.elements():
            if top.tag not in CHILDREN:
                continue
            waiting = [(top, top.tag)]
            while waiting:
                element, path = waiting.pop()
                yield from self._attributes(element, path)
                for child in element.elements():
                    known = CHILDREN.get(path)
                    if known is None:
                        continue
                    if child.tag not in known:
                        yield from self._element(child, element, known)
                    waiting.append((child, f"{path}/{child.tag}"))

    def _element(self, child: Element, parent: Element, known: tuple[str, ...]) -> Iterator[Diagnostic]:
        near = misspelling_of(child.tag, known)
        if near:
            yield self.report(
                phrase(
                    "no program reads <{tag}> in <{parent_tag}>",
                    tag=child.tag,
                    parent_tag=parent.tag,
                ),
                child,
                hint=phrase("did you mean <{tag}>?", tag=near),
                fix=rename_element(child, near, safe=False),
            )

    def _attributes(self, element: Element, path: str) -> Iterator[Diagnostic]:
        known = ATTRIBUTES.get(path, ())
        for attribute in element.attributes:
            if attribute in known:
                continue
            near = misspelling_of(attribute, [name for name in known if name not in element.attributes])
            if near:
                yield self.report(
                    phrase("'{attribute}' in <{tag}> is not read", attribute=attribute, tag=element.tag),
                    element,
                    span=attribute_name_span(element, attribute),
                    hint=phrase("did you mean {names}?", names=quoted(near)),
                    fix=rename_attribute(element, attribute, near, safe=False),
                )
