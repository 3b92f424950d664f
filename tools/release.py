"""Build a release twice and test it.

A release has wheels, source distributions, bill of materials, changelog and checksums. Everything is built from the
last commit below ``.build/release``, and is then moved to ``dist/``. The wheels and source distributions of linkwright
and linkwright-core are built in two folders, in other time zones, languages, umasks and seconds, and the wheels once
more from the unpacked source distributions. All bytes must be the same. See "Making a release" in CONTRIBUTING.md.

Usage:
    python tools/release.py                  make the release (`make release` provides the required programs)
    python tools/release.py version 0.2.0    begin this version, in CHANGELOG.md and other files with the version
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tarfile
from datetime import datetime, timezone
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bill_of_materials
import lock
import release_notes

ROOT = Path(__file__).resolve().parent.parent
SCRATCH = ROOT / ".build" / "release"
RESULTS = ROOT / "dist"
VERSION = Path("src", "linkwright", "_version.py")
RECIPE = Path("packaging", "conda", "recipe.yaml")
PROJECT = Path("pyproject.toml")
_GENERATED_PATHS = ("src/linkwright/page/built", "src/linkwright/standins/stubs")
_DISTRIBUTION_NAMES = ("linkwright_core", "linkwright")
"""The names of the two distributions in their files, the engine first."""
_OTHER_ENVIRONMENT = (
    {"TZ": "UTC", "LC_ALL": "C", "PYTHONHASHSEED": "1"},
    {"TZ": "Asia/Tokyo", "LC_ALL": "C.UTF-8", "PYTHONHASHSEED": "2"},
)
"""The environments of two builds, which must not affect the result; neither must folders, umasks and times."""


def run_program(*words: str | Path, cwd: Path = ROOT, umask: int = 0o022, **environment: str) -> str:
    """Run a program, and return its output.

    Raises:
        SystemExit: the program fails; its messages are on the terminal.
    """
    result = subprocess.run(
        words, cwd=cwd, env={**os.environ, **environment}, stdout=subprocess.PIPE, text=True, check=False, umask=umask
    )
    if result.returncode:
        raise SystemExit(
            f"{result.stdout}release: `{' '.join(map(str, words))}` failed with status {result.returncode}"
        )
    return result.stdout


def get_commit_time() -> str:
    """Return the time of the last commit in seconds since 1970.

    It is the time of every file in a release.

    Raises:
        SystemExit: there are uncommitted changes, which would not be in the release.
    """
    if changed := run_program("git", "status", "--porcelain"):
        raise SystemExit(f"{changed}release: this is in no commit, and a release is made of the last one: commit first")
    return run_program("git", "log", "-1", "--format=%ct").strip()


def write_sources(folder: Path) -> Path:
    """Write the files of the last commit to a new folder, and return the folder."""
    run_program("git", "checkout-index", "--all", f"--prefix={folder}/")
    return folder


def build_distributions(
    folder: Path, time: str, *kinds: str, umask: int = 0o022, **environment: str
) -> dict[str, Path]:
    """Build distributions of a folder, and return the files by name.

    `kinds` are ``--wheel`` and ``--sdist``.
    """
    results = folder.with_name(f"{folder.name} dist")
    constraints = SCRATCH / "constraints.txt"
    words = ("build", "--quiet", "--no-create-gitignore", "--build-constraints", constraints, *kinds)
    run_program(
        _find_uv(),
        *words,
        "--out-dir",
        results,
        folder,
        umask=umask,
        SOURCE_DATE_EPOCH=time,
        LINKWRIGHT_PINNED_CORE="1",
        **environment,
    )
    return {path.name: path for path in sorted(results.iterdir())}


def unpack_sdist(sdist: Path, folder: Path) -> Path:
    """Unpack a source distribution, and return its folder without generated files."""
    with tarfile.open(sdist) as archive:
        archive.extractall(folder, filter="data")
    (root,) = folder.iterdir()
    for generated in _GENERATED_PATHS:
        shutil.rmtree(root / generated, ignore_errors=True)  # the engine's distribution has no such folder
    return root


def require_same_files(first: dict[str, Path], second: dict[str, Path]) -> None:
    """Compare the results of two builds.

    Raises:
        SystemExit: a file of the second build differs from the same file of the first.
    """
    for name, path in second.items():
        if compute_digest(path) != compute_digest(first[name]):
            raise SystemExit(f"release: {name} is not the same twice: compare {first[name]} with {path}")


def compute_digest(path: Path) -> str:
    """Return the SHA-256 of a file, as ``sha256sum`` prints it."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def install_distributions(files: list[Path], name: str, extras: str = "") -> Path:
    """Install distributions and locked packages into a new environment, and return its Python.

    Args:
        files: wheels or source distributions, the last one with the extras.
        name: the name of the environment.
        extras: the extras in brackets.
    """
    environment = SCRATCH / name
    python = environment / ("Scripts" if os.name == "nt" else "bin") / "python"
    run_program(_find_uv(), "venv", "--quiet", "--clear", "--python", sys.executable, environment)
    names = [file.name.partition("-")[0].replace("_", "-") for file in files]
    requirements = [f"{name} @ {file.resolve().as_uri()}" for name, file in zip(names, files, strict=True)]
    requirements[-1] = requirements[-1].replace(" @", f"{extras} @", 1)
    constraints = ("--constraints", SCRATCH / "constraints.txt")
    run_program(_find_uv(), "pip", "install", "--quiet", "--python", python, *constraints, *requirements)
    return python


