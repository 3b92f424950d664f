"""The names in an SRDF that exist: links and joints of the robot, and groups.

As in MoveIt, the rest of the SRDF is used without the elements that name something else.

Source: the package ``srdfdom``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from linkwright.diagnostics import Diagnostic, did_you_mean, phrase, term
from linkwright.planning.semantics import GroupDefinition, Semantics
from linkwright.urdf import Robot


def leave_out_unknown_names(semantics: Semantics, robot: Robot) -> Semantics:
    """Return the contents of an SRDF without what groups and end effectors name and does not exist.

    A group with an unknown subgroup, or one that contains itself, is left out as a whole. The errors are ARM102.
    """
    problems: list[Diagnostic] = []
    virtual_joints = {joint.name for joint in semantics.virtual_joints}
    candidates = {
        name: _with_known_parts(group, robot, virtual_joints, problems) for name, group in semantics.groups.items()
    }
    groups = _with_known_subgroups(candidates, problems)
    return replace(
        semantics,
        groups=groups,
        end_effectors=tuple(
            item for item in semantics.end_effectors if item.group in groups and item.parent_link in robot.links
        ),
        problems=(*semantics.problems, *problems),
    )


def _with_known_parts(
    group: GroupDefinition, robot: Robot, virtual_joints: Iterable[str], problems: list[Diagnostic]
) -> GroupDefinition:
    joints = {*robot.joints, *virtual_joints}
    problems += [_unknown_name(group, "joint", name, robot.joints) for name in group.joints if name not in joints]
    chain_links = [name for chain in group.chains for name in chain]
    problems += [
        _unknown_name(group, "link", name, robot.links)
        for name in (*group.links, *chain_links)
        if name not in robot.links
    ]
    return replace(
        group,
        links=tuple(name for name in group.links if name in robot.links),
        joints=tuple(name for name in group.joints if name in joints),
        chains=tuple(chain for chain in group.chains if all(name in robot.links for name in chain)),
    )


def _with_known_subgroups(
    candidates: dict[str, GroupDefinition], problems: list[Diagnostic]
) -> dict[str, GroupDefinition]:
    """Return the groups whose subgroups are known, also those of their subgroups, in the order of the candidates."""
    known: set[str] = set()
    while added := {
        name for name, group in candidates.items() if name not in known and known.issuperset(group.subgroups)
    }:
        known |= added
    for name, group in candidates.items():
        if name not in known:
            unknown = next(subgroup for subgroup in group.subgroups if subgroup not in known)
            problems.append(_unknown_name(group, "group", unknown, candidates.keys() - {name, unknown}))
    return {name: group for name, group in candidates.items() if name in known}


def _unknown_name(group: GroupDefinition, kind: str, name: str, candidates: Iterable[str]) -> Diagnostic:
    message = phrase(
        "group '{group}' of the SRDF names the {kind} '{name}', which does not exist",
        group=group.name,
        kind=term(kind),
        name=name,
    )
    return Diagnostic("ARM102", message, hint=did_you_mean(name, list(candidates)))
