"""Plans: the steps that expand an element, computed once for each source element.

Most of a description does not depend on values: an element without a dollar sign and without xacro tags is unchanged,
including its content. The plan of such an element marks it as unchanged, and the walk copies it. For any other
element, the plan lists the attributes to evaluate and the steps for its children in document order. Adjacent
unchanged nodes form one step.

If the text of an element has no dollar sign and no xacro prefix, the element is unchanged and is not searched.
"""

from __future__ import annotations

from linkwright.loading.lean_typing import Any, TypeAlias
from linkwright.xacro.limits import LONG_TEXT_LENGTH
from linkwright.xmltree import Comment, Document, Element, Node, Text
from linkwright.xmltree.nodes import CachedText

PREFIX = "xacro:"
_DECLARATION = "xmlns:xacro"
_EVALUATE_COMMENTS = "xacro:eval-comments"
_EVALUATE_COMMENTS_OFF = "xacro:eval-comments:off"
_MAX_LOOKAHEAD_DEPTH = 100
"""The number of nesting levels that a plan covers. Deeper elements are planned when the walk reaches them."""
_UNKNOWN_OFFSET = -1
_CHANGE_MARKERS = ("$", PREFIX, _DECLARATION, "&", "<!", "<?")
"""Strings of which any element that may change contains at least one. An unchanged element may also contain them."""

KEEP, COPY, ELEMENT, TAG, TEXT, COMMENT, SWITCH = range(7)
"""Kinds of steps, in this order: keep nodes unchanged; copy elements and keep the nodes between them; expand an
element; expand a xacro tag; evaluate a text; evaluate a comment if comments are evaluated; start or stop the evaluation
of comments."""

Step: TypeAlias = tuple[int, Any, bool]


class Run:
    """Adjacent nodes that the expansion leaves unchanged.

    Attributes:
        nodes: the elements, with the texts and comments between them.
        size: the number of elements in the nodes, plus one eighth of the number of texts and comments between them.
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
        steps: the steps for the children, in order, or None before the first request; see `steps_of`. Each has its
            kind, its object and a flag. For TAG, the flag is true if another node follows. For SWITCH, it is true if
            comments are evaluated from here on.
    """

    __slots__ = ("attributes", "evaluated", "height", "size", "steps")

    def __init__(self, attributes: dict[str, str], size: int = 1) -> None:
        self.written = None
        self.attributes = attributes
        self.evaluated: list[str] = []
        self.size = self.height = size
        self.steps: list[Step] | None = None


def plan_document(document: Document) -> None:
    """Record the end offset of a document's root, to derive the root's plan from the text.

    Documents with a document type declaration, and documents created by a program, are skipped.
    """
    root = document.root
    if root.plan is None and document.doctype is None and document.source is not None:
        root.plan = len(document.source.text)


def plan_of(node: Element) -> Plan:
    """Return the plan of an element, and compute it on first use."""
    plan = node.plan
    if not isinstance(plan, Plan):
        plan = node.plan = _compute_plan(node, plan if isinstance(plan, int) else _UNKNOWN_OFFSET, 0)
    return plan


def steps_of(node: Element) -> list[Step]:
    """Return the steps for the children of an element, and compute them on first use."""
    plan = plan_of(node)
    if plan.steps is None:
        plan.steps = _StepBuilder(node.children, _UNKNOWN_OFFSET, 0).steps
    return plan.steps


def _compute_plan(node: Element, end: int, depth: int) -> Plan:
    """Compute the plan of an element.

    `end` is the offset after the text of the element, or `_UNKNOWN_OFFSET`.
    """
    plan = Plan(node.attributes)
    children = _StepBuilder(node.children, end, depth)
    plan.steps = children.steps
    plan.height = children.height + 1
    plan.size = children.size + 1 if children.all_unchanged else 0
    if node.attributes:
        _plan_attributes(plan, node.attributes)
    return plan


def _plan_attributes(plan: Plan, attributes: dict[str, str]) -> None:
    has_only_plain_names = True
    for name, value in attributes.items():
        if "x" in name and (name == _DECLARATION or name.startswith(PREFIX)):
            has_only_plain_names = False
        elif "$" in value or len(value) > LONG_TEXT_LENGTH:
            plan.evaluated.append(name)
    if plan.evaluated or not has_only_plain_names:
        plan.size = 0
    if not has_only_plain_names:
        plan.attributes = {
            name: value
            for name, value in attributes.items()
            if not ("x" in name and (name == _DECLARATION or name.startswith(PREFIX)))
        }


