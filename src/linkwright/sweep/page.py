"""The summary of a sweep as one self-contained HTML page."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import isfinite
from statistics import fmean, median, pstdev

from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.diagnostics.translation import language, localized
from linkwright.sweep.plots import histogram, scatter
from linkwright.sweep.running import Result
from linkwright.sweep.table import Table

_MOST_ROWS = 1000
"""The most rows that the page lists; the table has all of them."""

_STYLE = """
:root { color-scheme: light dark; --ink: #1d2733; --soft: #66758a; --line: #d8dee6; --back: #f6f8fa; --card: #fff;
  --accent: #e4572e; --bar: #4a7fb5; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e3e8ee; --soft: #93a1b3; --line: #323c49; --back: #14191f;
  --card: #1c232b; --bar: #6ba3dc; --bad: #ff8a80; } }
body { margin: 0; background: var(--back); color: var(--ink); font: 14px/1.5 system-ui, sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 28px 24px 60px; }
h1 { font-size: 22px; margin: 0 0 4px; } h2 { font-size: 16px; margin: 34px 0 10px; }
.lead { color: var(--soft); margin: 0 0 20px; } .bad { color: var(--bad); }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(340px, 1fr)); gap: 14px; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 10px 12px; }
.card h3 { margin: 0 0 4px; font-size: 13px; font-weight: 600; } svg { width: 100%; display: block; }
.grid { stroke: var(--line); } .axis { stroke: var(--soft); } .tick { font-size: 10px; fill: var(--soft); }
.label { font-size: 11px; fill: var(--ink); } .bar { fill: var(--bar); }
.point { fill: var(--bar); fill-opacity: .55; } a:hover .point { fill: var(--accent); fill-opacity: 1; }
.mean { fill: none; stroke: var(--accent); stroke-width: 2; }
.scroll { overflow-x: auto; margin-bottom: 14px; background: var(--card); border: 1px solid var(--line);
  border-radius: 8px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 12px; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { color: var(--soft); font-weight: 600; } th:first-child, td:first-child, td.text { text-align: left; }
tr:last-child td { border-bottom: 0; } tr:target td { background: color-mix(in srgb, var(--accent) 22%, transparent); }
code { font: 12px ui-monospace, monospace; }
"""


def summary(table: Table, name: str, command: str, planned: int) -> str:
    """Return the HTML of the summary page.

    Args:
        table: the finished runs of the sweep.
        name: the name of the scenario.
        command: the command line that reruns a row, without the row number.
        planned: the number of planned runs.
    """
    failed = table.failed
    counts: list[Phrase] = [counted("{count} run", "{count} runs", len(table))]
    if len(table) < planned:
        counts.append(phrase("{count} runs remain", count=planned - len(table)))
    lead = ", ".join(map(localized, counts))
    if failed:
        lead += f', <span class="bad">{localized(phrase("{count} failed", count=len(failed)))}</span>'
    parts = [f"<h1>{escape(name)}</h1>", f'<p class="lead">{lead}</p>', _failures(table, command)]
    numbers = [result for result in table.results if _finite(table, result)]
    if numbers:
        parts += [f"<h2>{_escaped(phrase('Results'))}</h2>", _statistics(table, numbers)]
        parts.append(
            '<div class="cards">'
            f"{''.join(_card(number, histogram(_of(table, number), number)) for number in numbers)}</div>"
        )
    for parameter in _varied(table):
        cards = "".join(_against(table, parameter, result) for result in numbers)
        if cards:
            parts += [
                f"<h2>{_escaped(phrase('Against {name}', name=parameter))}</h2>",
                f'<div class="cards">{cards}</div>',
            ]
    parts += [f"<h2>{_escaped(phrase('Rows'))}</h2>", _rows(table)]
    return (
        f'<!doctype html>\n<html lang="{language()}"><head><meta charset="utf-8"><meta name="viewport" '
        f'content="width=device-width"><title>{escape(name)}</title><style>{_STYLE}</style></head>'
        f"<body><main>{''.join(parts)}</main></body></html>\n"
    )


def _escaped(text: Phrase) -> str:
    return escape(localized(text))


def _finite(table: Table, name: str) -> list[int]:
    """Return the indices of the rows in which a result is a finite number.

    True and False count as 1 and 0.
    """
    values = table.columns[name]
    return [place for place, value in enumerate(values) if isinstance(value, int | float) and isfinite(value)]


def _of(table: Table, name: str) -> list[float]:
    values = table.columns[name]
    return [float(values[place]) for place in _finite(table, name)]  # type: ignore[arg-type]  # they are numbers


def _varied(table: Table) -> list[str]:
    """Return the parameters that have several values, or the seed if no parameter has."""
    varied = [parameter for parameter in table.parameters[:-1] if len(set(table.columns[parameter])) > 1]
    return varied or [parameter for parameter in table.parameters[-1:] if len(set(table.columns[parameter])) > 1]


def _against(table: Table, parameter: str, result: str) -> str:
    places = _finite(table, result)
    across = [table.columns[parameter][place] for place in places]
    rows = [table.columns["row"][place] for place in places]
    return _card(f"{result} – {parameter}", scatter(across, _of(table, result), rows, parameter, result))


def _card(title: str, drawing: str) -> str:
    return f'<div class="card"><h3>{escape(title)}</h3>{drawing}</div>'


def _statistics(table: Table, names: Sequence[str]) -> str:
    heads = [phrase("result"), phrase("runs"), phrase("minimum"), phrase("mean"), phrase("median"), phrase("maximum")]
    lines = []
    for name in names:
        values = _of(table, name)
        figures = (min(values), fmean(values), median(values), max(values), pstdev(values))
        lines.append([name, str(len(values)), *(f"{figure:.6g}" for figure in figures)])
    return _html_table([localized(head) for head in (*heads, phrase("standard deviation"))], lines)


def _failures(table: Table, command: str) -> str:
    failed = table.failed[:_MOST_ROWS]
    if not failed:
        return ""
    lines = []
    for place in failed:
        row = str(table.columns["row"][place])
        lines.append([row, str(table.columns["error"][place]), f"{command} --rerun {row}"])
    heads = [phrase("row"), phrase("error"), phrase("run it again with")]
    title = f"<h2>{_escaped(phrase('Failed runs'))}</h2>"
    return title + _html_table([localized(head) for head in heads], lines, text=(1, 2))


def _rows(table: Table) -> str:
    names = list(table.columns)
    shown = min(len(table), _MOST_ROWS)
    lines = [[_shown(table.columns[name][place]) for name in names] for place in range(shown)]
    more = ""
    if shown < len(table):
        more = f"<p>{_escaped(phrase('{count} more are in the table', count=len(table) - shown))}</p>"
    return _html_table(names, lines, text=(len(names) - 1,), targets=True) + more


def _shown(value: Result) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _html_table(
    heads: Sequence[str], lines: Sequence[Sequence[str]], *, text: Sequence[int] = (), targets: bool = False
) -> str:
    rows = []
    for line in lines:
        cells = "".join(
            f'<td class="text">{escape(cell)}</td>' if place in text else f"<td>{escape(cell)}</td>"
            for place, cell in enumerate(line)
        )
        rows.append(f'<tr id="row-{line[0]}">{cells}</tr>' if targets else f"<tr>{cells}</tr>")
    head = "".join(f"<th>{escape(head)}</th>" for head in heads)
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'
