"""Find launch files that pass an argument which a description no longer declares, or never declared."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.parts.include_graph import IncludeGraph
from linkwright.review.parts.unused_arguments import is_unused_argument, reads_argument
from linkwright.review.texts.name_words import split_name
from linkwright.review.versions import TEST_FOLDERS, Versions

_SUFFIX = ".xacro"
_PROGRAM = "xacro"


def find_lost_description_arguments(
    versions: Versions, changed_files: Sequence[ChangedFile]
) -> Iterator[tuple[str, Change]]:
    """Yield the launch files that pass such an argument to a description, each with a change.

    An argument that the old description declared but did not use had no effect before either.
    """
    changed = [
        (file.old_path, file.new_path)
        for file in changed_files
        if file.old_path and file.new_path and file.new_path.endswith(_SUFFIX) and not file.is_submodule
    ]
    if not changed:
        return
    graphs = IncludeGraph(versions.old), IncludeGraph(versions.new)
    told = set()
    for old_path, new_path in changed:
        names = _find_lost_names(*graphs, old_path, new_path)
        for robot in graphs[1].find_robots_with(new_path) if names else ():
            lost = [name for name in names if not _declares(graphs[1], robot, name)]
            for argument_set in versions.new.checker().argument_sets(versions.new.file(robot), ()) if lost else ():
                span = argument_set.span
                caller = None if span is None or argument_set.is_offered else versions.new.relative(span.file)
                if span is None or caller is None or not TEST_FOLDERS.isdisjoint(PurePosixPath(caller).parts):
                    continue
                for name in lost:
                    if name in argument_set.values and (caller, robot, name) not in told:
                        told.add((caller, robot, name))
                        yield caller, _make_change(name, robot, Location(caller, span.line, span.column))


def find_undeclared_description_arguments(
    versions: Versions, changed_files: Sequence[ChangedFile]
) -> Iterator[tuple[str, Change]]:
    """Yield the changed launch files that newly pass an argument which the description neither declares nor reads.

    If the description includes a file that does not exist, that file may declare the argument. Then only an argument
    counts whose name the description has with a further word, such as ``use_gpu`` instead of ``gpu``.
    """
    changed = {
        file.new_path: versions.old.text(file.old_path)
        for file in changed_files
        if file.old_path and file.new_path and not file.is_submodule and is_launch_file(file.new_path)
    }
    texts = {path: text for path in changed if _PROGRAM in (text := versions.new.text(path))}
    if not texts:
        return
    graph = IncludeGraph(versions.new)
    names = {PurePosixPath(robot).name: robot for robot, _ in graph.iterate_outlines() if robot.endswith(_SUFFIX)}
    for robot in (robot for name, robot in names.items() if any(name in text for text in texts.values())):
        for argument_set in versions.new.checker().argument_sets(versions.new.file(robot), ()):
            span = argument_set.span
            caller = None if span is None or argument_set.is_offered else versions.new.relative(span.file)
            if span is None or caller is None or caller not in texts:
                continue
            for name in argument_set.values:
                word = re.compile(rf"(?<!\w){re.escape(name)}(?!\w)")
                if word.search(changed[caller]) is None and not _declares(graph, robot, name):
                    similar = _find_similar_argument(graph, robot, name)
                    if similar is not None or is_unused_argument(graph, robot, name):
                        location = Location(caller, span.line, span.column)
                        yield caller, _make_undeclared_change(name, robot, similar, location)


def _find_similar_argument(graph: IncludeGraph, robot: str, name: str) -> str | None:
    """Return the only argument of a description whose name has further words; None if it reads the name itself."""
    words = set(split_name(name))
    found = [other for other in dict(graph.iterate_outlines())[robot].arguments if words < set(split_name(other))]
    return found[0] if len(found) == 1 and not reads_argument(graph, robot, name) else None


def _find_lost_names(old: IncludeGraph, new: IncludeGraph, old_path: str, new_path: str) -> list[str]:
    """Return the arguments that only the old version of a file declares and uses."""
    outline = dict(old.iterate_outlines()).get(old_path)
    return [
        name
        for name in (outline.arguments if outline is not None else ())
        if not _declares(new, new_path, name) and not is_unused_argument(old, old_path, name)
    ]


def _declares(graph: IncludeGraph, path: str, name: str) -> bool:
    return graph.declares(path, lambda outline: name in outline.arguments)


def _make_change(name: str, robot: str, location: Location) -> Change:
    text = phrase("passes '{name}' to '{file}', which no longer has the argument", name=name, file=robot)
    return Change(text, Effect.BREAKING, phrase("the value has no effect"), location)


def _make_undeclared_change(name: str, robot: str, similar: str | None, location: Location) -> Change:
    text = phrase("passes '{name}' to '{file}', which has no such argument", name=name, file=robot)
    if similar is not None:
        text = phrase("{change}, but '{similar}'", change=text, similar=similar)
    return Change(text, Effect.BREAKING, phrase("the value has no effect"), location)
