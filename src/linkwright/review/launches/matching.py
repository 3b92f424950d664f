"""Match the actions of two versions of a launch file."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from pathlib import PurePosixPath

from linkwright.review.launches.outlines import (
    CONDITION,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    PARAMETER,
    PASSES_ALL_ARGUMENTS,
    REMAPPING,
    SERVER_PARAMETER,
    Entry,
    LaunchOutline,
)
from linkwright.review.launches.replaced_nodes import (
    COMMON_PARAMETERS,
    have_same_names,
    match_lone_nodes,
    register_same_class,
)
from linkwright.review.launches.titles import find_served_names

MIN_SIMILARITY = 0.5
_MIN_SIMILARITY_OF_PROGRAMS = 0.75
_MIN_SIMILARITY_OF_FILES = 0.6
_SEPARATORS = re.compile(r"[\W_]+|node")
_VARIABLE = re.compile(r"\$\((?:var|arg) [^()]*\)")
_PACKAGE_FOLDER = re.compile(r"\$\(find(?:-pkg-share)? [^()]+\)/")
_CONTEXT_SETTINGS = frozenset({CONDITION, NAMESPACE_OF_INCLUDED, PASSES_ALL_ARGUMENTS})
"""The settings of an include that are not passed arguments."""
_MIN_COMMON_ARGUMENTS = 2
_MIN_SHARE_OF_COMMON_ARGUMENTS = 0.5
"""The number and the share of passed arguments that an include keeps if another file replaces the included one."""
_SIMULATOR_FILE = re.compile(r"(?:^|[/_])(?:gazebo|gzserver|gz_sim|ign_gazebo|\w*world|empty)\.launch")
"""The launch files that, judging by their name, start a simulator."""
_MINCOMMON_PARAMETERS = 2
"""The number of parameters and parameter files that a node keeps if another program replaces its program."""
_LOADED_NODELET = re.compile(r"(?:load|standalone) (\S+)")
Match = tuple["Entry | None", "Entry | None"]
"""The old and the new action; None for a version that lacks the action."""


def match_entries(old: Sequence[Entry], new: Sequence[Entry]) -> Iterator[Match]:
    """Yield the pairs of actions of the same kind and name, then the unpaired actions."""
    old_groups, new_groups = _group_by_name(old), _group_by_name(new)
    for key in dict.fromkeys([*new_groups, *old_groups]):
        yield from _match_group(old_groups.get(key, []), new_groups.get(key, []))


def find_replacements(
    removed: Sequence[Entry],
    added: Sequence[Entry],
    new_names: Mapping[str, str],
    outlines: tuple[LaunchOutline, LaunchOutline],
) -> list[tuple[Entry, Entry]]:
    """Return the pairs of a removed action and an added one that replaces it.

    Args:
        removed: the actions that only the old version has.
        added: the actions that only the new version has.
        new_names: the new names of renamed files and programs, by old name.
        outlines: the outlines of the old and the new file, which have the defaults of arguments.
    """
    scores = [
        (_compute_replacement_score(a, b, new_names, outlines), i, k)
        for i, a in enumerate(removed)
        for k, b in enumerate(added)
    ]
    pairs: dict[int, int] = {}
    for score, i, k in sorted(scores, key=lambda item: (-item[0], item[1], item[2])):
        if score and i not in pairs and k not in pairs.values():
            pairs[i] = k
    pairs |= match_lone_nodes(
        {i: entry for i, entry in enumerate(removed) if i not in pairs},
        {k: entry for k, entry in enumerate(added) if k not in pairs.values()},
    )
    pairs |= _match_lone_includes(
        {i: entry for i, entry in enumerate(removed) if i not in pairs},
        {k: entry for k, entry in enumerate(added) if k not in pairs.values()},
    )
    return [(removed[i], added[k]) for i, k in sorted(pairs.items(), key=lambda pair: pair[1])]


def _match_lone_includes(removed: Mapping[int, Entry], added: Mapping[int, Entry]) -> dict[int, int]:
    """Return the pairs of the only removed and the only added include of files of a package in the same context.

    The names of both files begin with the same word, such as ``rs_camera.launch`` and ``rs_rgbd.launch``.
    """
    groups = [_group_includes(entries) for entries in (removed, added)]
    pairs = {
        numbers[0]: groups[1][key][0]
        for key, numbers in groups[0].items()
        if len(numbers) == len(groups[1].get(key, ())) == 1
    }
    return pairs | _match_includes_of_packages(removed, added, pairs)


def _match_includes_of_packages(
    removed: Mapping[int, Entry], added: Mapping[int, Entry], pairs: Mapping[int, int]
) -> dict[int, int]:
    """Return the pairs of the only removed and the only added include of a package that pass mostly equal arguments.

    Their conditions may differ.

    Args:
        removed: the removed actions, by number.
        added: the added actions, by number.
        pairs: the pairs that are already known.
    """
    numbers: list[dict[str, list[int]]] = [{}, {}]
    for found, entries, taken in ((numbers[0], removed, pairs.keys()), (numbers[1], added, pairs.values())):
        for number, entry in entries.items():
            package = _PACKAGE_FOLDER.match(entry.name) if entry.kind == "include" else None
            if package is not None and number not in taken:
                found.setdefault(package[0], []).append(number)
    return {
        old[0]: numbers[1][package][0]
        for package, old in numbers[0].items()
        if len(old) == len(numbers[1].get(package, ())) == 1
        and _have_common_arguments(
            removed[old[0]], added[numbers[1][package][0]], is_same_package=True, is_same_context=False
        )
    }


def _group_includes(entries: Mapping[int, Entry]) -> dict[tuple[str | None, ...], list[int]]:
    """Return the numbers of the includes of files of packages, by the package and the context of the include."""
    groups: dict[tuple[str | None, ...], list[int]] = {}
    for number, entry in entries.items():
        package = _PACKAGE_FOLDER.match(entry.name) if entry.kind == "include" else None
        if package is not None:
            context = (entry.settings.get(name) for name in sorted(_CONTEXT_SETTINGS))
            first_word = _SEPARATORS.split(get_launch_file_stem(entry.name).lower())[0]
            groups.setdefault((package[0], first_word, *context), []).append(number)
    return groups


def _compute_replacement_score(
    old: Entry, new: Entry, new_names: Mapping[str, str], outlines: tuple[LaunchOutline, LaunchOutline]
) -> float:
    """Return a score for how certainly one action replaces another; 0 if it does not."""
    if old.kind != new.kind:
        return 0.0
    if old.kind == "environment":
        return float(old.settings == new.settings)
    if old.kind == SERVER_PARAMETER:
        return _compute_parameter_score(old, new)
    similarity = _compute_settings_similarity(old, new)
    if old.kind in ("include", "parameters"):
        old_name = PurePosixPath(old.name).name
        is_same_file = get_launch_file_stem(new_names.get(old_name, old_name)) == get_launch_file_stem(new.name)
        is_same_file = is_same_file or (old.kind == "parameters" and _chooses_file(old.name, new.name))
        name_similarity = SequenceMatcher(
            None, get_launch_file_stem(old.name), get_launch_file_stem(new.name), autojunk=False
        ).ratio()
        if _start_simulator(old, new):
            return 1.0 + similarity
        if name_similarity < _MIN_SIMILARITY_OF_FILES and not is_same_file:
            return similarity * _have_common_arguments(old, new, is_same_package=True)
        has_equal_settings = bool(old.settings) and old.settings == new.settings
        is_in_same_folder = old.kind == "include" and PurePosixPath(old.name).parent == PurePosixPath(new.name).parent
        return 1.0 + similarity if is_same_file else name_similarity * (has_equal_settings or is_in_same_folder)
    if old.kind != "node" or _load_different_classes(old, new):
        return 0.0
    (old_package, old_program), (new_package, new_program) = _split_program_name(old), _split_program_name(new)
    name = old.settings.get("name")
    if name and name == new.settings.get("name") and _have_same_namespace(old, new, outlines):
        return 3.0 + similarity
    if start_same_program(old, new, outlines):
        return 2.5 + similarity
    if old_package == new_package and _serve_same_names(old, new) and _stops(old_program) == _stops(new_program):
        return 2.0 + similarity
    old_file, new_file = (entry.name.rpartition("/")[2] for entry in (old, new))
    if old_package == new_package and old_file != new_file and new_names.get(old_file) == new_file:
        return 2.0 + similarity
    if old_program == new_program or register_same_class(old.name, new.name):
        return 2.0 + similarity if similarity >= MIN_SIMILARITY or not (old.settings and new.settings) else 0.0
    name_similarity = compute_name_similarity(old_program.rpartition("::")[2], new_program.rpartition("::")[2])
    has_same_topics = old.settings == new.settings and any(key.startswith(REMAPPING) for key in old.settings)
    if old_package == new_package and has_same_topics and name_similarity >= MIN_SIMILARITY:
        return 1.0 + name_similarity
    if _have_same_parameters(old, new) or have_same_names(old, new):
        return 0.0 if _has_other_partner(old, new, outlines) else 1.0 + similarity
    other_names = (old_package, new_package), (name or "", new.settings.get("name", ""))
    is_renamed = all(a == b or compute_name_similarity(a, b) >= _MIN_SIMILARITY_OF_PROGRAMS for a, b in other_names)
    is_similar = name_similarity >= _MIN_SIMILARITY_OF_PROGRAMS and (
        similarity >= MIN_SIMILARITY or name_similarity == 1.0
    )
    return name_similarity + similarity if is_similar and is_renamed else 0.0


def start_same_program(old: Entry, new: Entry, outlines: tuple[LaunchOutline, LaunchOutline]) -> bool:
    """Return whether two nodes have the same program with the defaults of arguments, which one of them names."""
    is_chosen = old.name != new.name and "$(" in f"{old.name}{new.name}"
    return (
        old.kind == new.kind == "node" and is_chosen and outlines[0].resolve(old.name) == outlines[1].resolve(new.name)
    )


def _have_same_parameters(old: Entry, new: Entry) -> bool:
    """Return whether two nodes get the same parameters, at least two of which are not common to many programs."""
    parameters = [
        {item for item in entry.settings.items() if item[0].startswith(("parameters", PARAMETER))}
        for entry in (old, new)
    ]
    names = {name.removeprefix(PARAMETER) for name, _ in parameters[1]} - COMMON_PARAMETERS
    files = new.settings.get("parameters", "").count(".y")  # ".yaml" and ".yml"
    return parameters[0] == parameters[1] and len(names) + max(files - 1, 0) >= _MINCOMMON_PARAMETERS


def _has_other_partner(old: Entry, new: Entry, outlines: tuple[LaunchOutline, LaunchOutline]) -> bool:
    """Return whether a new node has the name of another node of the old file, or of a program besides its component."""
    name = new.settings.get("name")
    before = (entry for entry in outlines[0].entries if entry is not old)
    beside = (entry for entry in outlines[1].entries if "::" in new.name and "::" not in entry.name)
    return name is not None and any(
        entry.kind == old.kind and name in (entry.settings.get("name"), _split_program_name(entry)[1])
        for entry in (*before, *beside)
    )


def _have_same_namespace(old: Entry, new: Entry, outlines: tuple[LaunchOutline, LaunchOutline]) -> bool:
    """Return whether two nodes have the same namespace, as they are written or with the defaults of arguments."""
    old_namespace, new_namespace = (entry.settings.get(NAMESPACE, "") for entry in (old, new))
    resolved = outlines[0].resolve(old_namespace), outlines[1].resolve(new_namespace)
    return old_namespace == new_namespace or resolved[0].strip("/") == resolved[1].strip("/")


def _start_simulator(old: Entry, new: Entry) -> bool:
    """Return whether two includes start a simulator in the same way, such as by the launch files of Gazebo.

    One of the files may belong to the repository.
    """
    names = [_SIMULATOR_FILE.search(entry.name) for entry in (old, new)]
    return old.kind == "include" and all(names) and _have_common_arguments(old, new, is_same_package=False)


def _have_common_arguments(old: Entry, new: Entry, *, is_same_package: bool, is_same_context: bool = True) -> bool:
    """Return whether two includes replace each other: they pass mostly equal arguments in the same context.

    Args:
        old: the include of the old version.
        new: the include of the new version.
        is_same_package: whether different files of one package are meant. Otherwise, all arguments may be equal, too.
        is_same_context: whether the condition and namespace must be the same.
    """
    packages = {match[0] if (match := _PACKAGE_FOLDER.match(entry.name)) else "" for entry in (old, new)}
    common_arguments = old.settings.items() & new.settings.items()
    common_arguments = {(name, value) for name, value in common_arguments if name not in _CONTEXT_SETTINGS}
    argument_count = len(old.settings.keys() - _CONTEXT_SETTINGS)
    has_same_context = all(old.settings.get(name) == new.settings.get(name) for name in _CONTEXT_SETTINGS)
    has_equal_arguments = not is_same_package and 0 < argument_count == len(common_arguments)
    has_common_arguments = has_equal_arguments or len(common_arguments) >= max(
        _MIN_COMMON_ARGUMENTS, argument_count * _MIN_SHARE_OF_COMMON_ARGUMENTS
    )
    is_in_package = "" not in packages and (len(packages) == 1 or not is_same_package)
    has_context = has_same_context or not is_same_context
    return old.kind == "include" and is_in_package and has_context and has_common_arguments


def _compute_parameter_score(old: Entry, new: Entry) -> float:
    """Return a score for how certainly a server parameter was renamed; 0 if it was not.

    Many parameters have values such as ``true``, so an equal value is not enough.
    """
    if old.settings != new.settings:
        return 0.0
    if f"/{old.name}".endswith(f"/{new.name}") or f"/{new.name}".endswith(f"/{old.name}"):
        return 3.0  # another namespace
    old_words, new_words = (sorted(filter(None, _SEPARATORS.split(entry.name))) for entry in (old, new))
    name_similarity = compute_name_similarity(old.name, new.name)
    if old_words == new_words:
        return 2.0
    return name_similarity if name_similarity >= _MIN_SIMILARITY_OF_PROGRAMS else 0.0


def _chooses_file(path: str, fixed_path: str) -> bool:
    """Return whether a path chooses a file by arguments, such as the file of a fixed path."""
    folder, _, name = path.rpartition("/")
    fixed_folder, _, fixed_name = fixed_path.rpartition("/")
    pieces = _VARIABLE.split(name)
    if folder != fixed_folder or len(pieces) == 1 or "$(" in fixed_name:
        return False
    return re.fullmatch(".+".join(map(re.escape, pieces)), fixed_name) is not None


def compute_name_similarity(old: str, new: str) -> float:
    """Return the similarity of two names, from 0 to 1.

    Separators and the word ``node`` do not count.
    """
    old_word, new_word = (_SEPARATORS.sub("", text.lower()) for text in (old, new))
    return SequenceMatcher(None, old_word, new_word, autojunk=False).ratio()


def _split_program_name(entry: Entry) -> tuple[str, str]:
    package, _, program = entry.name.partition("/")
    return package, program.removesuffix(".py")


def get_launch_file_stem(path: str) -> str:
    """Return the name of a launch file without endings such as ``.launch.py``."""
    name = PurePosixPath(path).name
    return re.sub(r"[._]launch(\.(py|xml|ya?ml))?$|\.(py|xml|ya?ml)$", "", name)


def _group_by_name(entries: Sequence[Entry]) -> dict[tuple[str, str], list[Entry]]:
    groups: dict[tuple[str, str], list[Entry]] = {}
    for entry in entries:
        groups.setdefault((entry.kind, "" if entry.kind == "process" else entry.name), []).append(entry)
    return groups


def find_loaded_class(entry: Entry) -> str | None:
    """Return the class that a nodelet loads, or None for another action."""
    match = _LOADED_NODELET.match(entry.settings.get("arguments", "")) if entry.name == "nodelet/nodelet" else None
    return None if match is None else match[1]


def _load_different_classes(old: Entry, new: Entry) -> bool:
    """Return whether two nodelets load different classes."""
    classes = {loaded for entry in (old, new) if (loaded := find_loaded_class(entry)) is not None}
    return old.name == new.name == "nodelet/nodelet" and len(classes) > 1


def _match_group(old: list[Entry], new: list[Entry]) -> Iterator[Match]:
    """Yield the pairs of matched entries of a group.

    An entry without a partner is paired with None.

    Equal entries are matched first, then those that differ only in their conditions, then those with the same node
    name, then those that serve the same names, and then the most similar ones.
    """
    remaining_old, remaining_new = list(old), list(new)
    pairs: list[tuple[Entry, Entry]] = []
    criteria: tuple[Callable[[Entry, Entry], bool], ...] = (
        _are_equal,
        _differ_only_in_condition,
        _have_same_node_name,
        _serve_same_names,
    )
    for is_match in criteria:
        for entry in tuple(remaining_new):
            partner = next((old_entry for old_entry in remaining_old if is_match(old_entry, entry)), None)
            if partner is not None:
                remaining_old.remove(partner)
                remaining_new.remove(entry)
                pairs.append((partner, entry))
    candidates = sorted(
        (
            (_compute_settings_similarity(old_entry, entry), i, k)
            for i, old_entry in enumerate(remaining_old)
            for k, entry in enumerate(remaining_new)
        ),
        key=lambda item: (-item[0], item[1], item[2]),
    )
    unpaired_old, unpaired_new = set(range(len(remaining_old))), set(range(len(remaining_new)))
    for similarity, i, k in candidates:
        if remaining_new[k].kind == "process" and similarity < MIN_SIMILARITY:
            continue
        if _load_different_classes(remaining_old[i], remaining_new[k]):
            continue
        if i in unpaired_old and k in unpaired_new:
            unpaired_old.remove(i)
            unpaired_new.remove(k)
            pairs.append((remaining_old[i], remaining_new[k]))
    yield from sorted(pairs, key=lambda item: new.index(item[1]))
    yield from ((None, remaining_new[k]) for k in sorted(unpaired_new))
    yield from ((remaining_old[i], None) for i in sorted(unpaired_old))


def _are_equal(old: Entry, new: Entry) -> bool:
    return old.settings == new.settings and _get_commands(old) == _get_commands(new)


def _differ_only_in_condition(old: Entry, new: Entry) -> bool:
    settings = [{**entry.settings, CONDITION: ""} for entry in (old, new)]
    return settings[0] == settings[1] and _get_commands(old) == _get_commands(new)


def _get_commands(entry: Entry) -> list[str]:
    return [entry.name] if entry.kind == "process" else []


def _have_same_node_name(old: Entry, new: Entry) -> bool:
    return "name" in new.settings and old.settings.get("name") == new.settings["name"]


def _serve_same_names(old: Entry, new: Entry) -> bool:
    names = find_served_names(new)
    return bool(names) and find_served_names(old) == names


def _stops(spawner: str) -> bool:
    """Return whether a spawner stops controllers."""
    return "unspawner" in spawner


def _compute_settings_similarity(old: Entry, new: Entry) -> float:
    """Return the similarity of the settings, and of the commands of processes, from 0 to 1."""
    old_words, new_words = (
        " ".join([*(f"{name}={value}" for name, value in entry.settings.items()), *_get_commands(entry)]).split()
        for entry in (old, new)
    )
    return SequenceMatcher(None, old_words, new_words, autojunk=False).ratio()