def make_release() -> None:
    """Make the release in ``dist/``, and print each step.

    Raises:
        SystemExit: a step fails; ``dist/`` is then empty.
    """
    time = get_commit_time()
    for folder in (SCRATCH, RESULTS):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
    (SCRATCH / "constraints.txt").write_text(
        lock.format_constraints(lock.LOCK.read_text(encoding="utf-8")), encoding="utf-8"
    )
    _print_step("building wheels and source distributions")
    first = build_distributions(
        write_sources(SCRATCH / "first"), time, "--all-packages", "--sdist", "--wheel", **_OTHER_ENVIRONMENT[0]
    )
    _print_step("building them in another folder")
    again = write_sources(SCRATCH / "a longer name" / "of a folder" / "second")
    require_same_files(
        first,
        build_distributions(again, time, "--all-packages", "--sdist", "--wheel", umask=0o077, **_OTHER_ENVIRONMENT[1]),
    )
    _print_step("building the wheels of the source distributions")
    wheels = [path for name in _DISTRIBUTION_NAMES for path in first.values() if path.match(f"{name}-*.whl")]
    sdists = [path for name in _DISTRIBUTION_NAMES for path in first.values() if path.match(f"{name}-*.tar.gz")]
    for sdist in sdists:
        require_same_files(
            first, build_distributions(unpack_sdist(sdist, SCRATCH / f"unpacked {sdist.name}"), time, "--wheel")
        )
    _print_step(run_program(_find_program("twine"), "check", "--strict", *wheels, *sdists).strip())

    version = read_version()
    tried = Path(__file__).with_name("try_installation.py")
    _print_step(
        run_program(install_distributions(wheels[:1], "engine"), "-I", tried, version, "--engine", cwd=SCRATCH).strip()
    )
    _print_step(run_program(install_distributions(wheels, "alone"), "-I", tried, version, cwd=SCRATCH).strip())
    everything = install_distributions(wheels, "with everything", "[all]")
    _print_step(run_program(everything, "-I", tried, version, cwd=SCRATCH).strip())
    _print_step(run_program(install_distributions(sdists, "of source"), "-I", tried, version, cwd=SCRATCH).strip())

    title, notes = release_notes.find_section(release_notes.CHANGELOG.read_text(encoding="utf-8"), version)
    _print_step(f"the changelog is that of [{title}]")
    results = [Path(shutil.copy(path, RESULTS)) for path in (*sdists, *wheels)]
    changelog, bill = RESULTS / f"linkwright-{version}.changelog.md", RESULTS / f"linkwright-{version}.cdx.json"
    results += [changelog, bill]
    changelog.write_text(notes, encoding="utf-8")
    listing = (
        _find_program("cyclonedx-py"),
        "environment",
        "--output-reproducible",
        "--gather-license-texts",
        everything,
    )
    bill.write_text(bill_of_materials.complete_bill(run_program(*listing, SOURCE_DATE_EPOCH=time)), encoding="utf-8")
    if silent := bill_of_materials.validate_bill(bill):
        _print_step(f"packages that tell no license: {', '.join(silent)}")
    sums = "".join(f"{compute_digest(path)}  {path.name}\n" for path in results)
    (RESULTS / "SHA256SUMS").write_text(sums, encoding="utf-8")
    _print_step(f"in {RESULTS.name}/:\n{sums.strip()}")


def read_version(root: Path = ROOT) -> str:
    """Return the version of a checkout."""
    return re.findall(r'__version__ = "(.+)"', (root / VERSION).read_text(encoding="utf-8"))[0]


def begin_version(version: str, root: Path = ROOT) -> None:
    """Write a new version into the checkout.

    The unreleased changes in the changelog become its section.

    Raises:
        SystemExit: the text is not a newer version, or there are no unreleased changes.
    """
    today = datetime.now(timezone.utc).strftime("%Y-%m-%d")
    changelog = root / release_notes.CHANGELOG.name
    text = release_notes.begin_section(changelog.read_text(encoding="utf-8"), version, today, read_version(root))
    changelog.write_text(text, encoding="utf-8")
    old_version = read_version(root)
    for file, named in ((VERSION, '"{}"'), (RECIPE, '"{}"'), (PROJECT, '"linkwright-core=={}"')):
        source = (root / file).read_text(encoding="utf-8")
        (root / file).write_text(source.replace(named.format(old_version), named.format(version)), encoding="utf-8")


def _find_uv() -> str:
    uv = shutil.which(os.environ.get("UV") or "uv")
    if not uv:
        raise SystemExit("uv is not on the PATH; run `make release`")
    return str(Path(uv).absolute())


def _find_program(program: str) -> Path:
    """Return the path of a program in the environment of this process."""
    return Path(sys.executable).parent / program


def _print_step(text: str) -> None:
    print(text, flush=True)


def main(words: list[str]) -> int:
    """Run the requested action, and return the exit status."""
    if not words:
        make_release()
    elif len(words) == 2 and words[0] == "version":
        begin_version(words[1])
    else:
        print(__doc__, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