class _StepBuilder:
    """A builder of the steps for the children of an element.

    Attributes:
        steps: the steps, in document order.
        all_unchanged: whether all children are unchanged.
        size: the total number of elements in unchanged children.
        height: the maximum nesting depth of the children.
    """

    def __init__(self, children: list[Node], end: int, depth: int) -> None:
        self.steps: list[Step] = []
        self.all_unchanged = True
        self.size = self.height = 0
        self._unchanged_nodes: list[Node] = []  # the unchanged nodes since the last step
        self._nodes_since_element = 0  # the number of these nodes after the last element
        self._run_size = self._run_height = 0
        self._plan(children, end, depth)

    def _plan(self, children: list[Node], end: int, depth: int) -> None:
        last_index = len(children) - 1
        unchanged_nodes = self._unchanged_nodes
        has_switch = False
        for index, node in enumerate(children):
            step: Step
            if isinstance(node, Text):
                data = node.data
                if "$" not in data and len(data) <= LONG_TEXT_LENGTH:
                    unchanged_nodes.append(node)
                    self._nodes_since_element += 1
                    if not has_switch or node.cdata or not data or data.isspace():
                        continue
                    step = (SWITCH, None, False)
                else:
                    step = (TEXT, node, False)
            elif isinstance(node, Element):
                end_offset = end if index == last_index or end < 0 else children[index + 1].offset
                if node.tag.startswith(PREFIX):
                    if node.plan is None and end_offset >= 0:
                        node.plan = end_offset
                    step = (TAG, node, index < last_index)
                    self.all_unchanged = False
                else:
                    inner = _plan_child(node, end_offset, depth)
                    if inner is not None and inner.size:
                        self.size += inner.size
                        self.height = max(self.height, inner.height)
                        if not has_switch:
                            self._add_to_run(node, inner)
                            continue
                    else:
                        self.all_unchanged = False
                    step = (ELEMENT, node, False)
            elif has_switch and isinstance(node, Comment) and _EVALUATE_COMMENTS not in node.data:
                step = (COMMENT, node, False)
            elif isinstance(node, Comment) and _EVALUATE_COMMENTS in node.data:
                has_switch = True
                step = (SWITCH, None, _EVALUATE_COMMENTS_OFF not in node.data)
            else:
                unchanged_nodes.append(node)
                self._nodes_since_element += 1
                continue
            self._end_run()
            unchanged_nodes = self._unchanged_nodes
            self.steps.append(step)
            if step[0] in (TEXT, SWITCH, COMMENT):
                self.all_unchanged = False
            elif has_switch:
                self.steps.append((SWITCH, None, False))
        self._end_run()

    def _add_to_run(self, node: Element, inner: Plan) -> None:
        self._run_size += inner.size + (self._nodes_since_element >> 3)
        self._run_height = max(self._run_height, inner.height)
        self._nodes_since_element = 0
        self._unchanged_nodes.append(node)

    def _end_run(self) -> None:
        if self._run_size:
            run = Run(self._unchanged_nodes, self._run_size + (self._nodes_since_element >> 3), self._run_height)
            self.steps.append((COPY, run, False))
        elif self._unchanged_nodes:
            self.steps.append((KEEP, self._unchanged_nodes, False))
        if self._unchanged_nodes:
            self._unchanged_nodes = []
        self._nodes_since_element = self._run_size = self._run_height = 0


def _plan_child(node: Element, end_offset: int, depth: int) -> Plan | None:
    """Return the plan of an ordinary child, or None if it is nested too deeply for now.

    `end_offset` is the offset after the text of the child.
    """
    child_plan = node.plan
    if isinstance(child_plan, Plan):
        return child_plan
    source = node.source
    if child_plan is None and source is not None and end_offset >= 0:
        size = _count_unchanged_elements(source.text[node.offset : end_offset])
        if size:
            node.plan = child_plan = Plan(node.attributes, size)
            return child_plan
        if depth >= _MAX_LOOKAHEAD_DEPTH:
            node.plan = end_offset
    if depth >= _MAX_LOOKAHEAD_DEPTH:
        return None
    node.plan = child_plan = _compute_plan(node, end_offset, depth + 1)
    return child_plan


def _count_unchanged_elements(text: str) -> int:
    """Return the number of elements in the text of an unchanged element, or 0 if it may change.

    The result is also 0 for a text with character references or comments, and for a text long enough to be charged.
    """
    if any(marker in text for marker in _CHANGE_MARKERS):
        return 0
    segments = text.split("<")
    if len(text) > LONG_TEXT_LENGTH and max(map(len, segments)) > LONG_TEXT_LENGTH:
        return 0
    return len(segments) - 1 - text.count("</")
