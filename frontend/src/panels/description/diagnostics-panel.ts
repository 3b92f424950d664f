import { createButton, coalesce, h } from "../../dom";
import { createIcon, LEVEL_ICONS } from "../../icons";
import type { DiagnosticItem, DiagnosticNote, StatusRow } from "../../protocol";
import { problemsOf, type DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { formatStatusRow } from "../displays/display-items";
import type { Panel } from "../panel";
import { formatPlace, shortenPath } from "../place";

/** The findings on the description with the lines they point to, and the reasons why displays show nothing. */
export class DiagnosticsPanel implements Panel {
  readonly id = "diagnostics";
  readonly icon = "warn";
  readonly element = h("div", { class: "panel diagnostics" });
  private readonly findings = h("div", { aria: { live: "polite" } });
  private readonly displays = h("div");
  private readonly noFindings = h("p", { class: "empty" }, createIcon("check", "level-ok"), strings.diagnostics.none);
  private cards: ReadonlyMap<string, ProblemCard> = new Map<string, ProblemCard>();

  constructor(private readonly session: Session) {
    this.element.append(this.noFindings, this.findings, this.displays);
    session.diagnosticsChanged.on(() => this.showFindings());
    const { displays } = session;
    const show = coalesce(() => this.showDisplays());
    for (const signal of [displays.statusChanged, displays.enabledChanged, displays.treeChanged]) {
      (signal as { on(listener: () => void): void }).on(show);
    }
    this.showFindings();
    this.showDisplays();
  }

  private showFindings(): void {
    const show = (file: string, line: number): void => this.session.description.placeRequested.emit({ file, line });
    this.findings.replaceChildren(...this.session.diagnostics.map((item) => createCard(item, show)));
    this.updateEmptyNote();
  }

  private showDisplays(): void {
    const { displays } = this.session;
    const problems = problemsOf(displays.globalStatus);
    const newCards = new Map<string, ProblemCard>();
    const show = (id: string, name: string, statusRows: readonly StatusRow[], createTitle: () => HTMLElement): void => {
      if (statusRows.length === 0) return;
      const card = this.cards.get(id) ?? new ProblemCard(createTitle());
      card.show(name, statusRows);
      newCards.set(id, card);
    };
    show("#status", strings.tree.globalStatus, problems, () => h("span"));
    for (const display of displays.displays) show(display.id, display.name, display.problems, () => this.createRowButton(display));
    this.cards = newCards;
    const elements = [...newCards.values()].map((card) => card.element);
    const previousElements = [...this.displays.children];
    // Keep the element of a display whatever its text: the user may be about to click it.
    if (elements.length !== previousElements.length || elements.some((element, index) => element !== previousElements[index])) this.displays.replaceChildren(...elements);
    this.updateEmptyNote();
  }

  private updateEmptyNote(): void {
    this.noFindings.hidden = !this.session.displays.isKnown || this.findings.childElementCount + this.displays.childElementCount > 0;
  }

  private createRowButton(display: DisplayState): HTMLElement {
    const { displays } = this.session;
    return createButton(strings.diagnostics.showDisplay, () => displays.rowRequested.emit(display), "text-link", display.name);
  }
}

/** The card with the problems of a display. */
class ProblemCard {
  readonly element = h("article");
  private readonly levelIcon = h("span");
  private readonly list = h("ul");
  private shownKey = "";

  constructor(private readonly title: HTMLElement) {
    this.element.append(h("header", {}, this.levelIcon, h("strong", {}, this.title)), this.list);
  }

  show(name: string, statusRows: readonly StatusRow[]): void {
    const key = JSON.stringify([name, statusRows]);
    if (key === this.shownKey) return;
    this.shownKey = key;
    const level = statusRows[0]?.level ?? "ok";
    this.element.className = `diagnostic ${level === "warn" ? "warning" : level}`;
    this.levelIcon.replaceChildren(createIcon(LEVEL_ICONS[level], `level-${level}`));
    this.title.textContent = name;
    this.list.replaceChildren(...statusRows.map((row) => h("li", {}, formatStatusRow(row))));
  }
}

type ShowPlace = (file: string, line: number) => void;

function createCard(item: DiagnosticItem, show: ShowPlace): HTMLElement {
  const notes = item.notes.map((note) => {
    return h(
      "li",
      {},
      h("span", { class: "tag" }, strings.diagnostics.note),
      note.message,
      createPlaceButton(note, show),
    );
  });
  const hints = item.hints.map((hint) =>
    h("li", { class: "hint-line" }, h("span", { class: "tag" }, strings.diagnostics.hint), hint),
  );
  return h(
    "article",
    { class: `diagnostic ${item.severity}` },
    h(
      "header",
      {},
      createIcon(LEVEL_ICONS[item.severity], `level-${item.severity}`),
      h("strong", {}, item.message),
      h("code", { class: "code" }, item.code),
    ),
    createPlaceButton(item, show),
    createExcerpt(item),
    notes.length + hints.length > 0 ? h("ul", {}, ...notes, ...hints) : null,
  );
}

/** Returns a button that shows a place in the Source panel. */
function createPlaceButton({ file, line, column }: Pick<DiagnosticNote, "file" | "line" | "column">, show: ShowPlace): HTMLElement | null {
  if (file === null) return null;
  const text = formatPlace(shortenPath(file), line, column);
  return createButton(formatPlace(file, line, column), () => show(file, line ?? 1), "place", createIcon("file"), text);
}

/** Returns the source line of a finding, with the part in question marked. */
function createExcerpt(item: DiagnosticItem): HTMLElement | null {
  if (item.excerpt === "") return null;
  const text = item.excerpt.trimStart();
  const indent = item.excerpt.length - text.length;
  const offsetOf = (column: number): number => Math.min(Math.max(0, column - 1 - indent), text.length);
  const start = offsetOf(item.column ?? 1);
  const isOneLine = item.end_line === null || item.end_line === item.line;
  const end = isOneLine && item.end_column !== null ? offsetOf(item.end_column) : text.length;
  const code = h("code", {}, text.slice(0, start));
  code.append(h("mark", {}, text.slice(start, Math.max(end, start + 1))), text.slice(Math.max(end, start + 1)));
  return h("pre", { class: "excerpt" }, h("span", { class: "line-number" }, String(item.line ?? "")), code);
}
