"""Plans: the steps that expand an element, computed once for each source element.

Most of a description does not depend on values: an element without a dollar sign and without xacro tags is unchanged,
including its content. The plan of such an element marks it as unchanged, and the walk copies it. For any other
element, the plan lists the attributes to evaluate and the steps for its children in document order. Adjacent
unchanged nodes form one step.

If the text of an element has no dollar sign and no xacro prefix, the element is unchanged and is not searched.
"""

from __future__ import annotations

from linkwright.loading.lean_typing import Any, TypeAlias
from linkwright.xacro.limits import LONG
from linkwright.xmltree import Comment, Document, Element, Node, Text
from linkwright.xmltree.nodes import CachedText

PREFIX = "xacro:"
_DECLARATION = "xmlns:xacro"
_EVALUATE_COMMENTS = "xacro:eval-comments"
_EVALUATE_COMMENTS_OFF = "xacro:eval-comments:off"
_DEEPEST = 100
"""How deep a plan looks ahead; elements further down are planned when they are reached."""
_UNKNOWN = -1
_SIGNS = ("$", PREFIX, _DECLARATION, "&", "<!", "<?")
"""Signs in the text of an element that may change; the text of one that stays as it is may have some, too."""

KEEP, COPY, ELEMENT, TAG, TEXT, COMMENT, SWITCH = range(7)
"""Kinds of steps: keep nodes as they are, copy elements and keep the nodes between them, expand an element, expand a
tag of the language, evaluate a text, evaluate a comment if comments are being evaluated, begin or end evaluating
them."""

Step: TypeAlias = tuple[int, Any, bool]


class Run:
    """Adjacent nodes that the expansion leaves unchanged.

    Attributes:
        nodes: the elements, with the texts and comments between them.
        size: the number of elements for which the nodes count.
        height: the maximum nesting depth of the elements.
    """

    __slots__ = ("height", "nodes", "size")

    def __init__(self, nodes: list[Node], size: int, height: int) -> None:
        self.nodes = nodes
        self.size = size
        self.height = height


class Plan(CachedText):
    """The plan of one element.

    Attributes:
        attributes: the attributes of the result, with their unevaluated values.
        evaluated: the names of the attributes to be evaluated or counted.
        size: the number of elements in an unchanged element, including itself, else 0.
        height: the maximum nesting depth.
        steps: the steps for the children, in order, each with its kind, its object and a flag. For TAG, the flag is
            whether any node follows; for SWITCH, whether comments must be evaluated from here. None before the first
            request; see `steps_of`.
    """

    __slots__ = ("attributes", "evaluated", "height", "size", "steps")

    def __init__(self, attributes: dict[str, str], size: int = 1) -> None:
        self.written = None
        self.attributes = attributes
        self.evaluated: list[str] = []
        self.size = self.height = size
        self.steps: list[Step] | None = None


def plan_document(document: Document) -> None:
    """Record where the root of a document ends, so that its plan can be derived from its text.

    Documents with a document type declaration, or created by a program, are skipped.
    """
    root = document.root
    if root.plan is None and document.doctype is None and document.source is not None:
        root.plan = len(document.source.text)


def plan_of(node: Element) -> Plan:
    """Return the plan of an element, which is computed on first use."""
    plan = node.plan
    if not isinstance(plan, Plan):
        plan = node.plan = _compute_plan(node, plan if isinstance(plan, int) else _UNKNOWN, 0)
    return plan


def steps_of(node: Element) -> list[Step]:
    """Return the steps for the children of an element, which are computed on first use."""
    plan = plan_of(node)
    if plan.steps is None:
        plan.steps = _Children(node.children, _UNKNOWN, 0).steps
    return plan.steps


def _compute_plan(node: Element, end: int, depth: int) -> Plan:
    """Return a new plan of an element; `end` is the offset after its text, if known."""
    plan = Plan(node.attributes)
    children = _Children(node.children, end, depth)
    plan.steps = children.steps
    plan.height = children.height + 1
    plan.size = children.size + 1 if children.come_out else 0
    if node.attributes:
        _plan_attributes(plan, node.attributes)
    return plan


