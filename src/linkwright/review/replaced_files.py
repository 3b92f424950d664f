"""Find launch files, parameter files, worlds and sources that git does not recognize as renamed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Sequence
from difflib import SequenceMatcher
from pathlib import PurePosixPath

from linkwright.files.git_repository import ChangedFile
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.yaml_values import read_yaml_text, read_yaml_values
from linkwright.review.files.worlds.comparing import read_world_models
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.versions import Version, Versions

_WORLD_SUFFIXES = (".world", ".sdf")
_YAML_SUFFIXES = (".yaml", ".yml")
_SEPARATOR = re.compile(r"[_-]")
_PYTHON_CLASS = re.compile(r"^class\s+(\w+)", re.MULTILINE)
_CPP_CLASS = re.compile(
    r"^[ \t]*(?:class|struct)\s+(?:[A-Z]\w*_[A-Z]+\s+)?(\w+)\s*(?:final\s*)?(?::(?!:)[^;{]*)?\{", re.MULTILINE
)
_CPP_METHOD = re.compile(r"^(?!\s)[^;{}()#\n]*?\b(\w+)\s*(?:<[^<>;{}()]*>)?\s*::\s*~?\w+\s*\(", re.MULTILINE)
_MIN_NAME_SIMILARITY = 0.7
_MIN_SHARE_OF_VALUES = 0.8
"""The minimum share of the values of the smaller file that both files have."""
_MIN_VALUES = 6
_MAX_FILES = 20
"""The maximum number of removed or added files of a kind that are compared with each other."""
_Contents = Counter[Hashable]
"""The programs that a launch file starts, or the values of a parameter file."""


def join_replaced_files(versions: Versions, files: Sequence[ChangedFile]) -> list[ChangedFile]:
    """Return the changed files, with a removed and an added file with alike names and contents as one renamed file.

    Git recognizes renamed files by the share of equal lines, also if the added one lacks many of them. Launch files of
    a folder are one if they start the same programs, and worlds if they have the same models; parameter files of a
    package, if one has nearly all values of the other one, and its sources, if both define a class.
    """
    pairs: dict[str, str] = {}
    for is_candidate, read, are_alike, get_group in (
        (is_launch_file, _read_programs, _have_equal_keys, _get_folder),
        (_is_parameter_file, _read_values, _have_common_values, _get_package),
        (_is_world, _read_models, _have_equal_keys, _get_folder),
        (_is_header, _read_classes, _have_common_keys, _get_package),
        (_is_cpp_source, _read_classes, _have_common_keys, _get_package),
        (_is_python_source, _read_classes, _have_common_keys, _get_package),
    ):
        removed = [file.old_path for file in files if file.old_path and not file.new_path and is_candidate(file.path)]
        added = [file.new_path for file in files if file.new_path and not file.old_path and is_candidate(file.path)]
        if not removed or not added or max(len(removed), len(added)) > _MAX_FILES:
            continue
        pairs |= _pair_files(
            [(path, get_group(versions.old, path), read(versions.old, path)) for path in removed],
            [(path, get_group(versions.new, path), read(versions.new, path)) for path in added],
            are_alike,
        )
    joined = (
        ChangedFile(file.old_path, pairs[file.old_path]) if file.old_path in pairs and not file.new_path else file
        for file in files
    )
    return [file for file in joined if file.old_path or file.new_path not in pairs.values()]


_File = tuple[str, Hashable, _Contents]
"""The path of a file, its group and its contents."""


def _pair_files(
    removed: Sequence[_File], added: Sequence[_File], are_alike: Callable[[_Contents, _Contents], bool]
) -> dict[str, str]:
    """Return the new paths of the replaced files by old path. Those with the most similar names come first."""
    ranked = sorted(_rank_pairs(removed, added, are_alike), key=lambda item: item[0], reverse=True)
    pairs: dict[str, str] = {}
    for _, old_path, new_path in ranked:
        if old_path not in pairs and new_path not in pairs.values():
            pairs[old_path] = new_path
    return pairs


def _rank_pairs(
    removed: Sequence[_File], added: Sequence[_File], are_alike: Callable[[_Contents, _Contents], bool]
) -> Iterator[tuple[float, str, str]]:
    for old_path, old_group, old_contents in removed:
        for new_path, new_group, new_contents in added:
            old_name, new_name = (PurePosixPath(path).name.partition(".")[0] for path in (old_path, new_path))
            old_word, new_word = (_SEPARATOR.sub("", name).casefold() for name in (old_name, new_name))
            similarity = SequenceMatcher(None, old_word, new_word, autojunk=False).ratio()
            has_words_of_other = _have_common_words(old_name, new_name)
            is_close = old_group == new_group and (similarity >= _MIN_NAME_SIMILARITY or has_words_of_other)
            if is_close and are_alike(old_contents, new_contents):
                yield similarity, old_path, new_path


def _have_common_words(old_name: str, new_name: str) -> bool:
    """Return whether one of two names is the other one with more words before or after it."""
    shorter, longer = sorted((f"_{name.replace('-', '_')}_" for name in (old_name, new_name)), key=len)
    return longer.startswith(shorter) or longer.endswith(shorter)


def _is_world(path: str) -> bool:
    return path.endswith(_WORLD_SUFFIXES)


def _read_models(version: Version, path: str) -> _Contents:
    return Counter(read_world_models(version, path))


def _is_header(path: str) -> bool:
    return path.endswith(HEADER_SUFFIXES)


def _is_cpp_source(path: str) -> bool:
    return path.endswith(CPP_SUFFIXES) and not _is_header(path)


def _is_python_source(path: str) -> bool:
    return path.endswith(PYTHON_SUFFIX)


def _read_classes(version: Version, path: str) -> _Contents:
    """Return the classes that a source defines, or whose functions it defines."""
    text = version.text(path)
    if path.endswith(PYTHON_SUFFIX):
        return Counter(_PYTHON_CLASS.findall(text))
    text = blank_comments(text)
    return Counter([*_CPP_CLASS.findall(text), *_CPP_METHOD.findall(text)])


def _have_common_keys(old: _Contents, new: _Contents) -> bool:
    return not old.keys().isdisjoint(new.keys())


def _is_parameter_file(path: str) -> bool:
    return path.endswith(_YAML_SUFFIXES) and not is_launch_file(path)


def _get_folder(version: Version, path: str) -> Hashable:
    return version.package_of(path), PurePosixPath(path).parent


def _get_package(version: Version, path: str) -> Hashable:
    return version.package_of(path)


def _read_programs(version: Version, path: str) -> _Contents:
    outline = try_read_outline(version, path)
    return Counter() if outline is None else Counter(entry.name for entry in outline.entries if entry.kind == "node")


def _have_equal_keys(old: _Contents, new: _Contents) -> bool:
    return bool(old) and old.keys() == new.keys()


def _read_values(version: Version, path: str) -> _Contents:
    try:
        values = read_yaml_values(read_yaml_text(version.file(path)))
    except (UnreadableFileError, OSError, ValueError):
        return Counter()
    return Counter((name, value.text) for name, value in values.items())


def _have_common_values(old: _Contents, new: _Contents) -> bool:
    size = min(old.total(), new.total())
    return size >= _MIN_VALUES and (old & new).total() >= _MIN_SHARE_OF_VALUES * size
