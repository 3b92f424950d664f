"""The documentation as a site: its parts, two languages, search, and broken links."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.docs.pages import DOCS
from tests.places import REPOSITORY

SETTINGS = yaml.safe_load((REPOSITORY / "mkdocs.yml").read_text(encoding="utf-8"))

PAGES = {
    "index.md": "# Home\n\n[More](more.md#part) and [a rule](rules/one.md).\n",
    "more.md": "# More of it\n\n## Part\n\nThe inertia of a wheel.\n",
    "rules.md": "# Rules\n",
    "rules/one.md": "# A rule\n",
    "zh/index.md": "# 首页\n\n[更多](more.md#part)\n",
    "zh/more.md": "# 更多内容\n\n## 部分 {#part}\n\n车轮的惯量。\n",
    "zh/rules.md": "# 规则\n",
}
NAVIGATION = [
    {"Home": "index.md"},
    {"Tutorials": ["more.md"]},
    {"Reference": [{"All rules": "rules.md"}, "rules/one.md"]},
]


def navigation_entries(items: list[Any]) -> Iterator[tuple[str, str]]:
    """Return each title and page of a navigation.

    Sections have no page, and pages may have no title.
    """
    for item in items:
        title, below = next(iter(item.items())) if isinstance(item, dict) else ("", item)
        if isinstance(below, list):
            yield title, ""
            yield from navigation_entries(below)
        else:
            yield title, below


def build_site(settings: Path, site: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--config-file", settings, "--site-dir", site],
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
        check=False,
    )


def build_small_site(folder: Path, **changed_pages: str) -> tuple[Path, subprocess.CompletedProcess[str]]:
    """Build a site of a few pages, and return its folder and the result.

    It uses Linkwright's settings and some changed pages.
    """
    for name, text in {**PAGES, **{f"{name}.md": text for name, text in changed_pages.items()}}.items():
        (folder / "docs" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "docs" / name).write_text(text, encoding="utf-8")
    settings = {
        "INHERIT": str(REPOSITORY / "mkdocs.yml"),
        "hooks": [str(REPOSITORY / hook) for hook in SETTINGS["hooks"]],
        "nav": NAVIGATION,
    }
    file = folder / "mkdocs.yml"
    file.write_text(yaml.safe_dump(settings), encoding="utf-8")
    return folder / "site", build_site(file, folder / "site")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build a site of the pages above."""
    folder, result = build_small_site(tmp_path_factory.mktemp("small"))
    assert result.returncode == 0, result.stderr
    return folder


def tab_titles(page: Path) -> list[str]:
    match = re.search(r'<nav class="md-tabs".*?</nav>', page.read_text(encoding="utf-8"), re.DOTALL)
    assert match is not None
    return [text.strip() for text in re.findall(r'class="md-tabs__link">\s*(.*?)\s*</a>', match[0], re.DOTALL)]


def languages(page: Path) -> dict[str, str]:
    """Return the targets of the language selector."""
    text = page.read_text(encoding="utf-8")
    links = re.findall(r'<a href="([^"]+)" hreflang="(\w+)" class="md-select__link"', text)
    return {language: os.path.relpath(page.parent / link, page.parent.parent) for link, language in links}


def test_navigation_has_tutorials_guides_reference_and_explanation() -> None:
    assert [title for item in SETTINGS["nav"] for title in item] == [
        "Home",
        "Tutorials",
        "How-to guides",
        "Reference",
        "Explanation",
    ]


def test_english_pages_are_listed_once() -> None:
    pages = Counter(page for _, page in navigation_entries(SETTINGS["nav"]) if page)
    existing = {path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md") if "zh" not in path.parts}
    assert dict(pages) == dict.fromkeys((name for name in existing if not name.startswith("decisions/0")), 1)


def test_navigation_titles_have_chinese_translation() -> None:
    assert {title for title, _ in navigation_entries(SETTINGS["nav"]) if title} == set(SETTINGS["extra"]["chinese"])


def test_page_links_to_its_translation(site: Path) -> None:
    assert tab_titles(site / "more.html") == ["Home", "Tutorials", "Reference"]
    assert tab_titles(site / "zh" / "more.html") == ["首页", "教程", "参考"]
    assert languages(site / "zh" / "more.html") == {"en": "more.html", "zh": "zh/more.html"}
    assert {link.rpartition("site/")[2] for link in languages(site / "more.html").values()} == {
        "more.html",
        "zh/more.html",
    }
    assert '<html lang="zh"' in (site / "zh" / "more.html").read_text(encoding="utf-8")
    assert '<html lang="en"' in (site / "more.html").read_text(encoding="utf-8")


def test_page_without_translation_links_to_folder_page(site: Path) -> None:
    assert languages(site / "rules" / "one.html") == {"en": "rules/one.html", "zh": "zh/rules.html"}


def test_search_index_is_separate_per_language(site: Path) -> None:
    english, chinese = (
        json.loads((site / folder / "search" / "search_index.json").read_text(encoding="utf-8"))
        for folder in ("", "zh")
    )
    assert {entry["location"].partition("#")[0] for entry in english["docs"]} == {
        "index.html",
        "more.html",
        "rules.html",
        "rules/one.html",
    }
    assert {entry["location"].partition("#")[0] for entry in chinese["docs"]} == {
        "index.html",
        "more.html",
        "rules.html",
    }
    words = [word for entry in chinese["docs"] for word in entry["text"].split("\u200b")]
    assert {"车轮", "惯量"} <= set(words)
    assert '"base": "../zh/"' in (site / "zh" / "more.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"more": "# More of it\n\n## Another part\n"}, "#part"),
        ({"index": "# Home\n\n[gone](gone.md)\n"}, "gone.md"),
        ({"zh/index": "# 首页\n\n[没有](../gone.md)\n"}, "gone.md"),
        ({"forgotten": "# A page that is not listed\n"}, "forgotten.md"),
    ],
    ids=["anchor", "page", "page in Chinese", "page not listed"],
)
def test_broken_links_and_unlisted_pages_fail_build(tmp_path: Path, changed: dict[str, str], reason: str) -> None:
    _, result = build_small_site(tmp_path, **changed)
    assert result.returncode == 1
    assert reason in result.stderr


def test_full_site_builds(tmp_path: Path) -> None:
    result = build_site(REPOSITORY / "mkdocs.yml", tmp_path / "site")
    assert result.returncode == 0, result.stderr
    assert len(list((tmp_path / "site").rglob("*.html"))) > 100
