"""The story of an element of an expansion: where each part was written, by which calls, with which values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from linkwright.diagnostics import Diagnostic, LinkwrightError, Span, did_you_mean
from linkwright.xacro.engine import Expansion, Inputs, expand
from linkwright.xacro.limits import room_for
from linkwright.xacro.observed import ObservedSession, expand_observed
from linkwright.xacro.origin import Frame, frames
from linkwright.xacro.recorder import Moment, Recorder
from linkwright.xacro.references import Value, written_attribute
from linkwright.xmltree import Element, Text

_SHOWN_NAMES = 5


@dataclass(frozen=True, slots=True)
class Call:
    """A macro call or an include on the way to an element.

    Attributes:
        macro: the macro's name, or None for an include.
        span: the tag that calls or includes.
        parameters: the parameters of the call with their values; blocks are left out.
    """

    macro: str | None
    span: Span | None
    parameters: tuple[Value, ...] = ()


@dataclass(frozen=True, slots=True)
class AttributeStory:
    """Where an attribute comes from.

    Attributes:
        name: its name.
        value: its value in the result.
        written: its text in the source, such as ``${prefix}_link``.
        span: the place of that text.
        values: what the text refers to, with the values it had.
        calls: the calls and includes around that place, innermost first; they are others than the element's when
            ``<xacro:attribute>`` has set the attribute.
    """

    name: str
    value: str
    written: str
    span: Span | None
    values: tuple[Value, ...]
    calls: tuple[Call, ...]


@dataclass(frozen=True, slots=True)
class TextStory:
    """Where a text inside an element comes from.

    Attributes:
        value: the text in the result, without the blanks around it.
        written: the text in the source.
        span: its place.
        values: what it refers to, with the values it had.
    """

    value: str
    written: str
    span: Span | None
    values: tuple[Value, ...]


@dataclass(frozen=True, slots=True)
class Story:
    """Where an element of an expansion comes from.

    Attributes:
        element: the element as it is in the result.
        span: where it is written.
        calls: the macro calls and includes that brought it where it is, innermost first.
        attributes: the story of each attribute, in document order.
        texts: the story of each text directly inside, blank ones left out.
        children: the stories of the elements inside.
    """

    element: Element
    span: Span | None
    calls: tuple[Call, ...]
    attributes: tuple[AttributeStory, ...]
    texts: tuple[TextStory, ...]
    children: tuple[Story, ...]

    def walk(self) -> Iterator[Story]:
        """This story and those of all elements inside, in document order."""
        pending = [self]
        while pending:
            story = pending.pop()
            yield story
            pending.extend(reversed(story.children))


def stories(inputs: Inputs, name: str) -> tuple[Story, ...]:
    """The stories of the elements of an expansion that have a name; see `linkwright.xacro.explain`."""
    path, arguments, packages, text, limits, root_dir = inputs
    expansion = expand(path, arguments, packages=packages, text=text, limits=limits, root_dir=root_dir)
    root = expansion.document.root
    named = [element for element in root.elements() if element.attributes.get("name") == name]
    if not named:
        named = [element for element in root.walk() if element.attributes.get("name") == name]
    if not named:
        raise LinkwrightError(_unknown(name, path, root))
    teller = _Teller(inputs, root)
    return tuple(teller.tell(element) for element in named)


def story_of(expansion: Expansion, element: Element) -> Story:
    """The story of an element of an expansion's document; see `Expansion.story`."""
    if expansion.inputs is None:
        raise LinkwrightError(Diagnostic("XAC802", "nothing is known of how this document was expanded"))
    return _Teller(expansion.inputs, expansion.document.root).tell(element)


class _Teller:
    """Expands once more with a recorder, and tells what that has seen.

    Args:
        inputs: what the expansion starts from.
        root: the root of what came out the first time.
    """

    def __init__(self, inputs: Inputs, root: Element) -> None:
        self._inputs = inputs
        self._recorder = Recorder(inputs.arguments)
        session = ObservedSession(inputs)
        self._again = expand_observed(inputs, session, self._recorder.directives, self._recorder.call)
        self._twins: dict[int, Element] = {}
        for ours, theirs in zip(root.walk(), self._again.root.walk(), strict=False):
            if ours.tag != theirs.tag or ours.attributes != theirs.attributes:
                break
            self._twins[id(ours)] = theirs

    def tell(self, element: Element) -> Story:
        """The story of an element of what came out the first time.

        Raises:
            LinkwrightError: XAC802 when something else came out now.
        """
        with room_for(self._inputs.limits):
            return self._tell(element)

    def _tell(self, element: Element) -> Story:
        twin = self._twins.get(id(element))
        if twin is None:
            message = f"the element '{element.tag}' is not what '{self._inputs.name}' expands to"
            hint = "the file has changed; expand it again"
            raise LinkwrightError(Diagnostic("XAC802", message, element.span(), hint=hint, source=element.source))
        moment = self._recorder.moment(twin) or Moment(element, None)
        calls = self._calls(moment.frame)
        return Story(
            element=element,
            span=element.span(),
            calls=calls,
            attributes=tuple(self._attribute(twin, name, moment, calls) for name in element.attributes),
            texts=tuple(_texts(element, moment)),
            children=tuple(self._tell(child) for child in element.elements()),
        )

    def _attribute(self, element: Element, name: str, moment: Moment, calls: tuple[Call, ...]) -> AttributeStory:
        value = element.attributes[name]
        setting = self._recorder.setting(element, name)
        node, attribute = (setting.node, "value") if setting else (moment.node, name)
        written = written_attribute(node, attribute)
        return AttributeStory(
            name=name,
            value=value,
            written=value if written is None else written,
            span=node.attribute_span(attribute),
            values=setting.values if setting else moment.values.get(name, ()),
            calls=self._calls(setting.frame) if setting else calls,
        )

    def _calls(self, frame: Frame | None) -> tuple[Call, ...]:
        return tuple(Call(each.macro, each.site.span(), self._recorder.parameters(each)) for each in frames(frame))


def _texts(element: Element, moment: Moment) -> Iterator[TextStory]:
    evaluated = {_where(text): (text, values) for text, values in moment.texts}
    for child in element.children:
        if isinstance(child, Text) and not child.data.isspace() and child.data:
            text, values = evaluated.get(_where(child), (child, ()))
            start = text.offset + len(text.data) - len(text.data.lstrip())
            span = text.source.span(start, start + len(text.data.strip())) if text.source else None
            yield TextStory(child.data.strip(), text.data.strip(), span, values)


def _where(text: Text) -> tuple[str, int]:
    return (text.source.name if text.source else "", text.offset)


def _unknown(name: str, file: str, root: Element) -> Diagnostic:
    known = {
        element.attributes["name"]: None
        for element in root.elements()
        if element.tag in ("link", "joint") and "name" in element.attributes
    }
    hint = did_you_mean(name, known)
    if hint is None and known:
        hint = f"there are {len(known)} links and joints, such as {', '.join(list(known)[:_SHOWN_NAMES])}"
    elif hint is None:
        hint = "the file has neither links nor joints"
    return Diagnostic("XAC801", f"'{file}' expands to no link or joint named '{name}'", hint=hint)
