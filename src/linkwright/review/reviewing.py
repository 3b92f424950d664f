"""Review a range of commits: find the affected files, and compare both versions of each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property, partial
from multiprocessing import get_context
from pathlib import PurePosixPath
from typing import Any, TypeVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, shows_absolute_paths
from linkwright.files.git_repository import ChangedFile
from linkwright.lint.affected import TextFiles, may_be_read
from linkwright.lint.targets import Targets, find_included_robots, find_targets, is_plain_robot
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST, package_name
from linkwright.review.behavior import compare_behavior
from linkwright.review.build_types import is_unused_cmake_file
from linkwright.review.caching import forget_cached_results
from linkwright.review.changes import (
    Change,
    Effect,
    PathChange,
    Review,
    Subject,
    SubjectKind,
)
from linkwright.review.failures import Failures
from linkwright.review.file_comparison import compare_file
from linkwright.review.file_pair import Drawings
from linkwright.review.files.build.cmake_files import CMAKE_FILE, CMAKE_SUFFIX
from linkwright.review.files.build.dependency_lists import is_repository_list
from linkwright.review.files.build.rosbuild_manifests import compare_rosbuild_manifests
from linkwright.review.files.maps import find_map_of_image, is_map
from linkwright.review.files.mesh_groups import group_meshes
from linkwright.review.files.parameters.configurations import is_configuration
from linkwright.review.files.plugin_files import compare_plugin_files
from linkwright.review.files.worlds.comparing import is_other_world
from linkwright.review.files.worlds.templates import is_template
from linkwright.review.findings.comparing import Findings, compare_findings, find_findings, find_findings_singly
from linkwright.review.findings.failing import mark_failures
from linkwright.review.findings.hidden import drop_hidden_findings
from linkwright.review.findings.renamed import drop_renamed_findings
from linkwright.review.findings.unfixed import drop_unfixed_findings
from linkwright.review.kinds import (
    LAUNCH_FILE,
    LAUNCH_HELPER,
    LAUNCH_TEST,
    MAP,
    PARAMETERS,
    REPOSITORIES,
    SEMANTIC_XACRO,
    KindRule,
    find_rule,
    find_rule_by_contents,
    may_help_launch_files,
)
from linkwright.review.launch_paths import (
    LAUNCH_TEMPLATE_SUFFIXES,
    contains_actions,
    is_launch_xml,
    is_launch_yaml,
    is_other_launch,
)
from linkwright.review.launches.formats import join_format_changes
from linkwright.review.launches.programs.missing import drop_told_findings
from linkwright.review.launches.python.helpers import imports_actions
from linkwright.review.notes import (
    group_equal_problems,
    group_unexpanded,
    is_unreadable_as_before,
    make_checkout_notes,
    make_generated_notes,
    make_missing_notes,
    make_submodule_note,
    make_unreadable_notes,
)
from linkwright.review.other_files import find_file_states
from linkwright.review.parts import compare_parts
from linkwright.review.parts.expanded import find_read_files
from linkwright.review.removed_headers import drop_told_headers
from linkwright.review.removed_packages import (
    find_removed_packages,
    is_removed_with_package,
    merge_removed_packages,
)
from linkwright.review.removed_programs import merge_removed_options
from linkwright.review.renames.folders import merge_renamed_folders
from linkwright.review.renames.moved_topics import merge_moved_topics
from linkwright.review.renames.packages import find_renamed_packages, match_moved_files, remove_consequences
from linkwright.review.replaced_files import join_replaced_files
from linkwright.review.required_packages import is_named
from linkwright.review.robots.semantics import find_semantic_files
from linkwright.review.sources.comparing import source_subjects
from linkwright.review.texts.folders import review_without_folder
from linkwright.review.texts.secrets import hide_secrets
from linkwright.review.unchanged_contents import keeps_contents
from linkwright.review.undeclared_packages import mark_undeclared, tell_missing_once
from linkwright.review.users.followed_joints import relieve_followed_joints
from linkwright.review.users.ignored_packages import relieve_ignored_packages
from linkwright.review.users.left_collision_pairs import find_left_collision_pairs
from linkwright.review.users.left_robot_names import find_left_robot_names
from linkwright.review.users.lost_files import find_lost_files
from linkwright.review.users.references import find_lost_references
from linkwright.review.users.searches import SEARCHES
from linkwright.review.versions import Version, Versions

_Pair = tuple[KindRule, "str | None", "str | None"]
"""The rule for a file, its old path and its new path."""
_Result = TypeVar("_Result")
_MIN_PARALLEL_DESCRIPTIONS = 4
"""The minimum number of descriptions that are compared by several processes."""
_LISTED_KINDS = (
    *(SubjectKind.BUILD, SubjectKind.MANIFEST, SubjectKind.LAUNCH_FILE, SubjectKind.PARAMETERS),
    SubjectKind.DEPENDENCIES,
)
"""The kinds whose files are listed with the other files if no difference is found, as are SDF templates."""
_EXPANDED_KINDS = (SubjectKind.DESCRIPTION, SubjectKind.WORLD)
"""The kinds that include other files. Parts of them are not compared on their own."""


def review(
    versions: Versions,
    packages: Sequence[str] = (),
    workers: int = 1,
    scenarios: Sequence[str] = (),
    seeds: int | None = None,
    *,
    with_images: bool = False,
    with_scenes: bool = False,
) -> Review:
    """Compare two versions of a repository.

    Args:
        versions: both versions of the repository.
        packages: the names or folders of the packages to which the review is limited; empty for all files.
        workers: the number of parallel processes.
        scenarios: scenarios to run in both versions, relative to the root. They run code of the repository.
        seeds: the number of seeds of scenarios; None for the number in each scenario.
        with_images: whether to render images of robots that look different.
        with_scenes: whether to build 3D scenes of robots that look different.

    Raises:
        LinkwrightError: REV103, there is no such package.
    """
    forget_cached_results()
    versions = match_moved_files(versions)
    folders = _find_package_folders(versions, packages)
    drawings = Drawings(images=with_images or with_scenes, scenes=with_scenes)
    token = shows_absolute_paths.set(True)
    try:
        result = _Reviewer(versions, folders, drawings).run(workers)
        behavior = [compare_behavior(versions, path, seeds) for path in scenarios]
    finally:
        shows_absolute_paths.reset(token)
    result = replace(
        result,
        subjects=[*result.subjects, *(subject for subject in behavior if not subject.is_empty)],
        other_files=[path for path in result.other_files if path not in scenarios],
    )
    for version in (versions.old, versions.new):
        result = review_without_folder(result, version.root, version.shares)
    return hide_secrets(versions, result)


class _Reviewer:
    def __init__(self, versions: Versions, folders: Sequence[str], drawings: Drawings) -> None:
        self._versions = versions
        self._drawings = drawings
        self._folders = folders
        changed_files = join_replaced_files(versions, join_format_changes(versions.changed_files))
        self._changed_files = [file for file in changed_files if self._is_in_scope(file.path)]
        self._new_paths = {
            file.old_path: file.new_path for file in self._changed_files if file.old_path and file.new_path
        }
        self._failures = Failures()
        self._maps = dict(self._run_step(_find_maps_of_images))

    def _run_step(self, step: Callable[[Versions, Sequence[ChangedFile]], Iterable[_Result]]) -> list[_Result]:
        """Return the results of a step for the changed files.

        Files that make the step fail get a problem.
        """
        return self._failures.run_step(step, self._versions, self._changed_files)

    @cached_property
    def _complete_paths(self) -> dict[bool, set[str]]:
        """The paths of the complete descriptions and worlds, by `Version.is_old`."""
        versions = (self._versions.old, self._versions.new)
        return {version.is_old: _find_targets(version) | self._find_plain_robots(version) for version in versions}

    def run(self, workers: int) -> Review:
        pairs = list(self._find_pairs())
        expanded = [pair for pair in pairs if pair[0].kind in _EXPANDED_KINDS]
        with _open_process_pool(workers if len(expanded) >= _MIN_PARALLEL_DESCRIPTIONS else 1) as submit:
            subjects = [submit(compare_file, self._versions, *pair, self._drawings) for pair in pairs]
            findings = [
                submit(find_findings, version, self._make_check_targets(version, expanded))
                for version in (self._versions.old, self._versions.new)
            ]
            all_subjects = self._add_other_subjects([result() for result in subjects])
            old_findings, new_findings = self._collect_findings(findings, expanded)
        all_subjects = self._add_failures(all_subjects)
        all_subjects = compare_parts(self._versions, self._changed_files, all_subjects, self._is_complete)
        all_subjects = relieve_ignored_packages(self._versions, all_subjects)
        moved = {subject.path: subject.changes[0].sentence for subject in all_subjects if _is_only_moved(subject)}
        all_subjects = [subject for subject in all_subjects if subject.path not in moved]
        reported = _list_reported_paths(all_subjects)
        all_subjects, notes = remove_consequences(self._versions, all_subjects)
        all_subjects = relieve_followed_joints(self._add_users_of_lost_names(all_subjects))
        changed = {path for file in self._changed_files for path in (file.old_path, file.new_path)}
        removed_packages = find_removed_packages(all_subjects)
        all_subjects = merge_removed_packages(self._versions, all_subjects)
        all_subjects = merge_renamed_folders(self._versions, all_subjects)
        unreadable = [subject for subject in all_subjects if is_unreadable_as_before(subject, changed)]
        readable, equal_notes = group_equal_problems([subject for subject in all_subjects if subject not in unreadable])
        readable, unexpanded_notes = group_unexpanded(readable)
        compared = {path for rule, *paths in pairs if rule.kind not in _LISTED_KINDS for path in paths if path}
        reported |= {path for path in compared if not is_template(path)}
        reported |= self._maps.keys() | find_read_files(self._versions, all_subjects)
        other_files = [
            file
            for file in self._changed_files
            if file.path in moved or not {file.old_path, file.new_path} & reported
            if not is_removed_with_package(self._versions, removed_packages, file)
            if not keeps_contents(self._versions, file)
        ]
        added, fixed = compare_findings(self._versions, old_findings, new_findings, self._new_paths)
        added = drop_hidden_findings(self._versions, added)
        added, fixed = drop_renamed_findings(all_subjects, added, fixed, self._new_paths)
        fixed = drop_unfixed_findings(self._versions, fixed, added, self._new_paths)
        readable, added = mark_undeclared(self._versions, readable, drop_told_findings(readable, added))
        readable, added = tell_missing_once(self._versions.new, readable, added)
        readable, added = mark_failures(self._versions, readable, added, fixed, old_findings.diagnostics)
        return Review(
            self._versions.old.name,
            self._versions.new.name,
            group_meshes([subject for subject in readable if not subject.is_empty]),
            [file.path for file in other_files],
            {**find_file_states(self._versions, other_files), **moved},
            added,
            fixed,
            list(
                dict.fromkeys(
                    [
                        *(*notes, *self._make_notes(), *make_missing_notes(all_subjects), *equal_notes),
                        *unexpanded_notes,
                        *(*make_unreadable_notes(unreadable), *self._failures.notes),
                    ]
                )
            ),
        )

    def _add_users_of_lost_names(self, subjects: Sequence[Subject]) -> list[Subject]:
        """Return the subjects with the files that still name a frame or joint which others have lost."""
        users = self._run_step(lambda versions, _: find_left_robot_names(versions, subjects))
        users += self._run_step(lambda versions, _: find_left_collision_pairs(versions.new, subjects))
        return sorted(_add_changes(subjects, users), key=lambda subject: subject.path) if users else list(subjects)

    def _collect_findings(
        self, results: Sequence[Callable[[], Findings]], expanded: Sequence[_Pair]
    ) -> tuple[Findings, Findings]:
        """Return the findings of both versions.

        Files and packages whose check fails are left out of both.
        """
        try:
            old, new = (result() for result in results)
        except Exception:  # noqa: BLE001 - the other files are still checked
            sides = [
                (version, self._make_check_targets(version, expanded))
                for version in (self._versions.old, self._versions.new)
            ]
            no_findings = Findings([], frozenset(), frozenset())
            no_failures: dict[str, Exception] = {}
            (old, new), failures = self._failures.attempt(
                lambda: find_findings_singly(sides, self._new_paths), ([no_findings, no_findings], no_failures)
            )
            for path, error in failures.items():
                self._failures.add_missing_findings(path, error)
        return old, new

    def _add_failures(self, subjects: Sequence[Subject]) -> list[Subject]:
        """Return the subjects, with a problem for each file that could not be compared."""
        result = {subject.path: subject for subject in subjects}
        changed = {file.path: file for file in self._changed_files}
        for path, problem in self._failures.problems.items():
            rule = find_rule(path)
            file = changed.get(path, ChangedFile(path, path))
            kind = SubjectKind.SOURCE if rule is None else rule.kind
            subject = result.get(path, Subject(kind, path, file.old_path, file.new_path))
            if not any(known.is_bug for known in subject.problems):
                result[path] = replace(subject, problems=[*subject.problems, problem])
        return sorted(result.values(), key=lambda subject: subject.path)

    def _add_other_subjects(self, subjects: Sequence[Subject]) -> list[Subject]:
        """Return the subjects with those that other steps add, such as sources.

        Changes about broken paths and callers are added to the subjects.
        """
        lost: dict[str, list[Change]] = {}
        for path, change in self._run_step(find_lost_references):
            lost.setdefault(path, []).append(change)
        result = [replace(subject, changes=[*subject.changes, *lost.pop(subject.path, ())]) for subject in subjects]
        result = _add_changes(result, self._run_step(find_lost_files))
        for path, changes in lost.items():
            result.append(Subject(SubjectKind.LAUNCH_FILE, path, self._find_old_path(path), path, changes))
        result += self._run_step(compare_plugin_files)
        result += self._find_removed_submodules()
        result += self._run_step(compare_rosbuild_manifests)
        paths = {subject.path for subject in result}
        result += (subject for subject in self._run_step(source_subjects) if subject.path not in paths)
        for search in SEARCHES:
            result = _add_changes(result, self._run_step(search))
        result = merge_moved_topics(merge_removed_options(result), self._versions.new.package_of)
        return sorted(drop_told_headers(result), key=lambda subject: subject.path)

    def _find_removed_submodules(self) -> Iterator[Subject]:
        """Yield the removed submodules, whose contents are unknown.

        One that the files no longer name, although they did, is not breaking, nor is one without an entry in
        ``.gitmodules``, whose files no clone of the repository has.
        """
        reason_of_use = phrase("packages and programs that use the files in it do not build or start")
        for file in self._changed_files:
            if self._is_removed_submodule(file):
                name = PurePosixPath(file.path).name
                is_dropped = is_named(self._versions.old, name) and not is_named(self._versions.new, name)
                text = phrase("submodule removed")
                if file.path not in self._versions.old.submodules:
                    text, is_dropped = phrase("submodule without an entry in .gitmodules removed"), True
                effect, reason = (Effect.CHANGED, None) if is_dropped else (Effect.BREAKING, reason_of_use)
                change = Change(text, effect, reason)
                yield Subject(SubjectKind.MANIFEST, file.path, file.old_path, None, [change])

    def _is_removed_submodule(self, file: ChangedFile) -> bool:
        """Return whether the new version has neither the submodule nor files at its path.

        A renamed package has them in its new folder.
        """
        if not file.is_submodule or file.new_path is not None:
            return False
        moved = (package.new_path(file.path) for package in find_renamed_packages(self._versions))
        return not any(self._versions.new.file(path).is_dir() for path in (file.path, *filter(None, moved)))

    def _is_complete(self, path: str) -> bool:
        """Return whether a path is a complete description or world in one of the versions."""
        return any(path in targets for targets in self._complete_paths.values())

    def _is_in_scope(self, path: str) -> bool:
        return not self._folders or any(PurePosixPath(path).is_relative_to(folder) for folder in self._folders)

    def _find_plain_robots(self, version: Version) -> set[str]:
        """Return the changed URDF files that are included by xacro files but valid on their own."""
        paths = (file.old_path if version.is_old else file.new_path for file in self._changed_files)
        return {path for path in paths if path and is_plain_robot(version.file(path))}

    # --- compared files ---------------------------------------------------------------------------------------------

    def _find_pairs(self) -> Iterator[_Pair]:
        """Yield the files to compare: the rule of the kind, the old path and the new path."""
        affected_old, affected_new = self._find_affected()
        paths: set[tuple[str | None, str | None]] = {(path, self._find_new_path(path)) for path in affected_old}
        paths |= {(self._find_old_path(path), path) for path in affected_new}
        for file in self._changed_files:
            try:
                rule = self._choose_rule(file.old_path, file.new_path)
            except Exception as error:  # noqa: BLE001 - the other files are still compared
                self._failures.add(file.path, error)
                continue
            if file.path in self._maps:
                paths.add((self._find_old_path(self._maps[file.path]), self._find_new_path(self._maps[file.path])))
                continue
            build_paths = self._find_package_build_file(file)
            if rule is None and build_paths is not None and self._is_used(file):
                paths.add(build_paths)
            if rule is None or rule is SEMANTIC_XACRO or rule.kind in _EXPANDED_KINDS or file.is_submodule:
                continue
            if self._belongs_to_robot(rule, file):
                paths.add(build_paths or (file.old_path, file.new_path))
        for old_path, new_path in sorted(paths, key=lambda pair: (pair[1] or pair[0] or "", pair[0] or "")):
            path = new_path or old_path or ""
            rule = None if path in self._failures.problems else self._choose_rule(old_path, new_path)
            if rule is not None:
                yield rule, old_path, new_path

    def _choose_rule(self, old_path: str | None, new_path: str | None) -> KindRule | None:
        """Return the rule for a file, or None if the file is not compared."""
        path = new_path or old_path or ""
        rule = find_rule(path)
        sides = ((self._versions.old, old_path), (self._versions.new, new_path))
        files = [version.file(name) for version, name in sides if name]
        if rule is not None and rule.kind is SubjectKind.LAUNCH_FILE and path.endswith((".yaml", ".yml")):
            rule = rule if any(is_launch_yaml(file) for file in files) else PARAMETERS
        if rule is not None and rule.kind is SubjectKind.PARAMETERS:
            if all(is_repository_list(version.text(name)) for version, name in sides if name):
                return REPOSITORIES
            return MAP if any(is_map(file) for file in files) else rule
        if rule is not None and all(is_other_world(file) or is_other_launch(file) for file in files):
            return None
        if rule is None and path.endswith(LAUNCH_TEMPLATE_SUFFIXES):
            is_launch = all(is_launch_xml(file) for file in files)
            return LAUNCH_FILE if is_launch else None
        if rule is None and any(is_launch_xml(file) for file in files):
            return LAUNCH_TEST if path.endswith(LAUNCH_TEST.suffixes) else LAUNCH_FILE
        rule = rule or find_rule_by_contents(files)
        if rule is None and may_help_launch_files(path):
            if any(contains_actions(version, name) for version, name in sides if name):
                return LAUNCH_FILE
            is_helper = any(imports_actions(file) for file in files)
            return LAUNCH_HELPER if is_helper else None
        return rule

    def _find_package_build_file(self, file: ChangedFile) -> tuple[str, str] | None:
        """Return both paths of the package's ``CMakeLists.txt`` for one in a subfolder or a file to include.

        The result is None for other files.
        """
        path = PurePosixPath(file.path)
        folder = self._versions.new.package_of(file.path, (MANIFEST, ROSBUILD_MANIFEST))
        if folder is None or not (path.name == CMAKE_FILE or path.suffix == CMAKE_SUFFIX):
            return None
        new_path = (PurePosixPath(folder) / CMAKE_FILE).as_posix()
        old_path = self._find_old_path(new_path)
        if old_path is None or new_path == file.path or not self._versions.new.file(new_path).is_file():
            return None
        if path.suffix == CMAKE_SUFFIX and is_unused_cmake_file(self._versions.new, new_path):
            return None
        return old_path, new_path

    def _belongs_to_robot(self, rule: KindRule, file: ChangedFile) -> bool:
        """Return whether a file belongs to a robot.

        Hidden files, and YAML files that configure no robot, are settings of tools. Build files of CMake in packages
        that are built without it have no effect.
        """
        sides = ((self._versions.old, file.old_path), (self._versions.new, file.new_path))
        if not self._is_used(file):
            return False
        return rule.kind is not SubjectKind.PARAMETERS or any(
            is_configuration(version, path) for version, path in sides if path
        )

    def _is_used(self, file: ChangedFile) -> bool:
        """Return whether a file is not hidden, and no build file that the type of the package leaves out."""
        sides = ((self._versions.old, file.old_path), (self._versions.new, file.new_path))
        is_hidden = any(part.startswith(".") for part in PurePosixPath(file.path).parts)
        return not is_hidden and not all(is_unused_cmake_file(version, path) for version, path in sides if path)

    def _find_affected(self) -> Iterator[set[str]]:
        """Yield the complete descriptions and worlds that changed files can affect, by version."""
        changed = {path for file in self._versions.changed_files for path in (file.old_path, file.new_path) if path}
        changed = {path for path in changed if may_be_read(path)}
        if not changed:
            yield from (set(), set())
            return
        yield from self._failures.attempt(lambda: list(self._search_affected(changed)), [set[str](), set[str]()])

    def _search_affected(self, changed: set[str]) -> Iterator[set[str]]:
        files = None
        for version in (self._versions.old, self._versions.new):
            files = TextFiles(version.root, files, changed)
            candidates = {path for path in self._complete_paths[version.is_old] if self._is_in_scope(path)}
            yield files.affected(changed, candidates)

    def _find_new_path(self, old_path: str) -> str | None:
        path = self._new_paths.get(old_path, old_path)
        return path if self._versions.new.file(path).is_file() else None

    def _find_old_path(self, new_path: str) -> str | None:
        path = next((old for old, new in self._new_paths.items() if new == new_path), new_path)
        return path if self._versions.old.file(path).is_file() else None

    def _make_check_targets(self, version: Version, pairs: Sequence[_Pair]) -> Targets:
        """Return the compared files of a version, and the packages with changed files.

        A package with changed files in one of the versions is checked in both.
        """
        paths = [old_path if version.is_old else new_path for _, old_path, new_path in pairs]
        folders = {
            folder
            for side in (self._versions.old, self._versions.new)
            for file in self._changed_files
            if (changed := file.old_path if side.is_old else file.new_path)
            if (folder := side.package_of(changed)) is not None
        }
        packages = [version.file(folder) for folder in sorted(folders) if (version.file(folder) / MANIFEST).is_file()]
        return Targets(tuple(version.file(path) for path in paths if path), tuple(packages))

    def _make_notes(self) -> Iterator[Phrase]:
        """Yield notes about files that the review did not compare."""
        for file in self._changed_files:
            if file.is_submodule:
                if file.old_path is None:
                    yield phrase("submodule '{path}' added; its files are not compared", path=file.path)
                elif file.new_path is None and not self._is_removed_submodule(file):
                    yield phrase("submodule '{path}' replaced by files of the repository", path=file.path)
                elif file.new_path is not None:
                    yield make_submodule_note(file)
        yield from make_generated_notes(self._versions)
        yield from make_checkout_notes(self._versions)


def _is_only_moved(subject: Subject) -> bool:
    """Return whether a file was only moved, and is installed at the same path as before."""
    path_changes = [change.path_change for change in subject.changes]
    return path_changes == [PathChange.MOVED] and not subject.figures and not subject.problems


def _add_changes(subjects: Sequence[Subject], changes: Iterable[tuple[str, Change]]) -> list[Subject]:
    """Return the subjects with further changes.

    These may be about files that are themselves unchanged.
    """
    result = {subject.path: subject for subject in subjects}
    for path, change in changes:
        rule = find_rule(path)
        subject = result.get(path, Subject(SubjectKind.SOURCE if rule is None else rule.kind, path, path, path))
        result[path] = replace(subject, changes=[*subject.changes, change])
    return list(result.values())


def _list_reported_paths(subjects: Sequence[Subject]) -> set[str]:
    """Return the paths of subjects with changes, and of the files that contain the changes."""
    changes = (change for subject in subjects for change in subject.changes)
    locations = (location for change in changes for location in (change.location, *change.other_locations))
    files = {location.file for location in locations if location is not None}
    return files | {subject.path for subject in subjects if not subject.is_empty}


@contextmanager
def _open_process_pool(count: int) -> Iterator[Callable[..., Callable[[], Any]]]:
    """Yield a function that submits a call to a pool of processes.

    It returns a function that waits for the result.
    """
    if count == 1:
        yield partial
        return
    pool = ProcessPoolExecutor(count, mp_context=get_context("spawn"), initializer=_show_absolute_paths)
    try:
        yield lambda function, *arguments: pool.submit(function, *arguments).result
    finally:
        pool.shutdown(cancel_futures=True)


def _show_absolute_paths() -> None:
    """Make the messages of a process independent of its current folder."""
    shows_absolute_paths.set(True)


def _find_maps_of_images(versions: Versions, files: Sequence[ChangedFile]) -> Iterator[tuple[str, str]]:
    """Yield the paths of changed map images, each with the path of the map's YAML file."""
    for file in files:
        for version, path in ((versions.new, file.new_path), (versions.old, file.old_path)):
            map_path = None if path is None else find_map_of_image(version, path)
            if map_path is not None:
                yield file.path, map_path
                break


def _find_targets(version: Version) -> set[str]:
    """Return the paths of complete descriptions, semantic xacro descriptions and worlds.

    A robot that another description includes also counts as complete if a launch file starts it.
    """
    checker = version.checker()
    started = [file for file in find_included_robots(version.root, version.entered) if checker.calls(file, ())]
    targets = find_targets([version.root], entered=version.entered)
    files = (version.relative(file) for file in (*targets.files, *started))
    return {path for path in files if path is not None} | find_semantic_files(version)


def _find_package_folders(versions: Versions, packages: Sequence[str]) -> list[str]:
    """Return the folders of packages, relative to the root.

    Raises:
        LinkwrightError: REV103, there is no such package.
    """
    if not packages:
        return []
    folders: dict[str, str] = {}
    for version in (versions.old, versions.new):
        for folder in find_targets([version.root]).packages:
            path, name = version.relative(folder), package_name(folder)
            if path is not None and name is not None:
                folders[name] = folders[path] = path
    for package in packages:
        if package.rstrip("/") not in folders:
            message = phrase("neither version has a package '{name}'", name=package)
            raise LinkwrightError(Diagnostic("REV103", message, hint=did_you_mean(package, list(folders))))
    return [folders[package.rstrip("/")] for package in packages]
