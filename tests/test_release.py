"""The results of `make release`.

The tests cover the changelog of a version, the bill of materials, and files without dates.
"""

from __future__ import annotations

import json

import pytest

from tests.places import REPOSITORY
from tests.repository_tools import load_tool

CHANGELOG = """# Changelog

## [Unreleased]

### Added

- Wings.

## [0.2.0] - 2026-05-01

### Changed

- Legs are longer.
"""


@pytest.fixture(scope="module")
def notes():
    return load_tool("release_notes")


@pytest.fixture(scope="module")
def bill():
    return load_tool("bill_of_materials")


@pytest.fixture(scope="module")
def release():
    return load_tool("release")


def test_release_notes_contain_section_of_version(notes):
    assert notes.find_section(CHANGELOG, "0.2.0") == (
        "0.2.0",
        "# Linkwright 0.2.0\n\n### Changed\n\n- Legs are longer.\n",
    )


def test_release_notes_fall_back_to_unreleased_section(notes):
    assert notes.find_section(CHANGELOG, "0.3.0") == ("Unreleased", "# Linkwright 0.3.0\n\n### Added\n\n- Wings.\n")


def test_release_notes_require_unreleased_changes(notes):
    with pytest.raises(SystemExit, match="nothing unreleased"):
        notes.find_section("# Changelog\n\n## [Unreleased]\n\n## [0.2.0] - 2026-05-01\n\n- Legs.\n", "0.3.0")


def test_unreleased_changes_become_section_of_new_version(notes):
    started_notes = notes.begin_section(CHANGELOG, "0.3.0", "2026-11-22", "0.2.0")
    assert "## [Unreleased]\n\n## [0.3.0] - 2026-11-22\n\n### Added\n\n- Wings.\n\n## [0.2.0]" in started_notes
    assert notes.split_sections(started_notes) == {
        "Unreleased": "",
        "0.3.0": "### Added\n\n- Wings.",
        "0.2.0": "### Changed\n\n- Legs are longer.",
    }


@pytest.mark.parametrize(
    ("version", "reason"),
    [
        ("0.2", "is not a version"),
        ("v0.3.0", "is not a version"),
        ("0.1.9", "is older than 0.2.0"),
        ("0.2.0", "has a section about 0.2.0 already"),
    ],
)
def test_invalid_new_version_is_rejected(notes, version, reason):
    with pytest.raises(SystemExit, match=reason):
        notes.begin_section(CHANGELOG, version, "2026-11-22", "0.2.0")


def test_new_version_is_written_to_all_files(release, tmp_path):
    (tmp_path / "CHANGELOG.md").write_text(CHANGELOG, encoding="utf-8")
    texts = {
        release.VERSION: '__version__ = "0.2.0"\n',
        release.RECIPE: '  version: "0.2.0"\n',
        release.PROJECT: 'dependencies = ["linkwright-core==0.2.0", "other==0.2.0"]\n',
    }
    for file, text in texts.items():
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(text, encoding="utf-8")
    release.begin_version("0.3.0", tmp_path)
    assert release.read_version(tmp_path) == "0.3.0"
    assert (tmp_path / release.RECIPE).read_text(encoding="utf-8") == '  version: "0.3.0"\n'
    expected_text = 'dependencies = ["linkwright-core==0.3.0", "other==0.2.0"]\n'
    assert (tmp_path / release.PROJECT).read_text(encoding="utf-8") == expected_text
    assert "\n## [0.3.0] - 20" in (tmp_path / "CHANGELOG.md").read_text(encoding="utf-8")


def test_changelog_has_section_of_current_version(release, notes):
    text = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
    _, section = notes.find_section(text, release.read_version())
    assert section.startswith(f"# Linkwright {release.read_version()}\n\n### ")
    assert "\n## " not in section


def listed() -> str:
    """Return cyclonedx-py's list of components for an environment.

    It has Linkwright and a package from a folder.
    """
    local = {"type": "distribution", "url": "file:///home/somebody/linkwright.whl"}
    website = {"type": "website", "url": "https://example.org"}
    components = [
        {"bom-ref": "numpy==2.0", "name": "numpy", "type": "library", "externalReferences": [website]},
        {"bom-ref": "linkwright==0.1.0", "name": "linkwright", "type": "library", "externalReferences": [local]},
    ]
    dependencies = [{"ref": "linkwright==0.1.0", "dependsOn": ["numpy==2.0"]}, {"ref": "numpy==2.0"}]
    return json.dumps({"metadata": {}, "components": components, "dependencies": dependencies})


def test_bill_of_materials_lists_python_and_npm_packages(bill):
    bill_of_materials = json.loads(bill.complete_bill(listed()))
    assert bill_of_materials["metadata"]["component"] == {
        "bom-ref": "linkwright==0.1.0",
        "name": "linkwright",
        "type": "application",
    }
    components = {component["name"]: component for component in bill_of_materials["components"]}
    npm_dependencies = json.loads((REPOSITORY / "frontend" / "package.json").read_text(encoding="utf-8"))[
        "dependencies"
    ]
    locked = json.loads((REPOSITORY / "frontend" / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    bundled = {
        path.removeprefix("node_modules/") for path, package in locked.items() if path and not package.get("dev")
    }
    assert bundled >= {"dockview-core", "@lezer/common", *npm_dependencies}
    assert set(components) == {"numpy", *bundled}
    for name, version in npm_dependencies.items():
        assert components[name]["purl"] == f"pkg:npm/{name.replace('@', '%40')}@{version}"
        assert components[name]["licenses"][0]["license"]["id"] == "MIT"
        (digest,) = components[name]["hashes"]
        assert digest["alg"] == "SHA-512"
        assert len(digest["content"]) == 128
    depending = {dependency["ref"]: dependency.get("dependsOn", []) for dependency in bill_of_materials["dependencies"]}
    assert set(depending["linkwright==0.1.0"]) == {
        component["bom-ref"] for component in bill_of_materials["components"]
    }
    assert set(depending) == {"linkwright==0.1.0", *depending["linkwright==0.1.0"]}


def test_bill_of_materials_contains_no_local_paths(bill):
    bill_of_materials = bill.complete_bill(listed())
    assert "file:" not in bill_of_materials
    assert "https://example.org" in bill_of_materials


def test_bill_of_materials_requires_linkwright(bill):
    with pytest.raises(SystemExit, match="without Linkwright"):
        bill.complete_bill(listed().replace("linkwright", "another"))


def test_page_licenses_require_license_texts(monkeypatch, tmp_path):
    page = load_tool("build_page")
    monkeypatch.setattr(page, "FRONTEND", tmp_path)
    monkeypatch.setattr(
        page, "list_bundled_packages", lambda: {"wings": {"version": "1.0.0", "license": "MIT", "integrity": ""}}
    )
    with pytest.raises(SystemExit, match="wings comes without the text of its license"):
        page.collect_licenses()
    folder = tmp_path / "node_modules" / "wings"
    folder.mkdir(parents=True)
    (folder / "LICENSE.md").write_text("Do what you like.\n", encoding="utf-8")
    assert page.collect_licenses() == "wings 1.0.0 (MIT)\n\nDo what you like.\n"


def test_compiled_catalogs_have_no_creation_date(monkeypatch, tmp_path):
    catalogs = load_tool("catalogs")
    (tmp_path / "zh.po").write_bytes((catalogs.FOLDER / "zh.po").read_bytes())
    monkeypatch.setattr(catalogs, "FOLDER", tmp_path)
    catalogs.compile_catalogs()
    assert b"POT-Creation-Date: 1970-01-01 00:00+0000\n" in (tmp_path / "zh.mo").read_bytes()
