"""Plans: the steps of expanding an element, worked out once for each element that was read.

Most of a description does not depend on anything: an element without a dollar sign and without tags of the language
comes out as it is, with all that it holds. Its plan says so, and the walk copies it. Of any other element the plan
lists the attributes to evaluate and, in reading order, what to do with its children; neighbours that come out as they
are make one step.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from linkwright.xacro.limits import LONG
from linkwright.xmltree import Comment, Element, Node, Text

PREFIX = "xacro:"
_DECLARATION = "xmlns:xacro"
_EVALUATE_COMMENTS = "xacro:eval-comments"
_EVALUATE_COMMENTS_OFF = "xacro:eval-comments:off"
_DEEPEST = 100
"""How deep a plan looks ahead; elements further down are planned when they are reached."""

KEEP, ELEMENT, TAG, TEXT, COMMENT, SWITCH = range(6)
"""What a step does: keep nodes as they are, expand an element, expand a tag of the language, evaluate a text, evaluate
a comment if comments are being evaluated, begin or end evaluating them."""

Step: TypeAlias = tuple[int, Any, bool]


class Plan:
    """The plan of one element.

    Attributes:
        attributes: those that come out, as they are written.
        evaluated: the names of those that are to be evaluated or counted.
        steps: for the children, in order: what to do, with what, and a flag: for TAG whether anything stands below it,
            for SWITCH whether comments are to be evaluated from here.
        size: how many elements it is with all inside if it comes out as it is, else 0.
        height: how deep they nest.
    """

    __slots__ = ("attributes", "evaluated", "height", "size", "steps")

    def __init__(self, node: Element, depth: int = 0) -> None:
        self.attributes = node.attributes
        self.evaluated: list[str] = []
        self.size = self.height = 1
        self.steps: list[Step] = []
        if node.attributes:
            self._plan_attributes(node.attributes)
        if node.children:
            self._plan_children(node.children, depth)

    def _plan_attributes(self, attributes: dict[str, str]) -> None:
        for name, value in attributes.items():
            if "x" in name and (name == _DECLARATION or name.startswith(PREFIX)):
                self.size = 0
            elif "$" in value or len(value) > LONG:
                self.evaluated.append(name)
                self.size = 0
        if not self.size:
            self.attributes = {
                name: value
                for name, value in attributes.items()
                if not ("x" in name and (name == _DECLARATION or name.startswith(PREFIX)))
            }

    def _plan_children(self, children: list[Node], depth: int) -> None:
        last = len(children) - 1
        size, height = self.size, 0
        steps = self.steps
        kept: list[Node] = []
        switched = False
        for index, node in enumerate(children):
            if isinstance(node, Text):
                data = node.data
                if "$" not in data and len(data) <= LONG:
                    kept.append(node)
                    if not switched or node.cdata or not data or data.isspace():
                        continue
                    step: Step = (SWITCH, None, False)
                else:
                    step = (TEXT, node, False)
            elif isinstance(node, Element):
                if node.tag.startswith(PREFIX):
                    step = (TAG, node, index < last)
                    size = 0
                else:
                    step = (ELEMENT, node, False)
                    inner = node.plan
                    if inner is None and depth < _DEEPEST:
                        inner = node.plan = Plan(node, depth + 1)
                    if not isinstance(inner, Plan) or not inner.size:
                        size = 0
                    elif size:
                        size += inner.size
                        height = max(height, inner.height)
            elif switched and isinstance(node, Comment) and _EVALUATE_COMMENTS not in node.data:
                step = (COMMENT, node, False)
            elif isinstance(node, Comment) and _EVALUATE_COMMENTS in node.data:
                switched = True
                step = (SWITCH, None, _EVALUATE_COMMENTS_OFF not in node.data)
            else:
                kept.append(node)
                continue
            if kept:
                steps.append((KEEP, kept, False))
                kept = []
            steps.append(step)
            if step[0] in (TEXT, SWITCH, COMMENT):
                size = 0
            elif switched:
                steps.append((SWITCH, None, False))
        if kept:
            steps.append((KEEP, kept, False))
        self.size, self.height = size, height + 1


def plan_of(node: Element) -> Plan:
    """The plan of an element."""
    plan = node.plan
    if not isinstance(plan, Plan):
        plan = node.plan = Plan(node)
    return plan


def copy_of(node: Element, origin: object) -> Element:
    """A copy of an element that comes out as it is, with all inside; texts and comments are shared."""
    made = Element(node.tag, node.attributes.copy(), node.source, node.offset, origin)
    made.plan = node.plan
    if node.children:
        made.children = [copy_of(child, origin) if isinstance(child, Element) else child for child in node.children]
    return made
