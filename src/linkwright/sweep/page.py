"""The summary of a sweep as one self-contained HTML page."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import isfinite
from statistics import fmean, median, pstdev

from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.diagnostics.translation import language, localized
from linkwright.sweep.execution import Result
from linkwright.sweep.plots import draw_histogram, draw_scatter
from linkwright.sweep.table import Table

_MAX_ROWS = 1000
"""The maximum number of rows that the page lists. The table contains all of them."""

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


def format_summary(table: Table, name: str, command: str, planned: int) -> str:
    """Return the HTML of the summary page.

    Args:
        table: the finished runs of the sweep.
        name: the name of the scenario.
        command: the command line that runs a row again, without the row's number.
        planned: the number of planned runs, finished or not.
    """
    failed_rows = table.failed_rows
    counts: list[Phrase] = [counted("{count} run", "{count} runs", len(table))]
    if len(table) < planned:
        counts.append(phrase("{count} runs remain", count=planned - len(table)))
    lead = ", ".join(map(localized, counts))
    if failed_rows:
        lead += f', <span class="bad">{localized(phrase("{count} failed", count=len(failed_rows)))}</span>'
    sections = [f"<h1>{escape(name)}</h1>", f'<p class="lead">{lead}</p>', _format_failures(table, command)]
    numeric_results = [result for result in table.results if _find_finite_rows(table, result)]
    if numeric_results:
        sections += [f"<h2>{_escape(phrase('Results'))}</h2>", _format_statistics(table, numeric_results)]
        cards = "".join(
            _format_card(result, draw_histogram(_find_finite_values(table, result), result))
            for result in numeric_results
        )
        sections.append(f'<div class="cards">{cards}</div>')
    for parameter in _find_varied_parameters(table):
        cards = "".join(_format_scatter_card(table, parameter, result) for result in numeric_results)
        if cards:
            sections += [
                f"<h2>{_escape(phrase('Results by {name}', name=parameter))}</h2>",
                f'<div class="cards">{cards}</div>',
            ]
    sections += [f"<h2>{_escape(phrase('Rows'))}</h2>", _format_rows(table)]
    return (
        f'<!doctype html>\n<html lang="{language()}"><head><meta charset="utf-8"><meta name="viewport" '
        f'content="width=device-width"><title>{escape(name)}</title><style>{_STYLE}</style></head>'
        f"<body><main>{''.join(sections)}</main></body></html>\n"
    )


def _escape(text: Phrase) -> str:
    return escape(localized(text))


def _find_finite_rows(table: Table, name: str) -> list[int]:
    """Return the indices of the rows with a finite number for a result.

    True and False are numbers: 1 and 0.
    """
    values = table.columns[name]
    return [index for index, value in enumerate(values) if isinstance(value, int | float) and isfinite(value)]


def _find_finite_values(table: Table, name: str) -> list[float]:
    values = table.columns[name]
    return [float(values[index]) for index in _find_finite_rows(table, name)]  # type: ignore[arg-type]  # the values are numbers


def _find_varied_parameters(table: Table) -> list[str]:
    """Return the parameters with several values.

    If there are none, but several seeds, return the seed.
    """
    parameters = [parameter for parameter in table.parameters[:-1] if len(set(table.columns[parameter])) > 1]
    return parameters or [parameter for parameter in table.parameters[-1:] if len(set(table.columns[parameter])) > 1]


def _format_scatter_card(table: Table, parameter: str, result: str) -> str:
    indices = _find_finite_rows(table, result)
    parameter_values = [table.columns[parameter][index] for index in indices]
    rows = [table.columns["row"][index] for index in indices]
    return _format_card(
        f"{result} – {parameter}",
        draw_scatter(parameter_values, _find_finite_values(table, result), rows, parameter, result),
    )


def _format_card(title: str, drawing: str) -> str:
    return f'<div class="card"><h3>{escape(title)}</h3>{drawing}</div>'


def _format_statistics(table: Table, names: Sequence[str]) -> str:
    headings = [
        phrase("result"),
        phrase("runs"),
        phrase("minimum"),
        phrase("mean"),
        phrase("median"),
        phrase("maximum"),
    ]
    lines = []
    for name in names:
        values = _find_finite_values(table, name)
        statistics = (min(values), fmean(values), median(values), max(values), pstdev(values))
        lines.append([name, str(len(values)), *(f"{statistic:.6g}" for statistic in statistics)])
    return _format_html_table([localized(heading) for heading in (*headings, phrase("standard deviation"))], lines)


def _format_failures(table: Table, command: str) -> str:
    failed = table.failed_rows[:_MAX_ROWS]
    if not failed:
        return ""
    lines = []
    for index in failed:
        row = str(table.columns["row"][index])
        lines.append([row, str(table.columns["error"][index]), f"{command} --rerun {row}"])
    headings = [phrase("row"), phrase("error"), phrase("run it again with")]
    title = f"<h2>{_escape(phrase('Failed runs'))}</h2>"
    return title + _format_html_table([localized(heading) for heading in headings], lines, text=(1, 2))


def _format_rows(table: Table) -> str:
    names = list(table.columns)
    row_count = min(len(table), _MAX_ROWS)
    lines = [[_format_cell(table.columns[name][index]) for name in names] for index in range(row_count)]
    remaining_note = ""
    if row_count < len(table):
        remaining_note = f"<p>{_escape(phrase('{count} more are in the table', count=len(table) - row_count))}</p>"
    return _format_html_table(names, lines, text=(len(names) - 1,), has_targets=True) + remaining_note


def _format_cell(value: Result) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _format_html_table(
    headings: Sequence[str], lines: Sequence[Sequence[str]], *, text: Sequence[int] = (), has_targets: bool = False
) -> str:
    rows = []
    for line in lines:
        cells = "".join(
            f'<td class="text">{escape(cell)}</td>' if column in text else f"<td>{escape(cell)}</td>"
            for column, cell in enumerate(line)
        )
        rows.append(f'<tr id="row-{line[0]}">{cells}</tr>' if has_targets else f"<tr>{cells}</tr>")
    head = "".join(f"<th>{escape(header_cells)}</th>" for header_cells in headings)
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'
