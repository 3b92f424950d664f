"""Compare semantic descriptions (SRDF): groups, states, end effectors and collisions."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, Phrase, counted, joined, joined_first, phrase, quoted_names, term
from linkwright.lint.targets import find_files_and_packages
from linkwright.review.breaking import joint_name_reason
from linkwright.review.changes import MAX_NAMES, Change, Effect
from linkwright.review.file_pair import FilePair
from linkwright.review.files.arms.group_joints import GroupJoints
from linkwright.review.files.arms.semantic_names import (
    LINK_ATTRIBUTES,
    find_renamed_names,
    find_renamed_virtual_joints,
    report_renamed_names,
)
from linkwright.review.lenient_xml import read_lenient_root
from linkwright.review.versions import Version
from linkwright.xmltree import Element

_NAMED_TAGS = ("group", "group_state", "end_effector", "virtual_joint", "passive_joint")
_PAIR_TAGS = ("disable_collisions", "enable_collisions")
_MAX_COUNTED_LINKS = 6
"""The maximum number of links by which many pairs are counted."""
_MAX_PAIRS = 20
"""The maximum number of pairs of links that are listed one by one."""
_JOINT_PREFIX = "joint "
"""The start of a member of a group that is a joint."""
_JOINT_TAG = re.compile(r"<joint\s[^<>]*>")
_FIXED = re.compile(r"\stype\s*=\s*[\"']fixed[\"']")
_NAME = re.compile(r"\sname\s*=\s*[\"']([^\"']*)[\"']")
_VIRTUAL_JOINT, _PASSIVE_JOINT = "virtual_joint", "passive_joint"
_PARENT_LINK = "parent_link"
_PARENT_FRAME = "parent_frame"
"""The attribute of a virtual joint with the frame in which MoveIt plans."""
_EXPRESSION = re.compile(r"\$\{[^{}]*\}|\$\([^()]*\)")


@dataclass(frozen=True)
class _Entry:
    """A named element of a semantic description.

    Attributes:
        tag: the tag of the element.
        name: the name. The name of a state begins with its group.
        values: the parts of the element by name. The values of group members are empty.
        element: the XML element.
    """

    tag: str
    name: str
    values: Mapping[str, str]
    element: Element


def compare_semantics(pair: FilePair) -> None:
    """Compare two versions of a semantic description."""
    roots = pair.read(read_lenient_root)
    if roots is not None:
        compare_roots(pair, *roots)


def compare_roots(pair: FilePair, old_root: Element, new_root: Element) -> None:
    """Compare two semantic descriptions by their root elements."""
    new_names = find_renamed_names(pair, old_root, new_root)
    all_new_names = new_names | find_renamed_virtual_joints(old_root, new_root)
    old, new = (
        {(entry.tag, entry.name): entry for entry in _read_entries(root, names)}
        for root, names in ((old_root, all_new_names), (new_root, {}))
    )
    renamed = dict(_find_renamed(old, new))
    passive_joints = {name for tag, name in new if tag == "passive_joint"}
    passive_joints |= {entry.name for entry in old.values() if _is_fixed_virtual_joint(entry)}
    if new_names:
        fixed_joints = {*passive_joints, *_find_fixed_joints(pair.versions.old)}
        report_renamed_names(pair, new_root, new_names, fixed_joints)
    moved_states = dict(_find_states_of_renamed_groups(old, new, renamed))
    old_keys = {new_key: old_key for old_key, new_key in (renamed | moved_states).items()}
    joints = GroupJoints(pair.versions.new, new_root)
    added: list[_Entry] = []
    removed: list[_Entry] = []
    for key, entry in new.items():
        if key in old or key in moved_states.values():
            _compare_entries(pair, old[old_keys.get(key, key)], entry, passive_joints, joints)
        elif key not in renamed.values():
            added.append(entry)
    _report_added(pair, added)
    for key, entry in old.items():
        if key in moved_states:
            continue
        if key in renamed:
            text = phrase("{entry} renamed to '{name}'", entry=_format_title(entry), name=new[renamed[key]].name)
            location = pair.location(new[renamed[key]].element.span())
            reason = find_removal_reason(entry.tag, entry.name)
            if entry.tag == _VIRTUAL_JOINT and not _is_fixed_virtual_joint(entry):
                reason = joint_name_reason(entry.name)
            pair.add(text, location, reason)
        elif key not in new:
            removed.append(entry)
    _report_removed(pair, removed, new.values())
    for tag in _PAIR_TAGS:
        _compare_pairs(pair, tag, _group_by_pair(old_root, tag, new_names), _group_by_pair(new_root, tag))


def _report_added(pair: FilePair, entries: Iterable[_Entry]) -> None:
    for first, names in _group_plain_entries(entries):
        text = _add_values(phrase("{entry} added", entry=_format_title(first)), first)
        pair.changes.append(Change(text, location=pair.location(first.element.span()), other_names=names))


def _report_removed(pair: FilePair, entries: Iterable[_Entry], new: Collection[_Entry]) -> None:
    for first, names in _group_plain_entries(entries):
        location = pair.location(first.element.span(), is_old=True)
        reason = find_removal_reason(first.tag, first.name) or _find_planning_frame_reason(first, new)
        text = _add_values(phrase("{entry} removed", entry=_format_title(first)), first)
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        pair.changes.append(Change(text, effect, reason, location, other_names=names))


def _group_plain_entries(entries: Iterable[_Entry]) -> Iterator[tuple[_Entry, tuple[str, ...]]]:
    """Yield the entries; of passive joints, which only have a name, the first with the names of the others."""
    plain: list[_Entry] = []
    for entry in entries:
        if entry.tag == _PASSIVE_JOINT:
            plain.append(entry)
        else:
            yield entry, ()
    if plain:
        yield plain[0], tuple(entry.name for entry in plain[1:])


def semantic_contents(version: Version, path: str) -> Phrase | None:
    """Return the named elements of a semantic description; None if there are none."""
    titles = [_format_title(entry) for entry in _read_entries(read_lenient_root(version.file(path)), {})]
    return joined_first(titles, MAX_NAMES) if titles else None


def find_disabled_collisions(folder: Path) -> frozenset[frozenset[str]]:
    """Return the pairs of links whose collisions the files below a folder disable.

    Xacro expressions in the names of links, such as prefixes, count as empty.
    """
    pairs: set[frozenset[str]] = set()
    for file in find_files_and_packages(folder, (".srdf", ".srdf.xacro"))[0]:
        with suppress(LinkwrightError, OSError):
            pairs |= {
                frozenset(_EXPRESSION.sub("", element.attributes.get(name, "")) for name in ("link1", "link2"))
                for element in read_lenient_root(file).walk()
                if element.tag == "disable_collisions"
            }
    return frozenset(pairs)


def find_removal_reason(tag: str, name: str) -> Phrase | None:
    """Return the reason why removing an element is breaking; None if it is not."""
    if tag == "group":
        return phrase("programs that plan for the group '{name}' do not find it", name=name)
    if tag == "group_state" and not name.startswith("/"):  # MoveIt skips states without a group
        return phrase("programs that move to the state '{name}' do not find it", name=name)
    if tag == "end_effector":
        return phrase("programs that use the end effector '{name}' do not find it", name=name)
    return None


def _read_entries(root: Element, new_names: Mapping[str, str]) -> Iterator[_Entry]:
    """Yield the named elements, with the new names of renamed links and joints."""
    for element in root.elements():
        name = element.attributes.get("name", "")
        if element.tag not in _NAMED_TAGS:
            continue
        if element.tag == "group_state":
            name = f"{element.attributes.get('group', '')}/{name}"
            parts = [(part.attributes.get("name", ""), part.attributes.get("value", "")) for part in element.elements()]
            values = {new_names.get(part_name, part_name): value for part_name, value in parts}
        elif element.tag == "group":
            values = {_format_member(part, new_names): "" for part in element.elements()}
        else:
            name = new_names.get(name, name) if element.tag == "passive_joint" else name
            values = {
                key: new_names.get(text, text) if key in LINK_ATTRIBUTES else text
                for key, text in element.attributes.items()
                if key != "name"
            }
        yield _Entry(element.tag, name, values, element)


def _format_member(element: Element, new_names: Mapping[str, str]) -> str:
    """Return a member of a group in one line, such as ``chain base tip``."""
    return " ".join([element.tag, *(new_names.get(value, value) for value in element.attributes.values())])


def _find_renamed(
    old: Mapping[tuple[str, str], _Entry], new: Mapping[tuple[str, str], _Entry]
) -> Iterator[tuple[tuple[str, str], tuple[str, str]]]:
    """Yield the old and new keys of renamed elements, whose contents are equal."""
    added = [key for key in new if key not in old]
    for key, entry in old.items():
        if key in new or not entry.values:
            continue
        match = next((other for other in added if _have_equal_values(entry, new[other])), None)
        if match is not None:
            added.remove(match)
            yield key, match


def _find_states_of_renamed_groups(
    old: Mapping[tuple[str, str], _Entry],
    new: Mapping[tuple[str, str], _Entry],
    renamed: Mapping[tuple[str, str], tuple[str, str]],
) -> Iterator[tuple[tuple[str, str], tuple[str, str]]]:
    """Yield the old and new keys of states that kept their name, but whose group has another one."""
    for tag, name in old:
        group, _, state = name.partition("/")
        _, new_group = renamed.get(("group", group), ("", ""))
        new_key = tag, f"{new_group}/{state}"
        if tag == "group_state" and new_group and new_key in new and new_key not in old:
            yield (tag, name), new_key


def _have_equal_values(old: _Entry, new: _Entry) -> bool:
    return old.tag == new.tag and dict(old.values) == dict(new.values)


def _format_title(entry: _Entry) -> Phrase:
    return phrase("{tag} '{name}'", tag=term(entry.tag), name=entry.name)


def _add_values(text: Phrase, entry: _Entry) -> Phrase:
    """Return the line about an added or removed element, with its parts."""
    values = [f"{name} {value}".strip() for name, value in entry.values.items()]
    return phrase("{change}: {items}", change=text, items=joined_first(values, MAX_NAMES)) if values else text


def _compare_entries(
    pair: FilePair, old: _Entry, new: _Entry, passive_joints: Collection[str], joints: GroupJoints
) -> None:
    changes: list[str] = []
    for name in dict.fromkeys([*new.values, *old.values]):
        before, after = old.values.get(name), new.values.get(name)
        if before is None:
            changes.append(f"+ {name} {after}".strip())
        elif after is None:
            changes.append(f"- {name} {before}".strip())
        elif not _are_equal(before, after):
            changes.append(f"{name} {before} -> {after}")
    if changes:
        text = phrase("{entry}: {changes}", entry=_format_title(new), changes=joined_first(changes, MAX_NAMES))
        reason = _find_lost_joints_reason(pair.versions.old, old, new, passive_joints, joints)
        reason = reason or _find_tip_reason(old, new) or _find_planning_frame_reason(old, [new])
        reason = reason or _find_parent_link_reason(old, new) or _find_other_group_reason(old, new, joints)
        pair.add(text, pair.location(new.element.span()), reason)


def _find_planning_frame_reason(old: _Entry, new: Iterable[_Entry]) -> Phrase | None:
    """Return the reason why a lost parent frame of a virtual joint is breaking; None if it is not lost.

    The model frame of MoveIt is the parent frame of the virtual joint, or the root link without such a joint.
    """
    frame = old.values.get(_PARENT_FRAME, "")
    frames = {entry.values.get(_PARENT_FRAME) for entry in new if entry.tag == _VIRTUAL_JOINT}
    is_lost = old.tag == _VIRTUAL_JOINT and bool(frame) and frame not in frames
    if not is_lost or any("$" in other for other in (frame, *frames) if other):
        return None
    return phrase("MoveIt no longer plans in the frame '{name}'", name=frame)


def _is_fixed_virtual_joint(entry: _Entry) -> bool:
    return entry.tag == _VIRTUAL_JOINT and entry.values.get("type") == "fixed"


def _find_parent_link_reason(old: _Entry, new: _Entry) -> Phrase | None:
    """Return the reason why another parent link of an end effector is breaking; None for other changes.

    A grasp gives the pose of this link, see ``PickPlan`` of MoveIt.
    """
    links = [entry.values.get(_PARENT_LINK, "") for entry in (old, new)]
    if old.tag != "end_effector" or links[0] == links[1] or not all(links) or "$" in str(links):
        return None
    return phrase(
        "grasps of the end effector '{name}' move '{new}' instead of '{old}' to their poses",
        name=new.name,
        new=links[1],
        old=links[0],
    )


def _find_other_group_reason(old: _Entry, new: _Entry, joints: GroupJoints) -> Phrase | None:
    """Return the reason why another group of an end effector is breaking; None for other changes.

    Programs open and close it by this group. If the old group is gone, that is the reported change.
    """
    groups = [entry.values.get("group", "") for entry in (old, new)]
    if old.tag != "end_effector" or groups[0] == groups[1] or not all(map(joints.has_group, groups)):
        return None
    return phrase(
        "programs that move the end effector '{name}' move the group '{new}' instead of '{old}'",
        name=new.name,
        new=groups[1],
        old=groups[0],
    )


def _find_lost_joints_reason(
    version: Version, old: _Entry, new: _Entry, passive_joints: Collection[str], joints: GroupJoints
) -> Phrase | None:
    """Return the reason why lost joints of a group are breaking; None if they are not.

    A group defined by a chain, links or other groups can still contain the joints. Programs do not
    move fixed and passive joints.
    """
    added = [member for member in new.values if member not in old.values]
    lost = [
        name.removeprefix(_JOINT_PREFIX)
        for name in old.values
        if name.startswith(_JOINT_PREFIX) and name not in new.values
    ]
    if old.tag != "group" or not lost or any(map(_is_computed_joint, added)):
        return None
    fixed = {*passive_joints, *_find_fixed_joints(version)}
    lost = [name for name in lost if name not in fixed and not joints.may_contain(new.name, name)]
    return None if not lost else counted(
        "programs that move the joint {names} of the group '{group}' do not find it",
        "programs that move the joints {names} of the group '{group}' do not find them",
        len(lost), names=quoted_names(lost), group=new.name,
    )  # fmt: skip


def _find_tip_reason(old: _Entry, new: _Entry) -> Phrase | None:
    """Return the reason why another end of a chain is breaking; None for other changes.

    It is the link that a pose goal moves if the goal names no link, see ``getEndEffectorLink`` of MoveIt.
    """
    tips = [[chain.attributes.get("tip_link", "") for chain in entry.element.elements("chain")] for entry in (old, new)]
    if old.tag != "group" or [len(links) for links in tips] != [1, 1] or tips[0] == tips[1] or "$" in str(tips):
        return None
    return phrase(
        "pose goals for the group '{group}' that name no link move '{new}' instead of '{old}'",
        group=new.name,
        new=tips[1][0],
        old=tips[0][0],
    )


def _is_computed_joint(member: str) -> bool:
    return member.startswith(_JOINT_PREFIX) and _EXPRESSION.search(member) is not None


def _find_fixed_joints(version: Version) -> set[str]:
    """Return the fixed joints in the descriptions of a version, as written in the files."""
    texts = (version.text(path) for path in version.paths((".urdf", ".xacro")))
    tags = (match[0] for text in texts for match in _JOINT_TAG.finditer(text))
    return {name[1] for tag in tags if _FIXED.search(tag) and (name := _NAME.search(tag))}


def _are_equal(old: str, new: str) -> bool:
    """Return whether two values are equal as texts or as numbers."""
    try:
        return old == new or [float(word) for word in old.split()] == [float(word) for word in new.split()]
    except ValueError:
        return False


def _group_by_pair(
    root: Element, tag: str, new_names: Mapping[str, str] | None = None
) -> dict[tuple[str, ...], Element]:
    """Return the elements about pairs of links, by the sorted names of the links."""
    pairs = ([element.attributes.get(name, "") for name in ("link1", "link2")] for element in root.elements(tag))
    names = ([(new_names or {}).get(link, link) for link in links] for links in pairs)
    return {tuple(sorted(links)): element for links, element in zip(names, root.elements(tag), strict=True)}


def _compare_pairs(
    pair: FilePair, tag: str, old: Mapping[tuple[str, ...], Element], new: Mapping[tuple[str, ...], Element]
) -> None:
    added, removed = [key for key in new if key not in old], [key for key in old if key not in new]
    if added:
        text = counted(
            "{tag}: {count} pair added: {pairs}", "{tag}: {count} pairs added: {pairs}", len(added), tag=term(tag),
            pairs=_summarize_pairs(added, old),
        )  # fmt: skip
        pair.add(text, pair.location(new[added[0]].span()))
    if removed:
        text = counted(
            "{tag}: {count} pair removed: {pairs}", "{tag}: {count} pairs removed: {pairs}", len(removed),
            tag=term(tag), pairs=_summarize_pairs(removed, new),
        )  # fmt: skip
        pair.add(text, pair.location(old[removed[0]].span(), is_old=True))


def _summarize_pairs(pairs: Sequence[tuple[str, ...]], others: Collection[tuple[str, ...]]) -> Phrase:
    """Return pairs of links in one line. Of many pairs, those of a link that the other version lacks are summarized.

    Args:
        pairs: the pairs that only one version has.
        others: the pairs of the other version.
    """
    if len(pairs) <= _MAX_PAIRS:
        return joined_first(list(map(" - ".join, pairs)), MAX_NAMES)
    other_links = {link for other in others for link in other}
    links = list(dict.fromkeys(link for names in pairs for link in names if link not in other_links))
    rest = [names for names in pairs if other_links.issuperset(names)]
    parts = [_summarize_new_links(links, len(pairs) - len(rest), is_all=not rest)] if links else []
    if len(rest) > 2 * _MAX_PAIRS:
        return joined([*parts, *_count_by_link(rest)])
    return joined([*parts, *([joined_first(list(map(" - ".join, rest)), _MAX_PAIRS)] if rest else [])])


def _summarize_new_links(links: Sequence[str], count: int, *, is_all: bool) -> Phrase:
    """Return the links of which each of some pairs has at least one.

    Args:
        links: the links that the other version lacks.
        count: the number of pairs.
        is_all: whether these are all pairs of the line.
    """
    names = joined_first(links, MAX_NAMES)
    if len(links) > 1:
        names = phrase("one of {links}", links=names)
    return (
        phrase("all with {links}", links=names) if is_all else phrase("{count} with {links}", count=count, links=names)
    )


def _count_by_link(pairs: Sequence[tuple[str, ...]]) -> Iterator[Phrase]:
    """Yield the numbers of pairs with the most frequent links, each pair counted once, and the number of the others."""
    remaining = list(pairs)
    for _ in range(_MAX_COUNTED_LINKS):
        link, count = Counter(link for names in remaining for link in names).most_common(1)[0]
        yield phrase("{count} with {link}", count=count, link=link)
        remaining = [names for names in remaining if link not in names]
        if not remaining:
            return
    yield counted("{count} other", "{count} others", len(remaining))
