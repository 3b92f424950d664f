"""A hook of MkDocs that links each page of the site with its version in the other language.

``mkdocs.yml`` lists the English pages. The Chinese pages have the same names in ``docs/zh``. They have the same
navigation with Chinese titles, the theme's Chinese texts and a separate search index. A page without a Chinese version
links to the page of its folder (``rules/joints.md`` to ``zh/rules.md``), or else to the home page.

Every function whose name begins with ``on_`` is called by MkDocs.
"""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Any

import jieba
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.nav import Navigation, Section
from mkdocs.structure.pages import Page
from pymdownx.slugs import slugify

CHINESE = "zh"
NAMES = {"en": "English", CHINESE: "中文"}
INDEX = "index.md"

_navigation: dict[str, Navigation] = {}


def on_config(config: MkDocsConfig) -> None:
    """Add the navigation of the Chinese pages to the English one."""
    jieba.setLogLevel(logging.WARNING)  # the search plugin divides Chinese texts into words with it
    config.mdx_configs["toc"]["slugify"] = slugify(case="lower")  # Chinese headings have the anchors of Git hosts
    folder = Path(config.docs_dir) / CHINESE
    titles: dict[str, str] = config.extra["chinese"]
    english = list(config.nav or ())
    config.nav = [*english, {CHINESE: _translate_navigation(english, folder, titles)}]


def on_nav(nav: Navigation, **_: object) -> None:
    """Divide the navigation by language."""
    *english, chinese = nav.items
    assert isinstance(chinese, Section)
    for language, items in (("en", english), (CHINESE, chinese.children)):
        pages = [page for page in nav.pages if get_language(page) == language]
        pages[0].previous_page = pages[-1].next_page = None
        _navigation[language] = Navigation(items, pages)
        _navigation[language].homepage = pages[0]
        for item in items:
            item.parent = None


def on_page_context(context: dict[str, Any], *, page: Page, config: MkDocsConfig, **_: object) -> None:
    """Give a page's template the navigation, the texts and the search index of its language."""
    language = get_language(page)
    context["nav"] = _navigation[language]
    config.theme["language"] = language
    config.extra["alternate"] = [
        {"name": name, "lang": other, "link": page.url if other == language else _find_translation(page, other).url}
        for other, name in NAMES.items()
    ]
    config.extra["scope"] = context["base_url"]  # the selected colors apply in both languages
    if language == CHINESE:
        context["base_url"] += f"/{CHINESE}/"  # where the page looks for its search index


def on_post_build(config: MkDocsConfig) -> None:
    """Divide the search index by language."""
    path = Path(config.site_dir) / "search" / "search_index.json"
    index = json.loads(path.read_text(encoding="utf-8"))
    folder = f"{CHINESE}/"
    chinese = [
        entry | {"location": entry["location"].removeprefix(folder)}
        for entry in index["docs"]
        if entry["location"].startswith(folder)
    ]
    english = [entry for entry in index["docs"] if not entry["location"].startswith(folder)]
    _write_index(path, index, english, ["en"])
    _write_index(Path(config.site_dir) / CHINESE / "search" / path.name, index, chinese, ["en", CHINESE])


def get_language(page: Page) -> str:
    """Return the language of a page."""
    return CHINESE if page.file.src_uri.startswith(f"{CHINESE}/") else "en"


def _translate_navigation(items: list[Any], folder: Path, titles: dict[str, str]) -> list[Any]:
    """Return the navigation entries that have Chinese pages.

    Their titles come from the table or the first heading.
    """
    pages: list[Any] = []
    for item in items:
        title, value = next(iter(item.items())) if isinstance(item, dict) else ("", item)
        if isinstance(value, list):
            children = _translate_navigation(value, folder, titles)
            pages += [{titles[title]: children}] if children else []
        elif (folder / value).exists():
            path = f"{CHINESE}/{value}"
            pages.append({titles[title]: path} if title in titles else path)
    return pages


def _find_translation(page: Page, language: str) -> Page:
    path = page.file.src_uri.removeprefix(f"{CHINESE}/")
    prefix = f"{CHINESE}/" if language == CHINESE else ""
    pages = {other.file.src_uri: other for other in _navigation[language].pages}
    candidates = (path, f"{path.partition('/')[0]}.md", INDEX)
    return next(pages[prefix + name] for name in candidates if prefix + name in pages)


def _write_index(path: Path, index: dict[str, Any], entries: list[dict[str, str]], languages: list[str]) -> None:
    path.parent.mkdir(exist_ok=True)
    written = index | {"config": index["config"] | {"lang": languages}, "docs": entries}
    path.write_text(json.dumps(written, ensure_ascii=False, separators=(",", ":")), encoding="utf-8")
