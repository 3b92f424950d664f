"""Write the report of a review as one self-contained HTML page."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator, Sequence
from html import escape

from linkwright.diagnostics import Diagnostic, Phrase, phrase
from linkwright.diagnostics.translation import language, localized
from linkwright.review.changes import Change, Effect, Figure, Review, Subject, ViewImages
from linkwright.review.reports.finding_groups import group_findings
from linkwright.review.reports.path_plots import PLOT_STYLE, draw_path_plot
from linkwright.review.reports.scene_page import SCENE_STYLE, Scenes
from linkwright.review.reports.sections import (
    Section,
    divide_report,
    format_summary,
    merge_breaking_changes,
    separate_code,
)
from linkwright.review.reports.sentences import (
    format_alike,
    format_cases,
    format_cases_of,
    format_change,
    format_code_heading,
    format_figure_name,
    format_image_notes,
    format_location,
    format_paths,
    format_repeated,
    format_title,
    get_path_state,
    list_other_files,
    split_heading,
)
from linkwright.review.texts.excerpts import shorten

_ImageKey = tuple[tuple[str, bytes, bytes], ...]
"""The name of each view of a file, with the image of the old and of the new version."""
_MAX_CHARACTERS = 1000
"""The maximum number of characters of a change that are shown without a click."""
_MAX_BREAKING_REST = 200
"""The maximum number of characters after the start of a breaking change in the list at the top of the page."""

_STYLE = """
:root { color-scheme: light dark; --ink: #1d2733; --soft: #5c6a7d; --line: #d8dee6; --back: #f6f8fa; --card: #fff;
  --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e3e8ee; --soft: #93a1b3; --line: #323c49; --back: #14191f;
  --card: #1c232b; --bad: #ff8a80; } }
body { margin: 0; background: var(--back); color: var(--ink); font: 14px/1.5 system-ui, sans-serif; }
main { max-width: 1100px; margin: 0 auto; padding: 20px 24px 60px; overflow-wrap: anywhere; }
h1 { font-size: 22px; margin: 12px 0 4px; } h2 { font-size: 16px; margin: 28px 0 8px; }
h2 code { font-size: 15px; } code { font-family: ui-monospace, monospace; font-size: 12.5px; }
section { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 4px 16px 10px; }
.soft { color: var(--soft); } .breaking { color: var(--bad); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: 8px 0; }
th, td { padding: 3px 12px 3px 0; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; }
th, td:not(:first-child) { overflow-wrap: break-word; }
ul { margin: 8px 0 4px; padding-left: 20px; } li { margin: 2px 0; } summary { cursor: pointer; }
.images { display: grid; grid-template-columns: repeat(auto-fit, minmax(440px, 1fr)); gap: 12px; margin: 12px 0; }
figure { margin: 0; } figcaption { color: var(--soft); }
.versions { position: relative; background: #fff; border: 1px solid var(--line); border-radius: 6px; overflow: hidden; }
.versions img { display: block; width: 100%; } .versions div { position: absolute; inset: 0; }
.versions .old { clip-path: inset(0 calc(100% - var(--share, 50%)) 0 0); }
.versions .new { clip-path: inset(0 0 0 var(--share, 50%)); }
.versions:not(.single)::after { content: ""; position: absolute; width: 2px; background: #5c6a7d;
  inset: 0 auto 0 calc(var(--share, 50%) - 1px); }
.versions span { position: absolute; top: 6px; padding: 0 8px; border-radius: 9px; background: #1d2733cc; color: #fff;
  font-size: 12px; }
.versions .old span, .single span { left: 8px; } .versions .new span { right: 8px; }
input[type=range] { width: 100%; margin: 4px 0 0; }
figcaption { text-align: center; }
@media (max-width: 600px) { main { padding: 12px 12px 40px; } .images { grid-template-columns: 1fr; } }
"""

_SCRIPT = """
for (const slider of document.querySelectorAll("input[type=range]")) {
  const show = () => slider.previousElementSibling.style.setProperty("--share", `${slider.value}%`);
  slider.addEventListener("input", show);
  show();
}
"""


def as_html(review: Review) -> str:
    """Return the report as a page in the user's language.

    A slider reveals one version of each image over the other.
    """
    title = format_title(review)
    scenes = Scenes(review.subjects)
    shown: dict[_ImageKey, str] = {}
    sections, code_sections = separate_code(divide_report(review))
    parts = [
        f"<h1>{_escape_text(title)}</h1><p class='soft'>{_escape_text(format_summary(review))}</p>",
        *_render_breaking_changes(review),
        *(_render_section(section, scenes, shown) for section in sections),
        *_render_list(format_code_heading(len(code_sections)), list(map(_render_code_section, code_sections))),
        *_render_findings(phrase("New findings"), review.new_findings),
        *_render_findings(phrase("Fixed findings"), review.fixed_findings),
        *_render_list(phrase("Other changed files"), [_render_path(*file) for file in list_other_files(review)]),
        *_render_list(phrase("Notes"), [_escape_text(note) for note in review.notes]),
    ]
    head = (
        f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{_escape_text(title)}</title>'
    )
    style = f"<style>{_STYLE}{PLOT_STYLE}{SCENE_STYLE}</style>"
    return (
        f'<!doctype html>\n<html lang="{language()}"><head>{head}{style}</head>'
        f"<body><main>{''.join(parts)}</main><script>{_SCRIPT}</script>{scenes.script}</body></html>\n"
    )


def _render_path(path: str, state: Phrase | None) -> str:
    return f"<code>{escape(path)}</code>" + ("" if state is None else f" ({_escape_text(state)})")


def _render_breaking_changes(review: Review) -> Iterator[str]:
    subjects = {subject.path: subject for subject in review.subjects}
    items = []
    for paths, change in merge_breaking_changes(review):
        line = f":{change.location.line}" if change.location is not None and [change.location.file] == paths else ""
        place = f"{localized(format_paths(paths))}{line}"
        cases = format_cases(change, subjects[paths[0]])
        text = _render_change(change, cases, max_rest=_MAX_BREAKING_REST)
        items.append(f"{text} <code class='soft'>{escape(place)}</code>")
    yield from _render_list(phrase("Breaking changes"), items)


def _render_section(section: Section, scenes: Scenes, shown: dict[_ImageKey, str]) -> str:
    """Return the part of the page about a file.

    Args:
        section: the changes of the file.
        scenes: the 3D scenes of the page.
        shown: the images that other parts have, with the paths of their files. The images of this part are added.
    """
    subject = section.subject
    items = _render_changes(section)
    items += [_escape_text(format_repeated(repeat)) for repeat in section.repeated]
    alike = format_alike(section.alike)
    items += [] if alike is None else [_escape_text(alike)]
    items += [f"<span class='breaking'>{_escape_text(problem.text)}</span>" for problem in subject.problems]
    changes = f"<ul>{''.join(f'<li>{item}</li>' for item in items)}</ul>" if items else ""
    plots = "".join(map(draw_path_plot, subject.paths))
    pictures = f"{_render_images(subject, shown)}{scenes.create_element(subject.scene)}"
    contents = f"{pictures}{_render_figures(subject.figures)}{changes}{plots}"
    return f"<h2>{_render_path(subject.path, get_path_state(subject))}</h2><section>{contents}</section>"


def _render_code_section(section: Section) -> str:
    """Return the functions of a source with other code, in one item."""
    subject = section.subject
    changes = "; ".join(_render_changes(section))
    alike = format_alike(section.alike)
    path = _render_path(subject.path, get_path_state(subject))
    return f"{path}: {changes}{'' if alike is None else f'; {_escape_text(alike)}'}"


def _render_long_text(text: str) -> str:
    """Return a text. The rest of a long one appears with a click."""
    start = shorten(text, _MAX_CHARACTERS)
    if start == text:
        return escape(text)
    return f"<details class='long'><summary>{escape(start)}</summary>{escape(text)}</details>"


def _render_changes(section: Section) -> list[str]:
    subject = section.subject
    cases = format_cases_of(section.changes, subject)
    return [
        _render_change(change, case) + _render_place(change, subject)
        for change, case in zip(section.changes, cases, strict=True)
    ]


def _render_change(change: Change, cases: Phrase | None, max_rest: int | None = None) -> str:
    """Return a change with its reason and argument sets.

    Args:
        change: the change.
        cases: the argument sets with which it occurs; None for all of them.
        max_rest: the number of characters after which the rest of a breaking change is left out; None for no limit.
    """
    text, details = localized(format_change(change)), ""
    if change.effect is Effect.BREAKING:
        heading, rest = split_heading(text)
        rest = rest if max_rest is None else shorten(rest, max_rest)
        if len(rest) > _MAX_CHARACTERS:  # below the reason
            heading, rest, details = heading.rstrip(":："), "", _render_long_text(rest)
        text = f"<strong class='breaking'>{escape(heading)}</strong>{escape(rest)}"
    else:
        text = _render_long_text(text)
    if change.reason is not None:
        text += f": {_escape_text(change.reason)}"
    if cases is not None:
        text += f" <span class='soft' title='{escape(', '.join(change.cases))}'>{_escape_text(cases)}</span>"
    return text + details


def _render_place(change: Change, subject: Subject) -> str:
    if change.location is None:
        return ""
    return f" <code class='soft'>{_escape_text(format_location(change.location, subject.path))}</code>"


def _render_figures(figures: Sequence[Figure]) -> str:
    if not figures:
        return ""
    names = (phrase("quantity"), phrase("before"), phrase("after"), phrase("unit"))
    head = "".join(f"<th>{_escape_text(name)}</th>" for name in names)
    rows = (
        f"<tr><td>{_escape_text(format_figure_name(figure))}</td><td>{escape(figure.old)}</td><td>{escape(figure.new)}</td>"
        f"<td>{escape(figure.unit)}</td></tr>"
        for figure in figures
    )
    return f"<table><tr>{head}</tr>{''.join(rows)}</table>"


def _render_images(subject: Subject, shown: dict[_ImageKey, str]) -> str:
    """Return the images of a file, or a line about another file that has the same ones."""
    images = subject.images
    if not images:
        return ""
    path = shown.setdefault(tuple((view.name, view.old, view.new) for view in images), subject.path)
    if path != subject.path:
        return f"<p class='soft'>{_escape_text(phrase('the same images as in {path}', path=path))}</p>"
    notes = format_image_notes(images)
    text = "" if notes is None else f"<p class='soft'>{_escape_text(notes)}</p>"
    return f"<div class='images'>{''.join(map(_render_image, images))}</div>{text}"


def _render_image(view: ViewImages) -> str:
    """Return a view of both versions.

    A slider moves the border between the old version, which is left of it, and the new version. Each half has a label.
    """
    if not view.old or not view.new:
        return _render_single_image(view)
    old, new = (f"data:image/png;base64,{b64encode(image).decode()}" for image in (view.old, view.new))
    label = escape(localized(phrase("old and new version, {view} view", view=view.name)))
    border = escape(localized(phrase("border between the old and the new version, {view} view", view=view.name)))
    return (
        f"<figure><div class='versions'><img src='{old}' alt='{label}'><div class='new'><img src='{new}' alt=''>"
        f"<span>{_escape_text(phrase('after'))}</span></div>"
        f"<div class='old'><span>{_escape_text(phrase('before'))}</span></div></div>"
        f"<input type='range' min='0' max='100' value='50' aria-label='{border}'>"
        f"<figcaption>{escape(view.name)}</figcaption></figure>"
    )


def _render_single_image(view: ViewImages) -> str:
    """Return a view of a robot that only one version has."""
    image = b64encode(view.old or view.new).decode()
    version = phrase("before") if view.old else phrase("after")
    label = escape(localized(phrase("{view} view", view=view.name)))
    return (
        f"<figure><div class='versions single'><img src='data:image/png;base64,{image}' alt='{label}'>"
        f"<span>{_escape_text(version)}</span></div><figcaption>{escape(view.name)}</figcaption></figure>"
    )


def _render_findings(title: Phrase, findings: Sequence[Diagnostic]) -> Iterator[str]:
    items = []
    for finding in group_findings(findings):
        location = (
            ""
            if finding.span is None
            else f" <code class='soft'>{escape(finding.span.file)}:{finding.span.line}</code>"
        )
        items.append(f"{finding.severity.value} {finding.code}: {_escape_text(finding.message)}{location}")
    yield from _render_list(title, items)


def _render_list(title: Phrase, items: Sequence[str]) -> Iterator[str]:
    if items:
        lines = "".join(f"<li>{item}</li>" for item in items)
        yield f"<h2>{_escape_text(title)}</h2><section><ul>{lines}</ul></section>"


def _escape_text(text: str) -> str:
    return escape(localized(text) if isinstance(text, Phrase) else text)