def _plan_attributes(plan: Plan, attributes: dict[str, str]) -> None:
    foreign = True
    for name, value in attributes.items():
        if "x" in name and (name == _DECLARATION or name.startswith(PREFIX)):
            foreign = False
        elif "$" in value or len(value) > LONG:
            plan.evaluated.append(name)
    if plan.evaluated or not foreign:
        plan.size = 0
    if not foreign:
        plan.attributes = {
            name: value
            for name, value in attributes.items()
            if not ("x" in name and (name == _DECLARATION or name.startswith(PREFIX)))
        }


class _Children:
    """A builder of the steps for the children of an element.

    Attributes:
        steps: the steps.
        come_out: whether all children are unchanged.
        size: the total number of elements in unchanged children.
        height: the maximum nesting depth of the children.
    """

    def __init__(self, children: list[Node], end: int, depth: int) -> None:
        self.steps: list[Step] = []
        self.come_out = True
        self.size = self.height = 0
        self._kept: list[Node] = []  # the unchanged nodes since the last step
        self._since_element = 0  # the number of these nodes after the last element
        self._run_size = self._run_height = 0
        self._plan(children, end, depth)

    def _plan(self, children: list[Node], end: int, depth: int) -> None:
        last = len(children) - 1
        kept = self._kept
        switched = False
        for index, node in enumerate(children):
            step: Step
            if isinstance(node, Text):
                data = node.data
                if "$" not in data and len(data) <= LONG:
                    kept.append(node)
                    self._since_element += 1
                    if not switched or node.cdata or not data or data.isspace():
                        continue
                    step = (SWITCH, None, False)
                else:
                    step = (TEXT, node, False)
            elif isinstance(node, Element):
                stop = end if index == last or end < 0 else children[index + 1].offset
                if node.tag.startswith(PREFIX):
                    if node.plan is None and stop >= 0:
                        node.plan = stop
                    step = (TAG, node, index < last)
                    self.come_out = False
                else:
                    inner = _inner_plan(node, stop, depth)
                    if inner is not None and inner.size:
                        self.size += inner.size
                        self.height = max(self.height, inner.height)
                        if not switched:
                            self._add_to_run(node, inner)
                            continue
                    else:
                        self.come_out = False
                    step = (ELEMENT, node, False)
            elif switched and isinstance(node, Comment) and _EVALUATE_COMMENTS not in node.data:
                step = (COMMENT, node, False)
            elif isinstance(node, Comment) and _EVALUATE_COMMENTS in node.data:
                switched = True
                step = (SWITCH, None, _EVALUATE_COMMENTS_OFF not in node.data)
            else:
                kept.append(node)
                self._since_element += 1
                continue
            self._end_run()
            kept = self._kept
            self.steps.append(step)
            if step[0] in (TEXT, SWITCH, COMMENT):
                self.come_out = False
            elif switched:
                self.steps.append((SWITCH, None, False))
        self._end_run()

    def _add_to_run(self, node: Element, inner: Plan) -> None:
        self._run_size += inner.size + (self._since_element >> 3)
        self._run_height = max(self._run_height, inner.height)
        self._since_element = 0
        self._kept.append(node)

    def _end_run(self) -> None:
        if self._run_size:
            run = Run(self._kept, self._run_size + (self._since_element >> 3), self._run_height)
            self.steps.append((COPY, run, False))
        elif self._kept:
            self.steps.append((KEEP, self._kept, False))
        if self._kept:
            self._kept = []
        self._since_element = self._run_size = self._run_height = 0


def _inner_plan(node: Element, stop: int, depth: int) -> Plan | None:
    """Return the plan of an ordinary child, or None if it is nested too deeply for now.

    `stop` is the offset after the text of the child.
    """
    inner = node.plan
    if isinstance(inner, Plan):
        return inner
    source = node.source
    if inner is None and source is not None and stop >= 0:
        size = _size_of_plain(source.text[node.offset : stop])
        if size:
            node.plan = inner = Plan(node.attributes, size)
            return inner
        if depth >= _DEEPEST:
            node.plan = stop
    if depth >= _DEEPEST:
        return None
    node.plan = inner = _compute_plan(node, stop, depth + 1)
    return inner


def _size_of_plain(text: str) -> int:
    """Return the number of elements in the text of an unchanged element, or 0 if it may change.

    The result is also 0 for a text with character references or comments, and for a text long enough to be charged.
    """
    if any(sign in text for sign in _SIGNS):
        return 0
    pieces = text.split("<")
    if len(text) > LONG and max(map(len, pieces)) > LONG:
        return 0
    return len(pieces) - 1 - text.count("</")
