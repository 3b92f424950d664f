"""The tree of links that the joints form: its validation, and its traversal.

Children are in the order of their joints' names, as in urdfdom's maps.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from linkwright.diagnostics import Note, Span, did_you_mean, phrase, quoted_names, term
from linkwright.urdf.model import Joint, Link, Robot
from linkwright.urdf.report import Findings
from linkwright.xmltree import Element

_MAX_SUGGESTIONS = 100
"""The number of findings after which no similar names are suggested, because the search would take long."""
_MAX_VISITS = 64


def children_of(robot: Robot) -> Mapping[str, tuple[Joint, ...]]:
    """Return the child joints of every link, by link name.

    The joints are ordered by name. A leaf has no child joints.
    """
    children: dict[str, list[Joint]] = {name: [] for name in robot.links}
    for _, joint in sorted(robot.joints.items()):
        children[joint.parent].append(joint)
    return {name: tuple(joints) for name, joints in children.items()}


def parent_joints(robot: Robot) -> Mapping[str, Joint]:
    """Return the parent joint of every link except the root, by link name.

    Of several parent joints, the last joint by name is returned, as in urdfdom.
    """
    return {joint.child: joint for _, joint in sorted(robot.joints.items())}


def walk(robot: Robot) -> Iterator[tuple[Joint, int]]:
    """Yield the joints below the root in depth-first order, each with its depth, starting at 1.

    Joints below a link with several parents are repeated for each parent, as in urdfdom. Because the number of paths
    may double with every link, only up to `_MAX_VISITS` paths to a link are followed.
    """
    children = children_of(robot)
    visits: Counter[str] = Counter()
    stack = [(joint, 1) for joint in reversed(children[robot.root])]
    while stack:
        joint, depth = stack.pop()
        yield joint, depth
        visits[joint.child] += 1
        if visits[joint.child] <= _MAX_VISITS:
            stack.extend((child_joint, depth + 1) for child_joint in reversed(children[joint.child]))


def find_root(links: Mapping[str, Link], joints: Sequence[Joint], findings: Findings) -> str:
    """Check that the joints form a tree of the links, and return the root's name.

    The name is empty unless there is exactly one root. urdfdom refuses unknown links, and any number of roots except
    one. It does not detect cycles that are not connected to the root, links with two parents, and cycles below the
    root, which later cause a crash. Linkwright reports all of these as errors, and refuses cycles below the root.
    """
    if not _links_exist(links, joints, findings):
        return ""
    child_links = {joint.child for joint in joints}
    roots = [name for name in links if name not in child_links]
    if not roots:
        findings.rejected = True
        _report_loop(_find_loop(joints[0].child, joints), joints, phrase("no link is the root"), findings)
        return ""
    if len(roots) > 1:
        _check_parents(joints, findings)
        _report_roots(roots, links, findings)
        return ""
    if not _is_tree(roots[0], links, joints, child_links):
        _check_parents(joints, findings)
        _check_reachable(roots[0], links, joints, findings)
    return roots[0]


def _links_exist(links: Mapping[str, Link], joints: Sequence[Joint], findings: Findings) -> bool:
    is_valid = True
    for joint in joints:
        for tag, name in (("parent", joint.parent), ("child", joint.child)):
            if name in links and name:
                continue
            is_valid = False
            if not name:
                continue  # the missing link is reported already
            assert joint.element is not None
            element = joint.element.first(tag)
            assert element is not None
            suggestion = did_you_mean(name, links) if findings.count < _MAX_SUGGESTIONS else None
            hint = suggestion or phrase('add <link name="{name}"/>', name=name)
            message = phrase(
                "{tag} link '{name}' of joint '{joint_name}' does not exist",
                tag=term(tag),
                name=name,
                joint_name=joint.name,
            )
            findings.reject("URDF150", message, element, "link", hint=hint)
    return is_valid


def _report_roots(roots: Sequence[str], links: Mapping[str, Link], findings: Findings) -> None:
    names_text = (
        quoted_names(roots, " and ") if len(roots) < 6 else phrase("{names}, ...", names=quoted_names(roots[:5]))
    )
    notes = [Note(phrase("'{name}' has no parent", name=name), _find_span(links[name].element)) for name in roots[:5]]
    element = links[roots[1]].element
    assert element is not None
    findings.reject(
        "URDF152",
        phrase(
            "{count} links have no parent joint, but a robot has one root: {links}",
            count=len(roots),
            links=names_text,
        ),
        element,
        "name",
        hint=phrase(
            "connect all but one of them with joints, such as a fixed joint from '{roots}' to '{other_roots}'",
            roots=roots[0],
            other_roots=roots[1],
        ),
        notes=notes,
    )


def _is_tree(root: str, links: Mapping[str, Link], joints: Sequence[Joint], moved: set[str]) -> bool:
    """Return whether each link has at most one parent and is connected to the root."""
    if len(moved) != len(joints):
        return False
    parents = {joint.child: joint.parent for joint in joints}
    connected_links = {root}
    for link in links:
        path: list[str] = []
        while link not in connected_links:
            if len(path) > len(links):
                return False
            path.append(link)
            link = parents[link]
        connected_links.update(path)
    return True


def _check_parents(joints: Sequence[Joint], findings: Findings) -> None:
    joints_by_child: dict[str, Joint] = {}
    for joint in joints:
        first = joints_by_child.setdefault(joint.child, joint)
        if first is joint or first.name == joint.name:
            continue  # another joint with the same name is reported already
        assert joint.element is not None
        child_element = joint.element.first("child")
        assert child_element is not None
        findings.error(
            "URDF151",
            phrase(
                "link '{link}' is the child of two joints, '{joint}' and '{other_joint}'",
                link=joint.child,
                joint=first.name,
                other_joint=joint.name,
            ),
            child_element,
            "link",
            hint=phrase("remove one of the joints, or add a link for it: a link has only one parent"),
            notes=(Note(phrase("'{name}' is defined here", name=first.name), _find_span(first.element)),),
        )


def _check_reachable(root: str, links: Mapping[str, Link], joints: Sequence[Joint], findings: Findings) -> None:
    children: dict[str, list[str]] = {}
    for joint in joints:
        children.setdefault(joint.parent, []).append(joint.child)
    # Search depth-first with an explicit stack. A link that occurs twice on the current path closes a cycle.
    visited, path = {root}, {root}
    stack = [(root, iter(children.get(root, ())))]
    while stack:
        name, remaining_children = stack[-1]
        child = next(remaining_children, None)
        if child is None:
            path.discard(name)
            stack.pop()
        elif child in path:
            loop = [link for link, _ in stack]
            loop = [*loop[loop.index(child) :], child]
            findings.rejected = True
            _report_loop(loop, joints, phrase("a robot is a tree"), findings)
            return
        elif child not in visited:
            visited.add(child)
            path.add(child)
            stack.append((child, iter(children.get(child, ()))))
    unreachable_links = [name for name in links if name not in visited]
    if unreachable_links:
        consequence = phrase("{count} links are not below the root '{root}'", count=len(unreachable_links), root=root)
        _report_loop(_find_loop(unreachable_links[0], joints), joints, consequence, findings)


def _find_loop(link: str, joints: Sequence[Joint]) -> list[str]:
    """Return the links of the cycle above a link, from parent to child.

    The first and the last link are the same.
    """
    parents = {joint.child: joint.parent for joint in joints}
    path = [link]
    while path[-1] in parents and parents[path[-1]] not in path:
        path.append(parents[path[-1]])
    first_link = parents[path[-1]]
    loop = path[path.index(first_link) :]
    return [first_link, *reversed(loop)]


def _report_loop(loop: Sequence[str], joints: Sequence[Joint], consequence: str, findings: Findings) -> None:
    closing_joint = next(joint for joint in joints if joint.parent == loop[-2] and joint.child == loop[-1])
    assert closing_joint.element is not None
    child_element = closing_joint.element.first("child")
    assert child_element is not None
    findings.error(
        "URDF153",
        phrase("the joints form a cycle, {cycle}, and {consequence}", cycle=" -> ".join(loop), consequence=consequence),
        child_element,
        "link",
        hint=phrase("remove or reverse one of these joints; URDF cannot describe a closed chain"),
    )


def _find_span(element: Element | None) -> Span | None:
    return None if element is None else element.span()
